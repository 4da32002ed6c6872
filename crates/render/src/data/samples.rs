//! The samples of pixels.

use std::ops::Range;
use std::sync::Arc;

use crate::accel::Hit;

/// What some samples of each pixel of some rows see.
#[derive(Clone, Debug)]
pub struct PixelSamples {
    /// Their hits: pixel by pixel, then by sample.
    pub(crate) hits: Arc<Vec<Hit>>,
    /// The state of each pixel.
    pub(crate) state: Vec<u32>,
    /// The first pixel.
    pub(crate) first: u32,
    /// The numbers of the samples.
    pub(crate) numbers: Range<u32>,
}

impl PixelSamples {
    /// What those of a pixel see.
    #[inline(always)]
    pub(crate) fn of(&self, pixel: u32) -> impl Iterator<Item = &Hit> {
        let count = self.numbers.len();
        self.hits[(pixel - self.first) as usize * count..][..count].iter()
    }

    /// What one of them sees, counted from the first.
    #[inline(always)]
    pub(crate) fn hit(&self, pixel: u32, sample: u32) -> &Hit {
        &self.hits[(pixel - self.first) as usize * self.numbers.len() + sample as usize]
    }
}
