//! Eight boxes in SIMD lanes, to be tested against a region at once.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use lightmesh_scene::Bounds;

/// Eight boxes, axis by axis.
pub(in crate::accel) struct Boxes<S: Simd> {
    pub(in crate::accel) low: [f32x8<S>; 3],
    pub(in crate::accel) high: [f32x8<S>; 3],
    /// Added to the height that each reaches above a plane, see
    /// [`TangentPlanes`](super::planes::TangentPlanes): 16 ε times the sum of its edges. Zero for boxes that
    /// were enlarged by as much on each side.
    pub(in crate::accel) loose: f32x8<S>,
}

impl<S: Simd> Boxes<S> {
    /// Bit k: box k and `bounds` have a point in common. There is no rounding.
    #[inline(always)]
    pub(super) fn overlapping(&self, simd: S, bounds: &Bounds) -> u32 {
        let mut met = 0xff;
        for axis in 0..3 {
            let overlap = self.low[axis].simd_le(f32x8::splat(simd, bounds.max[axis]))
                & self.high[axis].simd_ge(f32x8::splat(simd, bounds.min[axis]));
            met &= overlap.to_bitmask() as u32;
        }
        met
    }

    /// Bit k: the square of the distance between box k and `origins` is at most `square`.
    #[inline(always)]
    pub(super) fn near(&self, simd: S, origins: &Bounds, square: f32) -> u32 {
        let mut sum = f32x8::splat(simd, 0.0);
        for axis in 0..3 {
            let after = self.low[axis] - origins.max[axis];
            let before = f32x8::splat(simd, origins.min[axis]) - self.high[axis];
            let apart = after.max(before).max(f32x8::splat(simd, 0.0));
            sum += apart * apart;
        }
        sum.simd_le(f32x8::splat(simd, square)).to_bitmask() as u32
    }
}
