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
use lightmesh_layout::constants::{BVH_MARGIN, FIRST_INNER, INNER_HITS, ROOT_HIT, TRIANGLE_HITS};

use super::walk::{Group, Stack, child_hits, planes};
use super::{Bvh, Node};
use crate::accel::Region;
use crate::accel::region::Boxes;
use crate::accel::sieve::Sieve;

/// All triangles whose bounding boxes the region may meet, in ascending order.
#[simd]
pub(super) fn triangles_in<S: Simd>(simd: S, bvh: &Bvh, region: &Region, found: &mut Vec<u32>) {
    let mut sieve = Sieve::new(simd, region, found);
    if !bvh.nodes.is_empty() {
        search(simd, bvh, region, &mut sieve);
    }
    sieve.finish();
}

/// Passes to a sieve the triangles of all leaves whose boxes the region may meet.
#[inline(always)]
fn search<S: Simd>(simd: S, bvh: &Bvh, region: &Region, sieve: &mut Sieve<S>) {
    let mut stack = Stack::new(bvh.depth);
    let stack = stack.entries();
    let mut height = 0;
    // 1. Begin with the root, as if it were the only child in the last slot.
    let mut nodes = Group { base: 0, bits: ROOT_HIT };
    loop {
        // 2. Take a node out of its group; keep the rest for later.
        let bit = 31 - nodes.bits.leading_zeros();
        let siblings = nodes.bits;
        nodes.bits &= !(1 << bit);
        if nodes.bits > TRIANGLE_HITS {
            stack[height] = nodes;
            height += 1;
        }
        let before = siblings & ((1 << (bit - FIRST_INNER)) - 1) & 0xff;
        let node = &bvh.nodes[(nodes.base + before.count_ones()) as usize];

        // 3. Which of its children may the region meet?
        let hits = child_hits(node, region.meets(simd, &children(simd, node)), 0);
        nodes = Group { base: node.child_base_idx, bits: (hits & INNER_HITS) | u32::from(node.imask) };

        // 4. The triangles of those that are leaves.
        let mut triangles = hits & TRIANGLE_HITS;
        while triangles != 0 {
            sieve.take(&bvh.triangles[(node.primitive_base_idx + triangles.trailing_zeros()) as usize]);
            triangles &= triangles - 1;
        }

        // 5. No child left to enter: continue with the group most recently set aside.
        if nodes.bits <= TRIANGLE_HITS {
            if height == 0 {
                return;
            }
            height -= 1;
            nodes = stack[height];
        }
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
