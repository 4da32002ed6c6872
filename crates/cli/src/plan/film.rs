//! The frames of a film.

use std::collections::VecDeque;

use super::{PictureFiles, PlanError};
use crate::args::RenderArgs;
use crate::value::Frames;

/// A film: which frames of how many.
pub(crate) struct Film {
    /// Frames in which the camera goes once around the scene.
    pub(crate) turntable: u32,
    /// Those to render, in their order; at least one, unless all exist.
    pub(crate) numbers: Vec<u32>,
    /// How many exist and are left as they are.
    pub(crate) skipped: usize,
    first: u32,
}

impl Film {
    /// Checks that the frames exist in the film, that their files have names of their own, and that nothing is replaced unasked.
    pub(super) fn new(args: &RenderArgs) -> Result<Option<Film>, PlanError> {
        let Some(turntable) = args.turntable else { return Ok(None) };
        let frames = args.frames.unwrap_or(Frames::up_to(turntable));
        if frames.last() > turntable || frames.numbers().next() == Some(0) {
            return Err(PlanError::NoFrame { frames, last: turntable });
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
            _ => {
                let first = numbers.first().copied().unwrap_or(frames.last());
                Ok(Some(Film { turntable, numbers, skipped, first }))
            }
        }
    }

    /// The first frame to render.
    pub(super) fn first(&self) -> u32 {
        self.first
    }

    /// The files of a frame.
    ///
    /// # Errors
    /// Those of [`PictureFiles`].
    pub(crate) fn files(&self, args: &RenderArgs, number: u32) -> Result<PictureFiles, PlanError> {
        PictureFiles::of_frame(args, number)
    }
}
