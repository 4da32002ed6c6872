//! From triangles to nodes.
//!
//! 1. `obvhs` sorts the triangles' boxes into a binary tree (PLOC) and improves it by reinsertion.
//! 2. It collapses the tree into compressed nodes of eight children.
//! 3. We widen every quantised box that rounding left too small, so that each holds its triangles exactly: the margins of the
//!    walk rely on this.

use std::collections::HashMap;

use fearless_simd::Level;
use glam::{DVec3, Vec3A};
use lightmesh_scene::Bounds;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::{Bvh, Node};
use crate::accel::Triangle;
use crate::accel::approach::{self, Approach, usable};

/// Neighbours looked at on each side when boxes are paired.
const SEARCH_DISTANCE: PlocSearchDistance = PlocSearchDistance::Medium;
/// Levels below which a narrower search would do.
const SEARCH_DEPTH: usize = 3;
/// Share of the nodes that are reinserted in a round.
const REINSERTION: f32 = 0.1;
/// This many triangles may have the same box before their boxes are moved apart.
const SAME: u32 = 16;
/// Most triangles in a leaf: the node format has room for three.
const LEAF_SIZE: u32 = 3;

pub(super) fn build(triangles: &[Triangle]) -> Bvh {
    let triangles = usable(triangles);
    let approach = Approach::around(&triangles);
    let tree = tree(&triangles);
    let triangles: Vec<_> = tree.primitive_indices.iter().map(|&index| triangles[index as usize]).collect();
    let mut nodes = tree.nodes;
    enclose(&mut nodes, &triangles);
    Bvh { depth: depth(&nodes), nodes, triangles, approach, level: Level::new() }
}

fn tree(triangles: &[Triangle]) -> CwBvh {
    if triangles.is_empty() {
        return CwBvh::default();
    }
    let mut boxes: Vec<_> = triangles.iter().map(bounds).collect();
    spread(&mut boxes);
    let indices = (0..boxes.len() as u32).collect();
    let mut binary = PlocBuilder::with_capacity(boxes.len()).build(
        SEARCH_DISTANCE,
        &boxes,
        indices,
        SortPrecision::U64,
        SEARCH_DEPTH,
    );
    ReinsertionOptimizer::default().run(&mut binary, REINSERTION, None);
    bvh2_to_cwbvh(&binary, LEAF_SIZE, true, false)
}

fn bounds(triangle: &Triangle) -> Aabb {
    Aabb::from_points(&triangle.corners().map(Vec3A::from))
}

/// Slightly separates boxes that many triangles share. Equal boxes all find the same partner, so that only one pair is joined
/// per round and building takes quadratic time. Boxes that are moved too far are repaired by [`enclose`].
fn spread(boxes: &mut [Aabb]) {
    let mut seen: HashMap<[u32; 6], u32> = HashMap::new();
    for bounds in boxes {
        let [low, high] = [bounds.min, bounds.max].map(|corner| corner.to_array().map(f32::to_bits));
        let count = seen.entry([low[0], low[1], low[2], high[0], high[1], high[2]]).or_insert(0);
        *count += 1;
        if *count > SAME {
            // The fractional parts of multiples of irrational numbers fill the unit cube evenly.
            let share = (DVec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5) * f64::from(*count)).fract().as_vec3a();
            let size = bounds.diagonal().max_element().max(bounds.max.abs().max_element() * 1e-4);
            let shift = share * size * 0.01;
            (bounds.min, bounds.max) = (bounds.min + shift, bounds.max + shift);
        }
    }
}

/// One child of a node.
pub(super) enum Child {
    /// Index of its node.
    Inner(usize),
    /// Its triangles.
    Leaf(std::ops::Range<usize>),
}

/// The occupied slots of a node.
pub(super) fn children(node: &Node) -> impl Iterator<Item = (usize, Child)> + use<> {
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
                Child::Leaf(range) => (slot, approach::bounds(&triangles[range])),
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

pub(super) fn extent(node: &Node) -> DVec3 {
    node.compute_extent().as_dvec3()
}

pub(super) fn planes(node: &Node, axis: usize) -> ([u8; 8], [u8; 8]) {
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
fn depth(nodes: &[Node]) -> usize {
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

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::accel::{Accelerator, Hit, Ray};

    #[test]
    fn many_equal_triangles_make_a_shallow_tree() {
        let triangles: Vec<_> = (0..20_000).map(|index| Triangle::new([Vec3::ZERO, Vec3::X, Vec3::Y], index)).collect();
        let bvh = Bvh::new(&triangles);
        assert!(bvh.depth < 20, "{} levels", bvh.depth);
        let ray = Ray { origin: Vec3::new(0.2, 0.3, 1.0), direction: Vec3::NEG_Z, t_max: 2.0 };
        let mut hit = [Hit::MISS];
        bvh.closest_hits(&[ray], &mut hit);
        assert_eq!((hit[0].t, hit[0].triangle), (1.0, 0));
    }

    #[test]
    fn every_box_holds_its_triangles() {
        let corner = |index: u32| Vec3::new((index % 37) as f32, (index % 11) as f32 * 0.3, (index % 5) as f32) * 1.7;
        let triangles: Vec<_> =
            (0..999).map(|index| Triangle::new([0, 1, 2].map(|turn| corner(index + turn)), index)).collect();
        let bvh = Bvh::new(&triangles);
        let mut leaves = 0;
        for node in &bvh.nodes {
            for (slot, child) in children(node) {
                let Child::Leaf(range) = child else { continue };
                leaves += range.len();
                let content = approach::bounds(&bvh.triangles[range]);
                for axis in 0..3 {
                    let (start, step, (low, high)) = (node.p.as_dvec3()[axis], extent(node)[axis], planes(node, axis));
                    assert!(start + step * f64::from(low[slot]) <= f64::from(content.min[axis]));
                    assert!(start + step * f64::from(high[slot]) >= f64::from(content.max[axis]));
                }
            }
        }
        assert_eq!(leaves, triangles.len());
    }
}
