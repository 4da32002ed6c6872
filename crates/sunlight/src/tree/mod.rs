//! Triangles in boxes along the equator's axes, and the walk that takes from a receiver's day what they hide.
//!
//! * `build`: a binary tree by the surface area heuristic, collapsed to nodes of eight children. Leaves hold one triangle.
//! * `hours`: from a box to the times when the sun can be behind it.
//! * A walk visits near boxes first, as long as they touch what is open.

mod build;
mod hours;
mod node;

use glam::{DMat3, DVec3};

pub use hours::HourTable;

use self::node::{LEAF, NONE, Node, ROUNDING, WIDTH};
use crate::blocker::{Blocker, Receiver};
use crate::edge::positive;
use crate::open::{MANY, Open};
use crate::path::SunPath;
use crate::triangle::Facet;

/// A triangle whose plane passes a point closer than this, relative to the extent of all, is seen edge-on.
const FLAT: f64 = 1e-10;
/// What hides the sun, for any day of a place.
#[derive(Clone, Debug)]
pub struct Tree {
    nodes: Vec<Node>,
    facets: Vec<Facet>,
    /// To the axes of the equator: meridian, pole, west.
    axes: DMat3,
    flat: f64,
}

/// What a walk keeps from receiver to receiver.
#[derive(Clone, Debug, Default)]
pub struct Walker {
    open: Open,
    stack: Vec<Entry>,
    near: Vec<(f32, Entry)>,
}

/// Something that is to be visited.
#[derive(Clone, Copy, Debug)]
struct Entry {
    child: u32,
    object: u32,
    /// When the sun can be behind it.
    times: [(f32, f32); 2],
}

impl Tree {
    /// A tree over triangles; `axes` are those of a [`SunPath`] of the place.
    pub fn new(blockers: &[Blocker], axes: DMat3) -> Tree {
        let extent = blockers
            .iter()
            .flat_map(|blocker| blocker.corners)
            .fold(0.0, |far: f64, corner| far.max(corner.abs().max_element()));
        let (nodes, order) = build::build(blockers, axes);
        let facet = |&at: &u32| Facet::new(blockers[at as usize].corners, blockers[at as usize].object);
        Tree { nodes, facets: order.iter().map(facet).collect(), axes, flat: FLAT * extent.max(1.0) }
    }

    /// Finds when a receiver sees the sun on a path; `attributes`: also who takes the rest. The result is the walker's.
    pub fn walk<'a>(
        &self,
        (path, hours): (&SunPath, &HourTable),
        receiver: &Receiver,
        attributes: bool,
        walker: &'a mut Walker,
    ) -> &'a Open {
        let Walker { open, stack, near } = walker;
        let in_front = match receiver.normal == DVec3::ZERO {
            true => path.up,
            false => path.up.and(&positive(path, receiver.normal, path.hull)),
        };
        open.begin(&in_front, attributes);
        let point = self.axes * receiver.point;
        let point = [point.x as f32, point.y as f32, point.z as f32];
        // Twice: the point is rounded, and so is its difference from a box.
        let slack = 2.0 * ROUNDING * point.iter().fold(0.0, |far: f32, value| far.max(value.abs()));
        stack.clear();
        if !self.nodes.is_empty() {
            stack.push(Entry { child: 0, object: MANY, times: hours.always() });
        }
        while let Some(Entry { child, object, times }) = stack.pop() {
            if !open.touches(&times, object) {
                continue;
            }
            if child & LEAF != 0 {
                let facet = &self.facets[(child & !LEAF) as usize];
                let (first, last) = open.hull();
                let begin = f64::from(times[0].0.min(times[1].0)).max(first);
                let end = f64::from(times[0].1.max(times[1].1)).min(last);
                let hidden = facet.hidden(path, receiver.point, self.flat, (begin, end));
                if !hidden.is_empty() {
                    open.take(&hidden, facet.object);
                    if open.is_done() {
                        break;
                    }
                }
                continue;
            }
            let node = &self.nodes[child as usize];
            near.clear();
            let around = hours.around(node, point, slack);
            for lane in (0..WIDTH).take_while(|&lane| node.child[lane] != NONE) {
                let Some(times) = hours.times(&around, lane) else { continue };
                if open.touches(&times, node.object[lane]) {
                    let entry = Entry { child: node.child[lane], object: node.object[lane], times };
                    near.push((around.distance[lane], entry));
                }
            }
            near.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
            stack.extend(near.iter().map(|(_, entry)| entry));
        }
        open
    }
}
