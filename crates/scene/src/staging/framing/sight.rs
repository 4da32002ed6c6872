//! What a few thousand rays meet: enough to judge where a camera sees something and a light reaches it.
//!
//! A complete binary tree over the triangles, split at medians of their centres along the longest axis. It takes at most 40 bytes per triangle, is
//! built in less time than a file takes to be read, and is dropped with the decision. Images are made with the renderer's structures: here a
//! ray may slip through an edge between two triangles. Results depend on the triangles alone, not on the number of threads.

use glam::Vec3;
use rayon::prelude::*;

use crate::{Bounds, Mesh};

/// Triangles of a leaf, at most.
const LEAF: usize = 4;
/// Ranges of triangles from this size on are split by several threads.
const PARALLEL: usize = 1 << 14;
/// Stands for a component of a direction that is smaller: its inverse is finite.
const MIN_COMPONENT: f32 = 1e-20;
/// By how much a ray leaves a box later than computed: several roundings.
const LATER: f32 = 1.0 + 1e-6;

/// The first triangle that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// In units of the direction.
    pub distance: f32,
    /// Its number.
    pub triangle: u32,
}

/// A mesh that can be asked what a ray meets.
pub struct Sight<'a> {
    mesh: &'a Mesh,
    /// All triangles, those of a leaf next to each other.
    order: Vec<u32>,
    /// Boxes of the tree by level; the children of node i are 2i + 1 and 2i + 2.
    boxes: Vec<Bounds>,
    /// Number of leaves, a power of two.
    leaves: usize,
}

impl<'a> Sight<'a> {
    /// Sorts the triangles of a mesh.
    pub fn new(mesh: &'a Mesh) -> Sight<'a> {
        let count = mesh.triangles.len();
        let leaves = count.div_ceil(LEAF).max(1).next_power_of_two();
        let centers: Vec<Vec3> =
            (0..count).into_par_iter().map(|index| mesh.corners(index).iter().sum::<Vec3>() / 3.0).collect();
        let mut order: Vec<u32> = (0..count as u32).collect();
        split(&mut order, &centers, 0..leaves, leaves, 0);
        let mut sight = Sight { mesh, order, boxes: vec![Bounds::EMPTY; 2 * leaves - 1], leaves };
        for leaf in 0..leaves {
            let corners = sight.of_leaf(leaf).iter().flat_map(|&triangle| mesh.corners(triangle as usize));
            sight.boxes[leaves - 1 + leaf] = Bounds::around(corners);
        }
        for node in (0..leaves - 1).rev() {
            let (left, right) = (sight.boxes[2 * node + 1], sight.boxes[2 * node + 2]);
            sight.boxes[node] = Bounds { min: left.min.min(right.min), max: left.max.max(right.max) };
        }
        sight
    }

    pub(super) fn mesh(&self) -> &'a Mesh {
        self.mesh
    }

    fn of_leaf(&self, leaf: usize) -> &[u32] {
        &self.order[start(leaf, self.leaves, self.order.len())..start(leaf + 1, self.leaves, self.order.len())]
    }

    /// The first triangle on the way from `origin` along `direction`; the smallest index of several.
    pub fn first(&self, origin: Vec3, direction: Vec3) -> Option<Seen> {
        let usable = |d: f32| if d.abs() < MIN_COMPONENT { MIN_COMPONENT } else { d };
        let inverse = direction.map(usable).recip();
        let mut nearest = Seen { distance: f32::INFINITY, triangle: u32::MAX };
        // One sibling waits on every level of at most 31.
        let mut waiting = [(0, 0.0); 32];
        let mut count = 0;
        let mut next = self.entry(0, origin, inverse).map(|near| (0, near));
        while let Some((node, near)) = next.take() {
            if near <= nearest.distance {
                if node >= self.leaves - 1 {
                    for &triangle in self.of_leaf(node - (self.leaves - 1)) {
                        let distance = distance(self.mesh.corners(triangle as usize), origin, direction);
                        let closer = (distance, triangle) < (nearest.distance, nearest.triangle);
                        nearest = if closer { Seen { distance, triangle } } else { nearest };
                    }
                } else {
                    let child = |node: usize| self.entry(node, origin, inverse).map(|near| (node, near));
                    match (child(2 * node + 1), child(2 * node + 2)) {
                        (Some(left), Some(right)) => {
                            let (first, second) = if right.1 < left.1 { (right, left) } else { (left, right) };
                            waiting[count] = second;
                            count += 1;
                            next = Some(first);
                        }
                        (left, right) => next = left.or(right),
                    }
                }
            }
            if next.is_none() && count > 0 {
                count -= 1;
                next = Some(waiting[count]);
            }
        }
        nearest.distance.is_finite().then_some(nearest)
    }

