//! From triangles to nodes.
//!
//! 1. `cluster` sorts the triangles' boxes into a binary tree, which `reinsert` improves.
//! 2. `obvhs` collapses it into compressed nodes of eight children.
//! 3. We widen every quantised box that rounding left too small, so that each holds its triangles exactly: the margins of the
//!    walk rely on this.
//!
//! For every input, that takes O(n log n) time, and the tree has at most [`LEVELS`] levels: walks need no larger stack.

mod cluster;
mod reinsert;
mod work;

use std::ops::Range;
use std::sync::Arc;

use fearless_simd::Level;
use glam::{DVec3, Vec3, Vec3A};
use lightmesh_scene::{Bounds, Instance};
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use rayon::prelude::*;

use super::tree::{Bvh, Node};
use crate::accel::deduplicate::deduplicate;
use crate::accel::ray_clamp::{self, RayClamp};
use crate::accel::{AlphaMask, Instanced, ShapeTree, Triangle};
pub use work::{LEVELS, Work};

/// Most triangles in a leaf: the node format has room for three.
const LEAF_SIZE: u32 = 3;

pub(super) fn build(triangles: &[Triangle]) -> Bvh {
    let (nodes, triangles) = level(&usable(triangles));
    Bvh {
        depth: depth(&nodes),
        ray_clamp: RayClamp::around(&triangles),
        nodes: nodes.into(),
        triangles: triangles.into(),
        shapes: Arc::default(),
        instances: Arc::default(),
        shape_depth: 0,
        alpha_mask: AlphaMask::default(),
        level: Level::new(),
    }
}

/// A tree over the scene's own triangles and the boxes around instances, and after it one for each shape.
pub(super) fn build_levels(own: &[Triangle], stored: &[Triangle], instances: &[Instance], known: Option<&Bvh>) -> Bvh {
    // 1. The shapes that are anywhere.
    let mut shapes: Vec<Range<u32>> = instances.iter().map(|instance| instance.triangles.clone()).collect();
    shapes.sort_unstable_by_key(|shape| (shape.start, shape.end));
    shapes.dedup();
    let of_shape = |shape: &Range<u32>| level(&usable(&stored[shape.start as usize..shape.end as usize]));
    let known = known.filter(|known| known.shapes.iter().map(|(shape, _)| shape).eq(&shapes));
    let levels: Vec<(Vec<Node>, Vec<Triangle>)> = match known {
        Some(known) => (0..shapes.len()).map(|shape| known.shape_level(shape)).collect(),
        None => shapes.par_iter().map(of_shape).collect(),
    };
    let far = |shape: &Range<u32>| {
        let usable = stored[shape.start as usize..shape.end as usize].iter().filter(|triangle| triangle.is_usable());
        usable.flat_map(Triangle::corners).fold(Vec3::ZERO, |far, corner| far.max(corner.abs()))
    };
    let far: Vec<Vec3> = shapes.par_iter().map(far).collect();
    let shape_of = |instance: &Instance| {
        let key = (instance.triangles.start, instance.triangles.end);
        shapes.partition_point(|shape| (shape.start, shape.end) < key)
    };

    // 2. The scene, in which instances of which nothing can be hit are not held.
    let is_held = |(_, instance): &(u32, &Instance)| !levels[shape_of(instance)].0.is_empty();
    let holders =
        (0..).zip(instances).filter(is_held).map(|(number, instance)| Triangle::holder(&instance.bounds, number));
    let mut held = usable(own);
    held.extend(holders);
    let (mut nodes, mut triangles) = level(&held);
    let (depth_of_scene, ray_clamp) = (depth(&nodes), RayClamp::around(&triangles));

    // 3. All in one sequence.
    let (mut trees, mut shape_depth) = (Vec::with_capacity(shapes.len()), 0);
    for (mut own_nodes, own_triangles) in levels {
        shape_depth = shape_depth.max(depth(&own_nodes));
        let (first_node, first_triangle) = (nodes.len() as u32, triangles.len() as u32);
        trees.push(ShapeTree { root: first_node, leaves: first_triangle });
        for node in &mut own_nodes {
            node.child_base_idx += first_node;
            node.primitive_base_idx += first_triangle;
        }
        nodes.append(&mut own_nodes);
        triangles.extend(own_triangles);
    }
    let place = |instance: &Instance| {
        let shape = shape_of(instance);
        Instanced::new(instance, trees[shape], far[shape])
    };
    let instances: Vec<Instanced> = instances.iter().map(place).collect();
    Bvh {
        depth: depth_of_scene,
        ray_clamp,
        nodes: nodes.into(),
        triangles: triangles.into(),
        shapes: shapes.into_iter().zip(trees).collect(),
        instances: instances.into(),
        shape_depth,
        alpha_mask: AlphaMask::default(),
        level: Level::new(),
    }
}

/// What a tree is built over.
fn usable(triangles: &[Triangle]) -> Vec<Triangle> {
    deduplicate(triangles).into_iter().map(|at| triangles[at as usize]).collect()
}

