//! The samples of pixels.

use std::ops::Range;
use std::sync::Arc;

use lightmesh_trace::accel::Hit;

/// What some samples of each pixel of some rows see.
#[derive(Clone, Debug)]
pub struct PixelSamples {
    /// Their hits: pixel by pixel, then by sample.
    pub(crate) hits: Arc<Vec<Hit>>,
    /// The state of each pixel.
    pub(crate) state: Vec<u32>,
    /// For each sample, the first sample of its pixel that lies on one surface with it: pixel by pixel, then by sample. Only those of
    /// pixels that are not shared are known; empty if none are.
    pub(crate) owners: Vec<u8>,
    /// The first pixel.
    pub(crate) first: u32,
    /// The numbers of the samples.
    pub(crate) numbers: Range<u32>,
}

impl PixelSamples {
    /// What those of a pixel see.
    #[inline(always)]
    pub(crate) fn of(&self, pixel: u32) -> &[Hit] {
        &self.hits[self.places(pixel)]
    }

    /// The owners of those of a pixel that is not shared.
    #[inline(always)]
    pub(crate) fn owners_of(&self, pixel: u32) -> &[u8] {
        &self.owners[self.places(pixel)]
    }

    #[inline(always)]
    fn places(&self, pixel: u32) -> Range<usize> {
        let count = self.numbers.len();
        let start = (pixel - self.first) as usize * count;
        start..start + count
    }

    /// What one of them sees, counted from the first.
    #[inline(always)]
    pub(crate) fn hit(&self, pixel: u32, sample: u32) -> &Hit {
        &self.hits[(pixel - self.first) as usize * self.numbers.len() + sample as usize]
    }
}
