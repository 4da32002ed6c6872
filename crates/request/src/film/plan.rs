//! The plan of a film: what moves, and which frames are wanted.

use std::collections::VecDeque;

use lightmesh_scene::Scene;

use super::Container;
use crate::error::RequestError;
use crate::files::PictureFiles;
use crate::manifest::{self, Record};
use crate::order::Order;
use crate::sun::SunStudy;
use crate::value::{FrameRate, Frames};

/// A film: what moves in it, and which of its frames are wanted.
pub struct Film {
    /// What moves.
    pub motion: Motion,
    /// What is known of it if it is resumed and was begun before.
    pub(crate) record: Option<Record>,
    /// The movie that it goes to, unless each frame has a file.
    movie: Option<Container>,
    frames: Option<Frames>,
    /// What is left, if the wanted frames are known without the scene.
    left: Option<FrameRange>,
}

/// What moves in a film.
#[derive(Clone, Copy)]
pub enum Motion {
    /// The camera goes once around the scene in this many frames.
    Turntable(u32),
    /// Things move as the scene says, at so many frames per second.
    Scene(FrameRate),
    /// The sun shines at the moments of a [`SunStudy`], of which there are so many.
    Sun(u32),
}

impl Motion {
    /// What moves, if anything does.
    fn of(order: &Order, sun: Option<&SunStudy>) -> Option<Motion> {
        // Files of hours of direct sun do not need a film of them.
        let sun = sun
            .filter(|_| order.files.output.is_some() || order.files.sun_hours.is_empty())
            .map(|sun| Motion::Sun(sun.moments.len() as u32));
        let is_movie = || Container::from_path(order.files.picture()).is_some();
        let of_scene = order.request.sun.is_none()
            && (order.request.frames.is_some() || order.request.fps.is_some() || is_movie());
        let scene = of_scene.then(|| Motion::Scene(order.request.fps.unwrap_or_default()));
        sun.or(order.request.turntable.map(Motion::Turntable)).or(scene)
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
pub struct FrameRange {
    /// Their numbers, in their order; none if all exist.
    pub(crate) numbers: Vec<u32>,
    /// The film's last frame.
    pub(crate) last: u32,
    /// How many exist and are left as they are.
    pub(crate) skipped: usize,
}

impl FrameRange {
    /// The frames that are to be rendered; `None` if all exist.
    pub fn frames(&self) -> Option<Frames> {
        Frames::of_numbers(&self.numbers)
    }
}

impl Film {
    /// The film that is asked for, if it is one. Fails if what is known of it without the scene cannot be rendered.
    pub(crate) fn new(order: &Order, sun: Option<&SunStudy>) -> Result<Option<Film>, RequestError> {
        let Some(motion) = Motion::of(order, sun) else {
            let has_hours = !order.files.sun_hours.is_empty();
            let of_film = order.request.of_frames().next();
            return of_film.map_or(Ok(None), |setting| Err(RequestError::OfFilm { setting, has_hours }));
        };
        let movie = Container::of_film(order)?;
        let record = if order.request.resume { manifest::known(order)? } else { None };
        let mut film = Film { motion, record, movie, frames: order.request.frames.clone(), left: None };
        // A frame that no film has is found by `wanted`.
        let last_wanted = || order.request.frames.as_ref().map(|frames| frames.last().try_into().unwrap_or(1));
        if let Some(last) = motion.known_last().or_else(last_wanted) {
            film.left = Some(film.left(order, film.wanted(last)?, last)?);
        }
        Ok(Some(film))
    }

    /// What is left to render of the film of a scene: checks that it has the frames that are wanted, that their files have names of their own,
    /// and that nothing is replaced unasked.
    pub(crate) fn work(&self, order: &Order, scene: &Scene) -> Result<FrameRange, RequestError> {
        if let (Motion::Sun(0), Some(spec)) = (self.motion, order.request.sun) {
            return Err(RequestError::NoSun { spec });
        }
        let last = self.last(scene)?;
        let frames = self.wanted(last)?;
        match &self.left {
            Some(left) => Ok(FrameRange { last, ..left.clone() }),
            None => self.left(order, frames, last),
        }
    }

    /// The frames that are wanted of a film with `last` of them.
    fn wanted(&self, last: u32) -> Result<Frames, RequestError> {
        let frames = self.frames.clone().unwrap_or_else(|| Frames::up_to(last));
        if frames.last() > last.into() || frames.first() < 1 {
            Err(RequestError::NoFrame { frames, last })
        } else {
            Ok(frames)
        }
    }

    fn left(&self, order: &Order, frames: Frames, last: u32) -> Result<FrameRange, RequestError> {
        // Frames that the manifest does not name are those that were being finished when the film ended.
        let replaces = order.request.overwrite || self.record.is_some() || self.is_movie();
        let (mut numbers, mut existing) = (Vec::new(), VecDeque::new());
        for number in frames.numbers().filter_map(|number| number.try_into().ok()) {
            let files = PictureFiles::of_frame(order, number)?;
            match files.picture_file().filter(|path| path.exists()) {
                Some(path) if !replaces => existing.push_back(path.to_owned()),
                _ => numbers.push(number),
            }
        }
        let skipped = existing.len();
        match existing.pop_front() {
            Some(first) if !order.request.skip_existing => Err(RequestError::FrameExists { first, count: skipped }),
            _ => Ok(FrameRange { numbers, last, skipped }),
        }
    }

    /// The last frame of the film of a scene.
    ///
    /// # Errors
    /// [`RequestError::NotAnimated`] if nothing in the scene moves.
    fn last(&self, scene: &Scene) -> Result<u32, RequestError> {
        match self.motion {
            Motion::Turntable(last) | Motion::Sun(last) => Ok(last),
            Motion::Scene(rate) => match scene.animation() {
                Some(animation) => Ok(rate.last_frame(animation.duration())),
                None => Err(RequestError::NotAnimated),
            },
        }
    }

    /// The files of a frame.
    ///
    /// # Errors
    /// Those of [`PictureFiles`].
    pub(crate) fn files(&self, order: &Order, number: u32) -> Result<PictureFiles, RequestError> {
        PictureFiles::of_frame(order, number)
    }

    /// Whether all frames go to one file.
    pub(crate) fn is_movie(&self) -> bool {
        self.movie.is_some()
    }

    /// A frame that stands for all in what is checked before the scene is open.
    pub(crate) fn first(&self) -> u32 {
        self.frames.as_ref().and_then(|frames| frames.first().try_into().ok()).unwrap_or(1)
    }
}
