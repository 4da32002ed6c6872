//! The tree itself: compressed nodes of eight children, root first, and triangles in leaf order. Trees of shapes follow the scene's own.

use std::ops::Range;
use std::sync::Arc;

use fearless_simd::Level;
use glam::Vec3;
pub(super) use obvhs::cwbvh::node::CwBvhNode as Node;

use crate::accel::ray_clamp::RayClamp;
use crate::accel::{AlphaMask, Instanced, ShapeTree, Triangle};

/// A compressed wide bounding volume hierarchy; clones share it.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Root first; empty if there are no triangles.
    pub(super) nodes: Arc<[Node]>,
    /// In leaf order.
    pub(super) triangles: Arc<[Triangle]>,
    /// Number of levels: the largest stack that a walk needs.
    pub(super) depth: usize,
    /// The stored triangles of each shape, and its tree: these come after that of the scene, in this order.
    pub(super) shapes: Arc<[(Range<u32>, ShapeTree)]>,
    /// Shapes at their places. Holders among the triangles name them.
    pub(super) instances: Arc<[Instanced]>,
    /// The most levels of a shape's tree.
    pub(super) shape_depth: usize,
    pub(super) ray_clamp: RayClamp,
    pub(super) alpha_mask: AlphaMask,
    pub(super) level: Level,
}

impl Bvh {
    /// The tree of a shape as if it were alone.
    pub(super) fn shape_level(&self, shape: usize) -> (Vec<Node>, Vec<Triangle>) {
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
    #[inline]
    pub fn instances(&self) -> &Arc<[Instanced]> {
        &self.instances
    }

    /// The opacities of triangles that are cut out.
    #[doc(hidden)]
    #[inline]
    pub fn with_alpha_mask(self, alpha_mask: &AlphaMask) -> Bvh {
        Bvh { alpha_mask: alpha_mask.clone(), ..self }
    }

    /// These opacities.
    #[doc(hidden)]
    #[inline]
    pub fn alpha_mask(&self) -> &AlphaMask {
        &self.alpha_mask
    }

    /// The nodes, root first.
    #[doc(hidden)]
    #[inline]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The triangles in leaf order.
    #[inline]
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Number of levels, of the scene's tree and those of shapes together.
    #[inline]
    pub fn depth(&self) -> usize {
        self.depth + self.shape_depth
    }

    /// Centre and radius of the sphere of interest.
    #[inline]
    pub fn ray_clamp(&self) -> (Vec3, f32) {
        self.ray_clamp.parts()
    }

    /// The same tree traversed at another SIMD level; every level gives the same bits.
    #[doc(hidden)]
    #[inline]
    pub fn at_level(mut self, level: Level) -> Bvh {
        self.level = level;
        self
    }
}
