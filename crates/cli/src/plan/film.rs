//! The frames of a film.

use std::collections::VecDeque;

use lightmesh::Scene;

use super::{Container, PictureFiles, PlanError};
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
}

/// What moves in a film.
#[derive(Clone, Copy)]
pub(crate) enum Motion {
    /// The camera goes once around the scene in this many frames.
    Turntable(u32),
    /// Things move as the scene says, at so many frames per second.
    Scene(FrameRate),
}

/// The frames of a film that are to be rendered.
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
    pub(super) fn new(args: &RenderArgs) -> Result<Option<Film>, PlanError> {
        let motion = match args.turntable {
            Some(frames) => Motion::Turntable(frames),
            None if args.frames.is_some() || args.fps.is_some() || Container::from_path(&args.output).is_some() => {
                Motion::Scene(args.fps.unwrap_or_default())
            }
            None if args.skip_existing || args.overwrite || args.resume => return Err(PlanError::NoFilm),
            None => return Ok(None),
        };
        let movie = Container::of_film(args)?;
        let record = if args.resume { manifest::known(args)? } else { None };
        let film = Film { motion, record, movie, frames: args.frames };
        match (motion, args.frames) {
            (Motion::Turntable(last), _) => film.work(args, last).map(drop)?,
            (Motion::Scene(_), Some(frames)) => film.work(args, frames.last()).map(drop)?,
            (Motion::Scene(_), None) => {}
        }
        Ok(Some(film))
    }

    /// What is left to render of a film with `last` frames: checks that it has those that are wanted, that their files have names of their
    /// own, and that nothing is replaced unasked.
    pub(crate) fn work(&self, args: &RenderArgs, last: u32) -> Result<Work, PlanError> {
        let frames = self.frames.unwrap_or(Frames::up_to(last));
        if frames.last() > last || frames.first() == 0 {
            return Err(PlanError::NoFrame { frames, last });
        }
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
    pub(crate) fn last(&self, scene: &Scene) -> Result<u32, PlanError> {
        match self.motion {
            Motion::Turntable(last) => Ok(last),
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