    /// Whether nothing is between two points.
    pub fn is_free(&self, from: Vec3, to: Vec3) -> bool {
        self.first(from, to - from).is_none_or(|seen| seen.distance >= 1.0)
    }

    /// How far it is from `origin` to the first triangle along a unit direction, at most `most`.
    pub fn free(&self, origin: Vec3, direction: Vec3, most: f32) -> f32 {
        self.first(origin, direction).map_or(most, |seen| seen.distance.min(most))
    }

    /// The unit normal to the front of a triangle; zero if it has none. Vertex normals know better than the order of the corners.
    pub fn normal(&self, triangle: u32) -> Vec3 {
        let [a, b, c] = self.mesh.corners(triangle as usize);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let given = |vertex: u32| self.mesh.normals.get(vertex as usize).copied().unwrap_or(Vec3::ZERO);
        let given: Vec3 = self.mesh.triangles[triangle as usize].into_iter().map(given).sum();
        if given.dot(normal) < 0.0 { -normal } else { normal }
    }

    /// Where a ray enters the box of a node, if it meets it.
    fn entry(&self, node: usize, origin: Vec3, inverse: Vec3) -> Option<f32> {
        let Bounds { min, max } = self.boxes[node];
        let (a, b) = ((min - origin) * inverse, (max - origin) * inverse);
        let (near, far) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
        (near <= LATER * far).then_some(near)
    }
}

/// The first triangle of a leaf.
fn start(leaf: usize, leaves: usize, count: usize) -> usize {
    (leaf as u64 * count as u64 / leaves as u64) as usize
}

/// Orders the triangles of a range of leaves, which begin at number `first`, by leaf.
fn split(order: &mut [u32], centers: &[Vec3], range: std::ops::Range<usize>, leaves: usize, first: usize) {
    if range.len() < 2 {
        return;
    }
    let extent = Bounds::around(order.iter().map(|&triangle| centers[triangle as usize])).extent();
    let axis = extent.max_position();
    let middle = range.start + range.len() / 2;
    let at = start(middle, leaves, centers.len()) - first;
    if at < order.len() {
        let along = |triangle: u32| centers[triangle as usize][axis];
        order.select_nth_unstable_by(at, |&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
    }
    let is_large = order.len() >= PARALLEL;
    let (left, right) = order.split_at_mut(at);
    let mut left = || split(left, centers, range.start..middle, leaves, first);
    let mut right = || split(right, centers, middle..range.end, leaves, first + at);
    if is_large {
        rayon::join(left, right);
    } else {
        left();
        right();
    }
}

/// The distance to a triangle in units of the direction; infinite if the ray misses it (Möller and Trumbore, *Fast, Minimum Storage
/// Ray/Triangle Intersection*, 1997).
pub fn distance([a, b, c]: [Vec3; 3], origin: Vec3, direction: Vec3) -> f32 {
    let (ab, ac, ao) = (b - a, c - a, origin - a);
    let across = direction.cross(ac);
    let scale = ab.dot(across).recip();
    let (u, beside) = (ao.dot(across) * scale, ao.cross(ab));
    let (v, t) = (direction.dot(beside) * scale, ac.dot(beside) * scale);
    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 { t } else { f32::INFINITY }
}
