//! From triangles to nodes.
//!
//! 1. A binary tree, from the top: boxes are sorted into bins of their middles along each axis, and split where the areas times the numbers of both sides are
//!    least (the surface area heuristic). Where that cannot decide, halves are equal.
//! 2. Nodes of eight children: the largest child is opened until there are eight.

use glam::{DMat3, Vec3};
use rayon::join;

use super::node::{LEAF, NONE, Node, ROUNDING, WIDTH};
use crate::blocker::Blocker;
use crate::open::MANY;

/// Bins along an axis.
const BINS: usize = 16;
/// More triangles than this are built by two threads.
const MANY_TRIANGLES: usize = 4096;
/// From this depth on, halves are equal: no input makes the tree deep.
const DEEP: usize = 48;

/// A box.
#[derive(Clone, Copy, Debug)]
struct Box3 {
    low: Vec3,
    high: Vec3,
}

impl Box3 {
    const EMPTY: Box3 = Box3 { low: Vec3::MAX, high: Vec3::MIN };

    fn and(self, other: Box3) -> Box3 {
        Box3 { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half of its surface.
    fn area(&self) -> f32 {
        let size = (self.high - self.low).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// Twice its middle.
    fn middle(&self) -> Vec3 {
        self.low + self.high
    }
}

/// A part of the binary tree.
struct Part {
    bounds: Box3,
    object: u32,
    content: Content,
}

enum Content {
    Leaf(u32),
    Halves(Box<[Part; 2]>),
}

/// The nodes, of which the first is the root, and the numbers of triangles in the order of leaves.
pub(super) fn build(blockers: &[Blocker], axes: DMat3) -> (Vec<Node>, Vec<u32>) {
    let is_usable = |blocker: &Blocker| blocker.corners.iter().all(|corner| corner.is_finite());
    let mut order: Vec<u32> = (0..).zip(blockers).filter(|(_, blocker)| is_usable(blocker)).map(|(at, _)| at).collect();
    if order.is_empty() {
        return (Vec::new(), order);
    }
    let boxes: Vec<Box3> = blockers.iter().map(|blocker| around(blocker, axes)).collect();
    let work = Work { blockers, boxes: &boxes };
    let root = work.part(&mut order, 0, 0);
    let mut nodes = Vec::new();
    flatten(root, &mut nodes);
    (nodes, order)
}

/// The box around a triangle, widened by what single precision may have taken.
fn around(blocker: &Blocker, axes: DMat3) -> Box3 {
    blocker.corners.iter().fold(Box3::EMPTY, |bounds, &corner| {
        let corner = (axes * corner).as_vec3();
        let slack = ROUNDING * corner.abs().max_element();
        bounds.and(Box3 { low: corner - slack, high: corner + slack })
    })
}

struct Work<'a> {
    blockers: &'a [Blocker],
    boxes: &'a [Box3],
}

impl Work<'_> {
    /// The tree over triangles that stand at `first` in the order of leaves.
    fn part(&self, order: &mut [u32], first: u32, depth: usize) -> Part {
        let bounds = order.iter().fold(Box3::EMPTY, |bounds, &at| bounds.and(self.boxes[at as usize]));
        let object = self.blockers[order[0] as usize].object;
        let is_one = order.iter().all(|&at| self.blockers[at as usize].object == object);
        let object = if is_one { object } else { MANY };
        if order.len() == 1 {
            return Part { bounds, object, content: Content::Leaf(first) };
        }
        let middle = self.split(order, depth);
        let (left, right) = order.split_at_mut(middle);
        let second = first + middle as u32;
        let halves = if left.len() + right.len() > MANY_TRIANGLES {
            join(|| self.part(left, first, depth + 1), || self.part(right, second, depth + 1))
        } else {
            (self.part(left, first, depth + 1), self.part(right, second, depth + 1))
        };
        Part { bounds, object, content: Content::Halves(Box::new(halves.into())) }
    }

    /// Sorts into two halves; returns where the second begins.
    fn split(&self, order: &mut [u32], depth: usize) -> usize {
        let middles = order.iter().map(|&at| self.boxes[at as usize].middle());
        let (low, high) =
            middles.fold((Vec3::MAX, Vec3::MIN), |(low, high), middle| (low.min(middle), high.max(middle)));
        let size = high - low;
        let bin = |at: u32, axis: usize| {
            let share = (self.boxes[at as usize].middle()[axis] - low[axis]) / size[axis];
            ((share * BINS as f32) as usize).min(BINS - 1)
        };
        let mut best = (f32::INFINITY, 0, 0);
        for axis in (0..3).filter(|&axis| size[axis] > 0.0 && depth < DEEP) {
            let mut bins = [(Box3::EMPTY, 0_usize); BINS];
            for &at in order.iter() {
                let (bounds, count) = &mut bins[bin(at, axis)];
                (*bounds, *count) = (bounds.and(self.boxes[at as usize]), *count + 1);
            }
            let mut after = [0.0; BINS];
            let (mut bounds, mut count) = (Box3::EMPTY, 0);
            for at in (1..BINS).rev() {
                (bounds, count) = (bounds.and(bins[at].0), count + bins[at].1);
                after[at] = bounds.area() * count as f32;
            }
            let (mut bounds, mut count) = (Box3::EMPTY, 0);
            for at in 0..BINS - 1 {
                (bounds, count) = (bounds.and(bins[at].0), count + bins[at].1);
                let cost = bounds.area() * count as f32 + after[at + 1];
                if cost < best.0 && count > 0 && count < order.len() {
                    best = (cost, axis, at);
                }
            }
        }
        let (cost, axis, last) = best;
        if cost < f32::INFINITY {
            let mut count = 0;
            for at in 0..order.len() {
                if bin(order[at], axis) <= last {
                    order.swap(at, count);
                    count += 1;
                }
            }
            return count;
        }
        let axis = size.max_position();
        let half = order.len() / 2;
        let middle = |at: &u32| self.boxes[*at as usize].middle()[axis];
        order.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        half
    }
}

/// Adds the node of a part and all below; returns its number.
fn flatten(part: Part, nodes: &mut Vec<Node>) -> u32 {
    let number = nodes.len() as u32;
    nodes.push(Node {
        low: [[f32::MAX; WIDTH]; 3],
        high: [[f32::MIN; WIDTH]; 3],
        child: [NONE; WIDTH],
        object: [MANY; WIDTH],
    });
    let mut children = vec![part];
    while children.len() < WIDTH {
        let is_open = |(_, part): &(usize, &Part)| matches!(part.content, Content::Halves(_));
        let largest = children.iter().enumerate().filter(is_open);
        let Some((at, _)) = largest.max_by(|(_, a), (_, b)| a.bounds.area().total_cmp(&b.bounds.area())) else { break };
        if let Content::Halves(halves) = children.swap_remove(at).content {
            children.extend(*halves);
        }
    }
    for (lane, part) in children.into_iter().enumerate() {
        let Part { bounds, object, content } = part;
        for axis in 0..3 {
            nodes[number as usize].low[axis][lane] = bounds.low[axis];
            nodes[number as usize].high[axis][lane] = bounds.high[axis];
        }
        nodes[number as usize].object[lane] = object;
        let child = match content {
            Content::Leaf(at) => at | LEAF,
            halves => flatten(Part { bounds, object, content: halves }, nodes),
        };
        nodes[number as usize].child[lane] = child;
    }
    number
}
