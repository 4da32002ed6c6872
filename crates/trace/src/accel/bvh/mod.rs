//! A wide BVH: eight children per node, 80 bytes per node, after Ylitie, Karras, Laine: *Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs* (HPG 2017).
//!
//! * `tree`: nodes and triangles as plain arrays, which devices copy.
//! * `build`: the tree comes from `obvhs`; we make sure that every box holds its triangles, and store these in leaf order.
//! * `cost`: how good the tree is.
//! * `walk`: the traversal by a ray; `search`: by a region.
//! * `packet`: the traversal by many coherent rays at once.

pub(crate) mod build;
mod cost;
mod packet;
mod search;
mod tree;
mod walk;

use fearless_simd::Simd;
use glam::Vec3;
use lightmesh_scene::Instance;

pub use cost::BvhCost;
pub use tree::Bvh;

use super::{Accelerator, AcceleratorKind, AlphaMask, ChunkSink, Hit, Ray, Region, ShortSegments, Triangle, Visitor};
use crate::simd::dispatch;

impl Bvh {
    /// Builds the tree over the usable triangles, one of identical ones.
    pub fn new(triangles: &[Triangle]) -> Bvh {
        build::build(triangles)
    }

    /// The same over instances, too: `stored` are all triangles that are stored, of which those of shapes are in coordinates of their own. If
    /// `known` holds the same shapes, their trees are taken from there.
    #[doc(hidden)]
    pub fn with_instances(own: &[Triangle], stored: &[Triangle], instances: &[Instance], known: Option<&Bvh>) -> Bvh {
        build::build_levels(own, stored, instances, known)
    }

    /// Visits the triangles of all leaves whose boxes come as close as `slack` to the segment from `origin` along `direction`, near octants
    /// first.
    #[inline(always)]
    pub fn visit_segment<S: Simd>(
        &self,
        simd: S,
        (origin, direction): (Vec3, Vec3),
        slack: f32,
        visitor: &mut impl Visitor,
    ) {
        let ray = walk::Walked::new(origin, direction, slack);
        walk::walk(simd, self, 0, &ray, walk::Stack::new(self.depth).entries(), visitor);
    }
}

impl Accelerator for Bvh {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        if rays.len() <= packet::FEW {
            dispatch!(self.level, simd => walk::closest_hits(simd, self, rays, hits));
        } else {
            dispatch!(self.level, simd => packet::closest_hits(simd, self, rays, hits));
        }
    }

    fn all_hits(&self, rays: &[Ray], take: &mut dyn FnMut(usize, &[Hit])) {
        dispatch!(self.level, simd => walk::all_hits(simd, self, rays, take));
    }

    fn occluded(&self, segments: &[Ray], occluded: &mut [bool]) {
        if segments.len() <= packet::FEW {
            dispatch!(self.level, simd => walk::occluded(simd, self, segments, occluded));
        } else {
            dispatch!(self.level, simd => packet::occluded(simd, self, segments, occluded));
        }
    }

    fn short_segments(&self, segments: &ShortSegments, blocked: &mut [bool]) {
        dispatch!(self.level, simd => walk::short_segments(simd, self, segments, blocked));
    }

    fn search(&self, region: &Region, take: ChunkSink) {
        dispatch!(self.level, simd => search::search(simd, self, region, take));
    }

    fn masked_by(&self, alpha_mask: &AlphaMask) -> Box<dyn Accelerator> {
        Box::new(self.clone().with_alpha_mask(alpha_mask))
    }

    fn name(&self) -> &'static str {
        "bvh"
    }

    fn kind(&self) -> AcceleratorKind<'_> {
        AcceleratorKind::Bvh(self)
    }

    fn memory(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.triangles) + size_of_val(&*self.instances)
    }
}
