//! Regions of space that are searched for triangles, and which boxes they may meet.
//!
//! Three forms: a box; all points [near](Region::near) a box of origins; the [shaft](Region::shaft) from a box of origins to the box
//! around an emitter (Haines, Wallace: *Shaft Culling for Efficient Ray-Traced Radiosity*, 1991). Each may be cut off by the [tangent
//! planes](TangentPlanes) of the origins, since nothing below all of them hides anything from any origin: the points near a box then
//! become a union of half-balls.
//!
//! # What a structure may rely on
//!
//! [`Region::meets`] is true of every box that the region meets, and of few others. Rounding is on the safe side: each shape says how,
//! next to its test, and all allow [`REGION_ROUNDING`] for it, 16 ε with ε = 2⁻²⁴. No box has to be enlarged for that; boxes whose
//! planes are rounded, such as those of a compressed node, are enlarged where they are computed.
//!
//! Coordinates are finite and below 2¹⁰⁰, so that nothing overflows. Boxes may be flat, or points. `region.cuh` is the twin.

mod boxes;
mod planes;
mod shaft;

use fearless_simd::Simd;
use glam::Vec3;
use lightmesh_layout::constants::REGION_ROUNDING;
use lightmesh_scene::Bounds;

pub(super) use boxes::Boxes;
pub use planes::TangentPlanes;
use shaft::Shaft;

/// A region of space that is searched for triangles.
#[derive(Clone, Copy, Debug)]
pub struct Region {
    shape: RegionShape,
    planes: TangentPlanes,
    /// No point of the region lies outside.
    bounds: Bounds,
}

#[derive(Clone, Copy, Debug)]
enum RegionShape {
    /// The bounds themselves.
    Box,
    /// All points near a box.
    Near {
        origins: Bounds,
        /// A little more than the square of the distance.
        square: f32,
    },
    /// The space between two boxes.
    Shaft(Shaft),
}

impl Region {
    /// A closed box.
    #[inline]
    pub fn within(bounds: Bounds) -> Region {
        Region { shape: RegionShape::Box, planes: TangentPlanes::NONE, bounds }
    }

    /// All points at most `reach` away from some point of `origins`.
    ///
    /// Distances along the axes have a relative error of ε, their squares 3 ε in all, the sum 2 ε more, and the square of `reach` 3 ε
    /// here: 16 ε cover these 8 ε. The smallest normal number covers squares that are subnormal.
    #[inline]
    pub fn near(origins: Bounds, reach: f32) -> Region {
        let square = reach * reach * (1.0 + REGION_ROUNDING) + f32::MIN_POSITIVE;
        let bounds = Bounds { min: below(origins.min - reach), max: above(origins.max + reach) };
        Region { shape: RegionShape::Near { origins, square }, planes: TangentPlanes::NONE, bounds }
    }

    /// All points of all segments from a point of `origins` to a point of `emitter`.
    #[inline]
    pub fn shaft(origins: Bounds, emitter: Bounds) -> Region {
        if origins.is_empty() || emitter.is_empty() {
            return Region::within(Bounds::EMPTY);
        }
        let bounds = Bounds { min: origins.min.min(emitter.min), max: origins.max.max(emitter.max) };
        Region { shape: RegionShape::Shaft(Shaft::new(&origins, &emitter)), planes: TangentPlanes::NONE, bounds }
    }

    /// The part that does not lie below all the planes; everything if there are none.
    #[inline]
    pub fn above(self, planes: TangentPlanes) -> Region {
        Region { planes: planes.for_boxes_in(&self.bounds), ..self }
    }

    /// A box around it.
    #[inline]
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The way from the middle of a shaft's first box to that of its second; zero for other forms.
    #[inline]
    pub(super) fn heading(&self) -> Vec3 {
        match &self.shape {
            RegionShape::Shaft(shaft) => shaft.heading(),
            RegionShape::Box | RegionShape::Near { .. } => Vec3::ZERO,
        }
    }

    /// Whether its bounds may be far larger than the region itself, so that parts of it should be bounded [one by one](Self::between).
    #[inline]
    pub(super) fn is_slanted(&self) -> bool {
        matches!(self.shape, RegionShape::Shaft(_))
    }

    /// A box around all of its points whose coordinate on `axis` lies between `low` and `high`; empty if there are none.
    #[inline]
    pub(super) fn between(&self, axis: usize, low: f32, high: f32) -> Bounds {
        let mut bounds = match &self.shape {
            RegionShape::Shaft(shaft) => shaft.between(axis, low, high),
            RegionShape::Box | RegionShape::Near { .. } => self.bounds,
        };
        bounds.min[axis] = bounds.min[axis].max(low);
        bounds.max[axis] = bounds.max[axis].min(high);
        if bounds.is_empty() { Bounds::EMPTY } else { bounds }
    }

    /// Bit k: the region may meet box k.
    #[inline(always)]
    pub(super) fn meets<S: Simd>(&self, simd: S, boxes: &Boxes<S>) -> u32 {
        let met = match &self.shape {
            RegionShape::Box => boxes.overlapping(simd, &self.bounds),
            RegionShape::Near { origins, square } => boxes.near(simd, origins, *square),
            RegionShape::Shaft(shaft) => shaft.meets(simd, boxes),
        };
        if met == 0 || self.planes.is_empty() { met } else { met & self.planes.reached(simd, boxes) }
    }
}

/// The next number below each coordinate: what was rounded once lies above it.
fn below(v: Vec3) -> Vec3 {
    Vec3::from(v.to_array().map(f32::next_down))
}

/// The next number above each coordinate.
fn above(v: Vec3) -> Vec3 {
    Vec3::from(v.to_array().map(f32::next_up))
}
