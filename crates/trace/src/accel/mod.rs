//! Acceleration structures: which triangles can a ray or a segment hit?
//!
//! One trait, three implementations that must agree: [`BruteForce`] (the reference), the regular [`Grid`] of the thesis and a wide
//! [`Bvh`]. They are queried in batches, because that is where packets, SIMD and sorting fit in; a single ray is a batch of one.
//!
//! # What every implementation promises
//!
//! * A **closest hit** is the smallest `t` in `(0, t_max)`; among equal `t` the smallest triangle index. A segment is **occluded**
//!   if some triangle is hit at a `t` in `(0, t_max)`. Both ends are open.
//! * Whether and where a triangle is hit is decided by [`triangle`] alone. Structures only choose which triangles to test, and
//!   their box tests err on the side of testing, so that all three give the same bits.
//! * Zero, negative-zero and subnormal direction components and far-away origins are ordinary input. A zero direction, a ray
//!   that is not finite and a triangle that is not [usable](Triangle::is_usable) hit nothing.
//! * Where a triangle is cut out (`alpha_mask`) there is nothing to hit.
//! * Of opaque triangles with identical corners only the one with the smallest index is held: neither hits nor shadows need the others.
//!
//! The structures are built here; devices hold copies ([`AcceleratorKind`]) and walk them with the code in the `.cuh` files next to the Rust
//! ones, with the same promises. `walk.cuh` and `search.cuh` are the twins of the trait.

pub mod alpha_mask;
pub(crate) mod beam;
mod brute_force;
pub(crate) mod bvh;
pub(crate) mod deduplicate;
pub(crate) mod grid;
mod instanced;
mod packet;
mod ray_clamp;
mod region;
mod region_filter;
pub mod triangle;
mod visit;

use glam::Vec3;
use lightmesh_scene::Bounds;

pub use alpha_mask::AlphaMask;
pub use beam::Beams;
pub use brute_force::BruteForce;
pub use bvh::{Bvh, BvhCost};
pub use grid::geometry_hash;
pub use grid::{Grid, GridError, GridFault, GridFileError, GridOptions, GridSaveError, Levels};
pub use instanced::Triangles;
pub use instanced::{Instanced, ShapeTree};
pub use region::{Region, TangentPlanes};
pub use region_filter::{CHUNK, ChunkSink};
pub use triangle::{ShortTest, Triangle};
pub use visit::Visitor;

/// A ray or segment: the points `origin + t · direction` with `0 < t < t_max`. The direction need not be unit length; a
/// segment has `t_max` 1 (or a little less, to spare its end) and the difference of its ends as direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes.
    pub direction: Vec3,
    /// Where it ends, in units of `direction`; may be infinite.
    pub t_max: f32,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Hit {
    /// Ray parameter; infinite if nothing was hit.
    pub t: f32,
    /// Barycentric weight of the triangle's second corner.
    pub u: f32,
    /// Barycentric weight of the triangle's third corner.
    pub v: f32,
    /// Index of the triangle in the scene's mesh; [`Hit::NONE`] if nothing was hit.
    pub triangle: u32,
}

impl Hit {
    /// The triangle index that means "no triangle".
    pub const NONE: u32 = lightmesh_layout::geometry::Hit::NONE;

    /// The result for a ray that hits nothing.
    pub const MISS: Hit = Hit { t: f32::INFINITY, u: 0.0, v: 0.0, triangle: Hit::NONE };

    /// Whether a triangle was hit.
    #[inline]
    pub fn is_some(&self) -> bool {
        self.triangle != Hit::NONE
    }

    /// Whether this hit wins over `other`: nearer, or equally near on a triangle of smaller index.
    #[inline]
    pub fn beats(&self, other: &Hit) -> bool {
        self.t < other.t || (self.t == other.t && self.triangle < other.triangle)
    }
}

/// The segments of one short-test query: from one surface point to some light points near it.
#[derive(Clone, Copy, Debug)]
pub struct ShortSegments<'a> {
    /// The test of whether a triangle blocks a segment, set up for the surface point.
    pub test: ShortTest,
    /// Light point minus segment origin, for each segment.
    pub directions: &'a [Vec3],
    /// Triangles whose bounding box comes this close to a segment must be tested, scene units.
    pub slack: f32,
    /// Where triangles are cut out.
    #[doc(hidden)]
    pub alpha_mask: &'a AlphaMask,
}

impl ShortSegments<'_> {
    /// A box that every triangle to be tested meets.
    fn region(&self) -> Bounds {
        let origin = self.test.origin;
        let ends = self.directions.iter().map(|&direction| origin + direction);
        let Bounds { min, max } = Bounds::around(ends).including(origin);
        Bounds { min: min - self.slack, max: max + self.slack }
    }

    /// Tests each triangle against every segment.
    fn ask<'a>(&self, triangles: impl Iterator<Item = &'a Triangle>, blocked: &mut [bool]) {
        blocked.fill(false);
        for triangle in triangles {
            let Some(occluder) = self.test.occluder(triangle.corners()) else { continue };
            for (blocked, &direction) in blocked.iter_mut().zip(self.directions) {
                *blocked |= occluder.blocks(direction) && self.alpha_mask.stops(triangle, self.test.origin, direction);
            }
        }
    }
}

/// The kinds of structures.
#[derive(Clone, Copy, Debug)]
pub enum AcceleratorKind<'a> {
    /// A wide BVH.
    Bvh(&'a Bvh),
    /// A regular grid.
    Grid(&'a Grid),
    /// A list.
    BruteForce(&'a BruteForce),
}

/// Something that finds triangles.
pub trait Accelerator: Send + Sync {
    /// Closest hit of every ray. `hits` is as long as `rays` and is overwritten.
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]);

    /// Hands all hits of each ray that has any to `take`, with the number of the ray: in the order of `t`, among equal ones of the index.
    fn all_hits(&self, rays: &[Ray], take: &mut dyn FnMut(usize, &[Hit]));

    /// For every segment, whether anything blocks it. `occluded` is as long as `segments` and is overwritten.
    fn occluded(&self, segments: &[Ray], occluded: &mut [bool]);

    /// For every short segment, whether a triangle blocks it according to [`ShortTest`]. `blocked` is as long as the directions and
    /// is overwritten.
    fn short_segments(&self, segments: &ShortSegments, blocked: &mut [bool]);

    /// Hands all triangles held that meet `region` to `take`, up to [`CHUNK`] at once, in no order and perhaps twice,
    /// until it returns false. May find others as well, but only those whose bounding box the region
    /// [may meet](Region). A list and a BVH find all of those; a grid need not find a triangle that stays away from the
    /// region's cells although its bounding box does not.
    fn search(&self, region: &Region, take: ChunkSink);

    /// Replaces the content of `found` with what a [search](Accelerator::search) finds, each once, in ascending order of index.
    fn triangles_in(&self, region: &Region, found: &mut Vec<u32>) {
        found.clear();
        self.search(region, &mut |chunk| {
            found.extend_from_slice(chunk);
            true
        });
        found.sort_unstable();
        found.dedup();
    }

    /// The same structure over the same triangles, cut out by `alpha_mask`; both share what they hold.
    fn masked_by(&self, alpha_mask: &AlphaMask) -> Box<dyn Accelerator>;

    /// Its name in settings and statistics: `grid`, `bvh` or `brute-force`.
    fn name(&self) -> &'static str;

    /// Its size in memory, bytes.
    fn memory(&self) -> usize;

    /// Its kind, for devices that hold a copy.
    fn kind(&self) -> AcceleratorKind<'_>;
}
