//! A wide BVH: eight children per node, 80 bytes per node, after Ylitie, Karras, Laine: *Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs* (HPG 2017).
//!
//! * `build`: the tree comes from `obvhs`; we make sure that every box holds its triangles, and store these in leaf order.
//! * `cost`: how good the tree is.
//! * `walk`: the traversal by a ray; `search`: by a region. Nodes and triangles are plain arrays, which devices copy.
//! * `packet`: the traversal by many coherent rays at once.

pub(crate) mod build;
mod cost;
mod packet;
mod search;
mod walk;

use std::ops::Range;
use std::sync::Arc;

use fearless_simd::{Level, Simd};
use glam::Vec3;
use lightmesh_scene::Instance;
use obvhs::cwbvh::node::CwBvhNode as Node;

pub use cost::BvhCost;

use super::approach::Approach;
use super::{
    Accelerator, Coverage, Form, Hit, Instanced, Ray, Region, ShapeTree, ShortSegments, Take, Triangle, Visitor,
};
use crate::simd::dispatch;

/// A compressed wide bounding volume hierarchy; clones share it.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Root first; empty if there are no triangles.
    nodes: Arc<[Node]>,
    /// In leaf order.
    triangles: Arc<[Triangle]>,
    /// Number of levels: the largest stack that a walk needs.
    depth: usize,
    /// The stored triangles of each shape, and its tree: these come after that of the scene, in this order.
    shapes: Arc<[(Range<u32>, ShapeTree)]>,
    /// Shapes at their places. Holders among the triangles name them.
    instances: Arc<[Instanced]>,
    /// The most levels of a shape's tree.
    shape_depth: usize,
    approach: Approach,
    coverage: Coverage,
    level: Level,
}

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

    /// The tree of a shape as if it were alone.
    fn shape_level(&self, shape: usize) -> (Vec<Node>, Vec<Triangle>) {
        let ShapeTree { root, leaves } = self.shapes[shape].1;
        let (next_root, next_leaves) = match self.shapes.get(shape + 1) {
            Some((_, next)) => (next.root as usize, next.leaves as usize),
            None => (self.nodes.len(), self.triangles.len()),
        };
        let mut nodes = self.nodes[root as usize..next_root].to_vec();
        for node in &mut nodes {
            node.child_base_idx -= root;
            node.primitive_base_idx -= leaves;
        }
        (nodes, self.triangles[leaves as usize..next_leaves].to_vec())
    }

    /// Its instances.
    #[doc(hidden)]
    pub fn instances(&self) -> &Arc<[Instanced]> {
        &self.instances
    }

    /// The opacities of triangles that are cut out.
    #[doc(hidden)]
    pub fn with_coverage(self, coverage: &Coverage) -> Bvh {
        Bvh { coverage: coverage.clone(), ..self }
    }

    /// These opacities.
    #[doc(hidden)]
    pub fn coverage(&self) -> &Coverage {
        &self.coverage
    }

    /// The nodes, root first.
    #[doc(hidden)]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The triangles in leaf order.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Number of levels, of the scene's tree and those of shapes together.
    pub fn depth(&self) -> usize {
        self.depth + self.shape_depth
    }

    /// Centre and radius of the sphere of interest.
    pub fn approach(&self) -> (Vec3, f32) {
        self.approach.parts()
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

    /// The same tree traversed at another SIMD level; every level gives the same bits.
    #[doc(hidden)]
    pub fn at_level(mut self, level: Level) -> Bvh {
        self.level = level;
        self
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

    fn search(&self, region: &Region, take: Take) {
        dispatch!(self.level, simd => search::search(simd, self, region, take));
    }

    fn covered_by(&self, coverage: &Coverage) -> Box<dyn Accelerator> {
        Box::new(self.clone().with_coverage(coverage))
    }

    fn name(&self) -> &'static str {
        "bvh"
    }

    fn form(&self) -> Form<'_> {
        Form::Bvh(self)
    }

    fn memory(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.triangles) + size_of_val(&*self.instances)
    }
}
