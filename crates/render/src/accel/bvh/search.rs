//! The search for all triangles that meet a region, through compressed wide nodes: eight children at once.
//!
//! A child's plane is a byte times a power of two, which is exact, added to the node's corner: off by ε S, S being the largest
//! coordinate of the node's frame on that axis, and moved outward by a margin of γ S with γ = 2⁻¹⁹ = 32 ε, which is rounded by
//! the same amount. The edges of the box are below S, so it exceeds the box that holds the triangles by 30 ε times their length:
//! more than tangent planes require, see [`Boxes::loose`].

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use glam::Vec3A;
use lightmesh_layout::constants::BVH_MARGIN;

use super::walk::{Guide, Stack, descend, octant_of, planes};
use super::{Bvh, Node};
use crate::accel::region::Boxes;
use crate::accel::sieve::{Sieve, Take};
use crate::accel::{Region, Triangle};

/// Hands over all triangles whose bounding boxes the region may meet; those of a shaft roughly by their distance from where it begins.
#[simd]
pub(super) fn search<S: Simd>(simd: S, bvh: &Bvh, region: &Region, take: Take) {
    let mut search = Search { simd, region, sieve: Sieve::new(simd, region, take) };
    if descend(bvh, 0, octant_of(region.heading()), Stack::new(bvh.depth).entries(), &mut search) {
        search.sieve.finish();
    }
}

/// Passes to a sieve the triangles of all leaves whose boxes the region may meet.
struct Search<'a, S: Simd> {
    simd: S,
    region: &'a Region,
    sieve: Sieve<'a, S>,
}

impl<S: Simd> Guide for Search<'_, S> {
    #[inline(always)]
    fn met(&self, node: &Node) -> u32 {
        self.region.meets(self.simd, &children(self.simd, node))
    }

    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        self.sieve.take(triangle)
    }
}

/// The boxes of a node's children.
#[inline(always)]
fn children<S: Simd>(simd: S, node: &Node) -> Boxes<S> {
    let extent = node.compute_extent();
    let corner = Vec3A::from(node.p);
    let margin = BVH_MARGIN * (corner.abs() + 256.0 * extent);
    Boxes {
        low: [
            planes(simd, &node.child_min_x, extent.x, corner.x) - margin.x,
            planes(simd, &node.child_min_y, extent.y, corner.y) - margin.y,
            planes(simd, &node.child_min_z, extent.z, corner.z) - margin.z,
        ],
        high: [
            planes(simd, &node.child_max_x, extent.x, corner.x) + margin.x,
            planes(simd, &node.child_max_y, extent.y, corner.y) + margin.y,
            planes(simd, &node.child_max_z, extent.z, corner.z) + margin.z,
        ],
        loose: f32x8::splat(simd, 0.0),
    }
}
