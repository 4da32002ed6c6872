//! The plan of a film: what moves, and which frames are wanted.

use std::collections::VecDeque;

use lightmesh::Scene;

use super::{Container, PictureFiles, PlanError, SunStudy};
use crate::args::RenderArgs;
use crate::manifest::{self, Record};
use crate::value::{FrameRate, Frames};

/// A film: what moves in it, and which of its frames are wanted.
pub(crate) struct Film {
    /// What moves.
    pub(crate) motion: Motion,
    /// What is known of it if it is resumed and was begun before.
    pub(crate) record: Option<Record>,
    /// The movie that it goes to, unless each frame has a file.
    movie: Option<Container>,
    frames: Option<Frames>,
    /// What is left, if the wanted frames are known without the scene.
    left: Option<Work>,
}

/// What moves in a film.
#[derive(Clone, Copy)]
pub(crate) enum Motion {
    /// The camera goes once around the scene in this many frames.
    Turntable(u32),
    /// Things move as the scene says, at so many frames per second.
    Scene(FrameRate),
    /// The sun shines at the moments of a [`SunStudy`], of which there are so many.
    Sun(u32),
}

impl Motion {
    /// What moves, if anything does.
    fn of(args: &RenderArgs, sun: Option<&SunStudy>) -> Option<Motion> {
        // Hours of direct sun do not need a film of them.
        let sun = sun.filter(|_| args.output.is_some()).map(|sun| Motion::Sun(sun.moments.len() as u32));
        let is_movie = || Container::from_path(args.picture()).is_some();
        let of_scene = args.sun.is_none() && (args.frames.is_some() || args.fps.is_some() || is_movie());
        let scene = of_scene.then(|| Motion::Scene(args.fps.unwrap_or_default()));
        sun.or(args.turntable.map(Motion::Turntable)).or(scene)
    }

    /// The film's last frame, if it is known without the scene.
    fn known_last(self) -> Option<u32> {
        match self {
            Motion::Turntable(last) | Motion::Sun(last) => Some(last),
            Motion::Scene(_) => None,
        }
    }
}

/// The frames of a film that are to be rendered.
#[derive(Clone)]
pub(crate) struct Work {
    /// Their numbers, in their order; none if all exist.
    pub(crate) numbers: Vec<u32>,
    /// The film's last frame.
    pub(crate) last: u32,
    /// How many exist and are left as they are.
    pub(crate) skipped: usize,
}

impl Film {
    /// The film that is asked for, if it is one. Fails if what is known of it without the scene cannot be rendered.
    pub(super) fn new(args: &RenderArgs, sun: Option<&SunStudy>) -> Result<Option<Film>, PlanError> {
        let Some(motion) = Motion::of(args, sun) else {
            let is_film = args.skip_existing || args.overwrite || args.resume;
            return if is_film { Err(PlanError::NoFilm) } else { Ok(None) };
        };
        let movie = Container::of_film(args)?;
        let record = if args.resume { manifest::known(args)? } else { None };
        let mut film = Film { motion, record, movie, frames: args.frames, left: None };
        if let Some(last) = motion.known_last().or(args.frames.map(Frames::last)) {
            film.left = Some(film.left(args, film.wanted(last)?, last)?);
        }
        Ok(Some(film))
    }

    /// What is left to render of the film of a scene: checks that it has the frames that are wanted, that their files have names of their own,
    /// and that nothing is replaced unasked.
    pub(crate) fn work(&self, args: &RenderArgs, scene: &Scene) -> Result<Work, PlanError> {
        let last = self.last(scene)?;
        let frames = self.wanted(last)?;
        match &self.left {
            Some(left) => Ok(Work { last, ..left.clone() }),
            None => self.left(args, frames, last),
        }
    }

    /// The frames that are wanted of a film with `last` of them.
    fn wanted(&self, last: u32) -> Result<Frames, PlanError> {
        let frames = self.frames.unwrap_or(Frames::up_to(last));
        if frames.last() > last || frames.first() == 0 { Err(PlanError::NoFrame { frames, last }) } else { Ok(frames) }
    }

    fn left(&self, args: &RenderArgs, frames: Frames, last: u32) -> Result<Work, PlanError> {
        // Frames that the manifest does not name are those that were being finished when the film ended.
        let replaces = args.overwrite || self.record.is_some() || self.is_movie();
        let (mut numbers, mut existing) = (Vec::new(), VecDeque::new());
        for number in frames.numbers() {
            let files = PictureFiles::of_frame(args, number)?;
            match files.picture.file().filter(|path| path.exists()) {
                Some(path) if !replaces => existing.push_back(path.to_owned()),
                _ => numbers.push(number),
            }
        }
        let skipped = existing.len();
        match existing.pop_front() {
            Some(first) if !args.skip_existing => Err(PlanError::FrameExists { first, count: skipped }),
            _ => Ok(Work { numbers, last, skipped }),
        }
    }

    /// The last frame of the film of a scene.
    ///
    /// # Errors
    /// [`PlanError::NotAnimated`] if nothing in the scene moves.
    fn last(&self, scene: &Scene) -> Result<u32, PlanError> {
        match self.motion {
            Motion::Turntable(last) | Motion::Sun(last) => Ok(last),
            Motion::Scene(rate) => match scene.animation() {
                Some(animation) => Ok(rate.last_frame(animation.duration())),
                None => Err(PlanError::NotAnimated),
            },
        }
    }

    /// The files of a frame.
    ///
    /// # Errors
    /// Those of [`PictureFiles`].
    pub(crate) fn files(&self, args: &RenderArgs, number: u32) -> Result<PictureFiles, PlanError> {
        PictureFiles::of_frame(args, number)
    }

    /// Whether all frames go to one file.
    pub(crate) fn is_movie(&self) -> bool {
        self.movie.is_some()
    }

    /// A frame that stands for all in what is checked before the scene is open.
    pub(super) fn first(&self) -> u32 {
        self.frames.map_or(1, Frames::first)
    }
}
