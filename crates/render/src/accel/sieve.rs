//! Triangles that a region may meet, eight at a time.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use lightmesh_layout::constants::REGION_ROUNDING;

use super::Triangle;
use super::region::{Boxes, Region};

/// Boxes that are tested against a region at once.
const LANES: usize = 8;

/// Accepts triangles, and lists those whose bounding boxes a region may meet.
pub(super) struct Sieve<'a, S: Simd> {
    simd: S,
    region: &'a Region,
    found: &'a mut Vec<u32>,
    /// How many wait until there are eight.
    waiting: usize,
    low: [[f32; LANES]; 3],
    high: [[f32; LANES]; 3],
    loose: [f32; LANES],
    indices: [u32; LANES],
}

impl<'a, S: Simd> Sieve<'a, S> {
    /// Begins a list in `found`, whose content is discarded.
    #[inline(always)]
    pub(super) fn new(simd: S, region: &'a Region, found: &'a mut Vec<u32>) -> Sieve<'a, S> {
        found.clear();
        let (low, high) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        Sieve { simd, region, found, waiting: 0, low, high, loose: [0.0; LANES], indices: [0; LANES] }
    }

    #[inline(always)]
    pub(super) fn take(&mut self, triangle: &Triangle) {
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
        if self.waiting == LANES {
            self.ask();
        }
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
            self.found.push(self.indices[met.trailing_zeros() as usize & (LANES - 1)]);
            met &= met - 1;
        }
        self.waiting = 0;
    }

    /// Ends the list: each triangle once, in ascending order of index.
    #[inline(always)]
    pub(super) fn finish(mut self) {
        if self.waiting > 0 {
            self.ask();
        }
        self.found.sort_unstable();
        self.found.dedup();
    }
}
