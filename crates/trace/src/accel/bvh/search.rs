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
use lightmesh_layout::constants::{BVH_MARGIN, INSTANCE_MARGIN};

use super::tree::{Bvh, Node};
use super::walk::{Guide, Stack, descend, octant_of, planes};
use crate::accel::region::Boxes;
use crate::accel::region_filter::{ChunkSink, RegionFilter};
use crate::accel::{Instanced, Region, Triangle};

/// Hands over all triangles whose bounding boxes the region may meet; those of a shaft roughly by their distance from where it begins.
#[simd]
pub(super) fn search<S: Simd>(simd: S, bvh: &Bvh, region: &Region, take: ChunkSink) {
    let mut search = Search { simd, bvh, region, filter: RegionFilter::new(simd, region, take) };
    if descend(bvh, 0, octant_of(region.heading()), Stack::new(bvh.depth).entries(), &mut search) {
        search.filter.finish();
    }
}

/// Passes to a filter the triangles of all leaves whose boxes the region may meet.
struct Search<'a, S: Simd> {
    simd: S,
    bvh: &'a Bvh,
    region: &'a Region,
    filter: RegionFilter<'a, S>,
}

impl<S: Simd> Guide for Search<'_, S> {
    #[inline(always)]
    fn met(&self, node: &Node) -> u32 {
        self.region.meets(self.simd, &children(self.simd, node))
    }

    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        match triangle.instance() {
            None => self.filter.take(triangle),
            Some(number) => self.enter(&self.bvh.instances[number]),
        }
    }
}

impl<S: Simd> Search<'_, S> {
    /// Passes on the triangles of an instance in the same way, where they are in the scene.
    #[inline(never)]
    fn enter(&mut self, instance: &Instanced) -> bool {
        let Search { simd, bvh, region, filter } = self;
        let octant = octant_of(instance.back.vector(region.heading()));
        let mut search = ShapeSearch { simd: *simd, region, instance, filter };
        descend(bvh, instance.tree.root, octant, Stack::new(bvh.shape_depth).entries(), &mut search)
    }
}

/// The same within a shape.
struct ShapeSearch<'a, 'b, S: Simd> {
    simd: S,
    region: &'a Region,
    instance: &'a Instanced,
    filter: &'a mut RegionFilter<'b, S>,
}

impl<S: Simd> Guide for ShapeSearch<'_, '_, S> {
    #[inline(always)]
    fn met(&self, node: &Node) -> u32 {
        self.region.meets(self.simd, &placed(self.simd, &children(self.simd, node), self.instance))
    }

    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        self.filter.take(&self.instance.triangle(triangle))
    }
}

/// Boxes around the boxes of a shape, where they are in the scene. Rounding errs by at most 8 ε of all terms that are added.
#[inline(always)]
fn placed<S: Simd>(simd: S, boxes: &Boxes<S>, instance: &Instanced) -> Boxes<S> {
    let half = |axis: usize| (boxes.high[axis] - boxes.low[axis]) * 0.5;
    let middle = |axis: usize| (boxes.high[axis] + boxes.low[axis]) * 0.5;
    let (half, middle) = ([half(0), half(1), half(2)], [middle(0), middle(1), middle(2)]);
    let (mut low, mut high) = (boxes.low, boxes.high);
    for (axis, row) in instance.place.rows.iter().enumerate() {
        let mut center = f32x8::splat(simd, row[3]);
        let mut reach = f32x8::splat(simd, 0.0);
        let mut terms = f32x8::splat(simd, row[3].abs());
        for k in 0..3 {
            center += middle[k] * row[k];
            reach += half[k] * row[k].abs();
            terms += (middle[k].abs() + half[k]) * row[k].abs();
        }
        let reach = reach + terms * INSTANCE_MARGIN;
        (low[axis], high[axis]) = (center - reach, center + reach);
    }
    Boxes { low, high, loose: boxes.loose }
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