/// The nodes of a tree and its triangles in the order of leaves.
fn level(triangles: &[Triangle]) -> (Vec<Node>, Vec<Triangle>) {
    let tree = tree(triangles, &mut Work::default());
    let triangles: Vec<_> = tree.primitive_indices.iter().map(|&index| triangles[index as usize]).collect();
    let mut nodes = tree.nodes;
    enclose(&mut nodes, &triangles);
    (nodes, triangles)
}

/// The tree over triangles, and how much work it was.
pub fn tree(triangles: &[Triangle], work: &mut Work) -> CwBvh {
    if triangles.is_empty() {
        return CwBvh::default();
    }
    let boxes: Vec<_> = triangles.iter().map(bounds).collect();
    let mut binary = cluster::cluster(&boxes, work);
    if binary.nodes.len() > 1 {
        reinsert::reinsert(&mut binary, work);
    }
    bvh2_to_cwbvh(&binary, LEAF_SIZE, true, false)
}

fn bounds(triangle: &Triangle) -> Aabb {
    Aabb::from_points(&triangle.corners().map(Vec3A::from))
}

/// One child of a node.
pub enum Child {
    /// Index of its node.
    Inner(usize),
    /// Its triangles.
    Leaf(std::ops::Range<usize>),
}

/// The occupied slots of a node.
pub fn children(node: &Node) -> impl Iterator<Item = (usize, Child)> + use<> {
    let node = *node;
    (0..8).filter(move |&slot| node.child_meta[slot] != 0).map(move |slot| {
        if node.imask >> slot & 1 == 1 {
            let before = node.imask & ((1 << slot) - 1);
            return (slot, Child::Inner(node.child_base_idx as usize + before.count_ones() as usize));
        }
        let meta = node.child_meta[slot];
        let first = node.primitive_base_idx as usize + usize::from(meta & 0b1_1111);
        (slot, Child::Leaf(first..first + (meta >> 5).count_ones() as usize))
    })
}

/// Widens the boxes of all nodes to hold their triangles. Children have higher indices than their parents.
fn enclose(nodes: &mut [Node], triangles: &[Triangle]) {
    let mut bounds = vec![Bounds::EMPTY; nodes.len()];
    for index in (0..nodes.len()).rev() {
        let boxes: Vec<_> = children(&nodes[index])
            .map(|(slot, child)| match child {
                Child::Inner(child) => (slot, bounds[child]),
                Child::Leaf(range) => (slot, ray_clamp::bounds(&triangles[range])),
            })
            .collect();
        bounds[index] = Bounds::around(boxes.iter().flat_map(|(_, bounds)| [bounds.min, bounds.max]));
        for axis in 0..3 {
            enclose_axis(&mut nodes[index], axis, &boxes, bounds[index].min[axis]);
        }
    }
}

/// Requantises the children's boxes on one axis if one of them does not hold its content.
fn enclose_axis(node: &mut Node, axis: usize, boxes: &[(usize, Bounds)], origin: f32) {
    let holds = |node: &Node| {
        let (start, step) = (node.p.as_dvec3()[axis], extent(node)[axis]);
        let (low, high) = planes(node, axis);
        boxes.iter().all(|(slot, bounds)| {
            start + step * f64::from(low[*slot]) <= f64::from(bounds.min[axis])
                && start + step * f64::from(high[*slot]) >= f64::from(bounds.max[axis])
        })
    };
    if holds(node) {
        return;
    }
    node.p[axis] = origin;
    loop {
        let (start, step) = (f64::from(origin), extent(node)[axis]);
        let quantised: Vec<_> = boxes
            .iter()
            .map(|(slot, bounds)| {
                let low = ((f64::from(bounds.min[axis]) - start) / step).floor();
                (*slot, low, ((f64::from(bounds.max[axis]) - start) / step).ceil())
            })
            .collect();
        if quantised.iter().all(|&(_, _, high)| high <= 255.0) {
            for (slot, low, high) in quantised {
                set_planes(node, axis, slot, low as u8, high as u8);
            }
            return;
        }
        node.e[axis] += 1;
    }
}

/// By how much a step of a node's boxes moves, on each axis.
pub fn extent(node: &Node) -> DVec3 {
    node.compute_extent().as_dvec3()
}

/// The lower and the upper planes of the boxes of a node's children on an axis, in steps.
pub fn planes(node: &Node, axis: usize) -> ([u8; 8], [u8; 8]) {
    match axis {
        0 => (node.child_min_x, node.child_max_x),
        1 => (node.child_min_y, node.child_max_y),
        _ => (node.child_min_z, node.child_max_z),
    }
}

fn set_planes(node: &mut Node, axis: usize, slot: usize, low: u8, high: u8) {
    let (lows, highs) = match axis {
        0 => (&mut node.child_min_x, &mut node.child_max_x),
        1 => (&mut node.child_min_y, &mut node.child_max_y),
        _ => (&mut node.child_min_z, &mut node.child_max_z),
    };
    (lows[slot], highs[slot]) = (low, high);
}

/// Number of levels.
pub fn depth(nodes: &[Node]) -> usize {
    let mut depths = vec![1; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for (_, child) in children(node) {
            if let Child::Inner(child) = child {
                depths[child] = depths[index] + 1;
            }
        }
    }
    depths.into_iter().max().unwrap_or(0)
}
