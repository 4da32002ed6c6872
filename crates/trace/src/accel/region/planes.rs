//! The tangent planes of surface points: what lies below all of them hides nothing.
//!
//! Points with the same normal n have one plane: that through the lowest of them. A box reaches above it if its topmost corner
//! does. Heights are measured along n from a corner common to all, so that they are small however far the scene is from the origin.
//!
//! # What is rounded
//!
//! The height of a box's topmost corner is three differences, three products and two sums: off by at most 4.1 ε Σ |nᵢ| (Dᵢ + eᵢ),
//! where eᵢ are the edges of the box, and Dᵢ how far the region extends from the corner, provided that the box overlaps the
//! region's bounds. A point's height is off by 4.1 ε Σ |nᵢ| Dᵢ; so is the decision of a [short test](crate::accel::ShortTest)
//! whether a triangle in the box lies above a point, and it must find nothing there that was discarded here. Together that is less
//! than 16 ε Σ |nᵢ| Dᵢ plus 16 ε Σ |nᵢ| eᵢ. Heights of planes are lowered by the former; boxes contribute the latter, either as
//! [`Boxes::loose`] or by being enlarged by 16 ε eᵢ.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use glam::Vec3;
use lightmesh_layout::constants::{REGION_ROUNDING, TANGENT_PLANES};
use lightmesh_scene::Bounds;

use super::boxes::Boxes;

const MOST: usize = TANGENT_PLANES as usize;

/// Up to four planes; none means "nothing is known".
#[derive(Clone, Copy, Debug)]
pub struct TangentPlanes {
    count: usize,
    /// Where heights are measured from.
    corner: Vec3,
    normals: [Vec3; MOST],
    heights: [f32; MOST],
}

impl TangentPlanes {
    /// Nothing is known, so nothing lies below.
    pub const NONE: TangentPlanes =
        TangentPlanes { count: 0, corner: Vec3::ZERO, normals: [Vec3::ZERO; MOST], heights: [0.0; MOST] };

    /// The planes through points with unit normals, lowered by `slack`; none if there are more than four normals. `corner` is a
    /// point near all of them.
    pub fn new(corner: Vec3, points: impl IntoIterator<Item = (Vec3, Vec3)>, slack: f32) -> TangentPlanes {
        let mut planes = TangentPlanes { corner, ..TangentPlanes::NONE };
        for (point, normal) in points {
            let height = normal.dot(point - corner) - slack;
            match planes.normals[..planes.count].iter().position(|&other| other == normal) {
                Some(known) => planes.heights[known] = planes.heights[known].min(height),
                None if planes.count == MOST => return TangentPlanes::NONE,
                None => {
                    planes.normals[planes.count] = normal;
                    planes.heights[planes.count] = height;
                    planes.count += 1;
                }
            }
        }
        planes
    }

    /// Where heights are measured from.
    #[inline]
    pub fn corner(&self) -> Vec3 {
        self.corner
    }

    /// The normals and heights.
    #[inline]
    pub fn each(&self) -> impl Iterator<Item = (Vec3, f32)> + '_ {
        self.normals.into_iter().zip(self.heights).take(self.count)
    }

    /// Whether nothing is known.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The same planes, lowered by the rounding for boxes that overlap `bounds`.
    #[inline]
    pub(super) fn for_boxes_in(mut self, bounds: &Bounds) -> TangentPlanes {
        let far = (bounds.min - self.corner).abs().max((bounds.max - self.corner).abs());
        for (height, normal) in self.heights[..self.count].iter_mut().zip(&self.normals) {
            *height -= REGION_ROUNDING * normal.abs().dot(far);
        }
        self
    }

    /// Bit k: box k may reach above one of the planes.
    #[inline(always)]
    pub(super) fn reached<S: Simd>(&self, simd: S, boxes: &Boxes<S>) -> u32 {
        let mut reached = 0;
        for (normal, &height) in self.normals[..self.count].iter().zip(&self.heights) {
            let mut top = boxes.loose;
            for axis in 0..3 {
                let face = if normal[axis] > 0.0 { boxes.high[axis] } else { boxes.low[axis] };
                top += (face - self.corner[axis]) * normal[axis];
            }
            reached |= top.simd_ge(f32x8::splat(simd, height)).to_bitmask() as u32;
        }
        reached
    }
}
