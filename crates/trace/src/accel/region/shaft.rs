//! All segments between two boxes.
//!
//! At parameter t the points of all segments fill a box, (1 − t) A + t B, whose every face moves linearly from A's to B's. The shaft meets
//! a box if for some t in [0, 1] the two overlap on every axis: six linear inequalities, each of which bounds t from above or from below.
//!
//! # What is rounded
//!
//! A bound is a difference of coordinates times the reciprocal of another: a relative error of 4.1 ε, two for the differences, one each
//! for reciprocal and product. Its sign is right. So if the largest lower bound and the smallest upper one are at most 1, and the former
//! is not above the latter, then as computed it exceeds the latter by at most 8.2 ε: less than [`REGION_ROUNDING`]. Neither the boxes nor
//! the distance from the world's origin matter.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use glam::Vec3;
use lightmesh_layout::constants::REGION_ROUNDING;
use lightmesh_scene::Bounds;

use super::boxes::Boxes;

/// The lower or the upper faces.
#[derive(Clone, Copy, Debug)]
struct Faces {
    from: Vec3,
    to: Vec3,
    /// Reciprocals of how far they move; never infinite, never zero.
    inverse: Vec3,
}

impl Faces {
    /// `still` has the sign given to the motion of faces that do not move, or move less than the smallest normal number: outward, so
    /// that such a face never moves past a box that it touches.
    fn new(from: Vec3, to: Vec3, still: f32) -> Faces {
        let way = to - from;
        let moves = way.abs().cmpge(Vec3::splat(f32::MIN_POSITIVE));
        let way = Vec3::select(moves, way, Vec3::splat(still * f32::MIN_POSITIVE));
        Faces { from, to, inverse: way.recip() }
    }

    fn at(&self, t: f32) -> Vec3 {
        self.from + t * (self.to - self.from)
    }
}

/// The segments from one box to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shaft {
    low: Faces,
    high: Faces,
}

impl Shaft {
    /// Between two boxes that are not empty.
    #[inline]
    pub(super) fn new(from: &Bounds, to: &Bounds) -> Shaft {
        Shaft { low: Faces::new(from.min, to.min, -1.0), high: Faces::new(from.max, to.max, 1.0) }
    }

    /// The way from the middle of the first box to that of the second.
    #[inline]
    pub(super) fn heading(&self) -> Vec3 {
        0.5 * (self.low.to - self.low.from + self.high.to - self.high.from)
    }

    /// Bit k: the shaft may meet box k.
    #[inline(always)]
    pub(super) fn meets<S: Simd>(&self, simd: S, boxes: &Boxes<S>) -> u32 {
        let mut first = f32x8::splat(simd, 0.0);
        let mut last = f32x8::splat(simd, 1.0);
        for axis in 0..3 {
            // The lower face must not be above the box.
            let inverse = self.low.inverse[axis];
            let bound = (boxes.high[axis] - self.low.from[axis]) * inverse;
            if inverse > 0.0 {
                last = last.min(bound)
            } else {
                first = first.max(bound)
            }
            // Nor the upper face below it.
            let inverse = self.high.inverse[axis];
            let bound = (boxes.low[axis] - self.high.from[axis]) * inverse;
            if inverse > 0.0 { first = first.max(bound) } else { last = last.min(bound) }
        }
        first.simd_le(last + REGION_ROUNDING).to_bitmask() as u32
    }

    /// A box around the part between two coordinates of an axis.
    ///
    /// A face at t is off by at most 4 ε (|from| + |to|): 2 ε for its motion, ε for the sum, and ε for moving that outward. That and
    /// the 4.1 ε of t itself are less than [`REGION_ROUNDING`].
    pub(super) fn between(&self, axis: usize, low: f32, high: f32) -> Bounds {
        let (mut first, mut last) = (0.0f32, 1.0f32);
        let mut narrow = |bound: f32, from_above: bool| {
            if from_above { last = last.min(bound) } else { first = first.max(bound) }
        };
        let inverse = self.low.inverse[axis];
        narrow((high - self.low.from[axis]) * inverse, inverse > 0.0);
        let inverse = self.high.inverse[axis];
        narrow((low - self.high.from[axis]) * inverse, inverse < 0.0);
        let (first, last) = ((first - REGION_ROUNDING).max(0.0), (last + REGION_ROUNDING).min(1.0));
        if first > last {
            return Bounds::EMPTY;
        }
        let margin = |faces: &Faces| REGION_ROUNDING * (faces.from.abs() + faces.to.abs());
        Bounds {
            min: self.low.at(first).min(self.low.at(last)) - margin(&self.low),
            max: self.high.at(first).max(self.high.at(last)) + margin(&self.high),
        }
    }
}
