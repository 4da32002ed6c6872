//! Which triangles of a list a region may meet, eight at a time.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use lightmesh_layout::constants::REGION_ROUNDING;

use super::Triangle;
use super::region::{Boxes, Region};

/// Boxes that are tested against a region at once.
const LANES: usize = 8;

/// Maximum number of triangles that are handed over at once.
pub const CHUNK: usize = 32;

/// Takes chunks of what a search finds, in no order; `false` ends the search.
pub type ChunkSink<'a> = &'a mut dyn FnMut(&[u32]) -> bool;

/// Accepts triangles, and hands over those whose bounding boxes a region may meet.
pub(super) struct RegionFilter<'a, S: Simd> {
    simd: S,
    region: &'a Region,
    take: ChunkSink<'a>,
    found: [u32; CHUNK],
    count: usize,
    /// How many wait until there are eight.
    waiting: usize,
    low: [[f32; LANES]; 3],
    high: [[f32; LANES]; 3],
    loose: [f32; LANES],
    indices: [u32; LANES],
}

impl<'a, S: Simd> RegionFilter<'a, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, region: &'a Region, take: ChunkSink<'a>) -> RegionFilter<'a, S> {
        let (low, high) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        let (loose, indices) = ([0.0; LANES], [0; LANES]);
        RegionFilter { simd, region, take, found: [0; CHUNK], count: 0, waiting: 0, low, high, loose, indices }
    }

    /// False ends the search.
    #[inline(always)]
    pub(super) fn take(&mut self, triangle: &Triangle) -> bool {
        let [a, b, c] = triangle.corners();
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let lane = self.waiting & (LANES - 1);
        for axis in 0..3 {
            self.low[axis][lane] = low[axis];
            self.high[axis][lane] = high[axis];
        }
        self.loose[lane] = REGION_ROUNDING * (high - low).element_sum();
        self.indices[lane] = triangle.index();
        self.waiting += 1;
        if self.waiting < LANES {
            return true;
        }
        self.ask();
        self.count <= CHUNK - LANES || self.hand_over()
    }

    #[inline(always)]
    fn hand_over(&mut self) -> bool {
        let count = std::mem::take(&mut self.count);
        (self.take)(&self.found[..count])
    }

    #[inline(always)]
    fn ask(&mut self) {
        let load = |lanes: &[f32; LANES]| f32x8::from_slice(self.simd, lanes);
        let boxes = Boxes {
            low: [load(&self.low[0]), load(&self.low[1]), load(&self.low[2])],
            high: [load(&self.high[0]), load(&self.high[1]), load(&self.high[2])],
            loose: load(&self.loose),
        };
        let mut met = self.region.meets(self.simd, &boxes) & ((1 << self.waiting) - 1);
        while met != 0 {
            self.found[self.count] = self.indices[met.trailing_zeros() as usize & (LANES - 1)];
            self.count += 1;
            met &= met - 1;
        }
        self.waiting = 0;
    }

    /// Hands over the rest.
    #[inline(always)]
    pub(super) fn finish(mut self) {
        if self.waiting > 0 {
            self.ask();
        }
        if self.count > 0 {
            self.hand_over();
        }
    }
}
