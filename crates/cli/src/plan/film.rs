//! The frames of a film.

use std::collections::VecDeque;

use super::{PictureFiles, PlanError, SunStudy};
use crate::args::RenderArgs;
use crate::value::Frames;

/// A film: what moves in it, and which of its frames are wanted.
pub(crate) struct Film {
    /// What moves.
    pub(crate) motion: Motion,
    frames: Option<Frames>,
}

/// What moves in a film.
#[derive(Clone, Copy)]
pub(crate) enum Motion {
    /// The camera goes once around the scene in this many frames.
    Turntable(u32),
    /// The sun shines at the moments of a [`SunStudy`], of which there are so many.
    Sun(u32),
}

impl Motion {
    /// What moves, if anything does.
    fn of(args: &RenderArgs, sun: Option<&SunStudy>) -> Option<Motion> {
        // Hours of direct sun do not need a film of them.
        let sun = sun.filter(|_| args.output.is_some()).map(|sun| Motion::Sun(sun.moments.len() as u32));
        sun.or(args.turntable.map(Motion::Turntable))
    }

    /// The film's last frame.
    pub(crate) fn last(self) -> u32 {
        match self {
            Motion::Turntable(last) | Motion::Sun(last) => last,
        }
    }
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
    pub(super) fn new(args: &RenderArgs, sun: Option<&SunStudy>) -> Result<Option<Film>, PlanError> {
        let Some(motion) = Motion::of(args, sun) else { return Ok(None) };
        let film = Film { motion, frames: args.frames };
        film.work(args, motion.last())?;
        Ok(Some(film))
    }

    /// What is left to render of a film with `last` frames: checks that it has those that are wanted, that their files have names of their
    /// own, and that nothing is replaced unasked.
    pub(crate) fn work(&self, args: &RenderArgs, last: u32) -> Result<Work, PlanError> {
        let frames = self.frames.unwrap_or(Frames::up_to(last));
        if frames.last() > last || frames.first() == 0 {
            return Err(PlanError::NoFrame { frames, last });
        }
        let (mut numbers, mut existing) = (Vec::new(), VecDeque::new());
        for number in frames.numbers() {
            let files = PictureFiles::of_frame(args, number)?;
            match files.picture.file().filter(|path| path.exists()) {
                Some(path) if !args.overwrite => existing.push_back(path.to_owned()),
                _ => numbers.push(number),
            }
        }
        let skipped = existing.len();
        match existing.pop_front() {
            Some(first) if !args.skip_existing => Err(PlanError::FrameExists { first, count: skipped }),
            _ => Ok(Work { numbers, last, skipped }),
        }
    }

    /// The files of a frame.
    ///
    /// # Errors
    /// Those of [`PictureFiles`].
    pub(crate) fn files(&self, args: &RenderArgs, number: u32) -> Result<PictureFiles, PlanError> {
        PictureFiles::of_frame(args, number)
    }

    /// A frame that stands for all in what is checked before the scene is open.
    pub(super) fn first(&self) -> u32 {
        self.frames.map_or(1, Frames::first)
    }
}
