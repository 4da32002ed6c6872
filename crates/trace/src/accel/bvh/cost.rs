//! The cost of a tree by the surface area heuristic.

use super::build::{Child, children, extent, planes};
use super::tree::{Bvh, Node};

/// What a ray that crosses the box around all triangles is expected to do, by the surface area heuristic (MacDonald, Booth 1990).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BvhCost {
    /// Nodes that it enters.
    pub nodes: f64,
    /// Triangles that it is tested against.
    pub triangles: f64,
    /// Levels of the tree.
    pub levels: usize,
}

impl Bvh {
    /// The expected cost of a ray; nothing if there are no triangles.
    pub fn cost(&self) -> BvhCost {
        let Some(root) = self.nodes.first() else { return BvhCost::default() };
        let whole = area(root, 0..8);
        let mut cost = BvhCost { nodes: 1.0, triangles: 0.0, levels: self.depth };
        for node in self.nodes.iter() {
            for (slot, child) in children(node) {
                let share = area(node, slot..slot + 1) / whole;
                match child {
                    Child::Inner(_) => cost.nodes += share,
                    Child::Leaf(range) => cost.triangles += range.len() as f64 * share,
                }
            }
        }
        cost
    }
}

/// Half the surface of the box around some slots.
fn area(node: &Node, slots: std::ops::Range<usize>) -> f64 {
    let occupied = || slots.clone().filter(|&slot| node.child_meta[slot] != 0);
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let (low, high) = planes(node, axis);
        let low = occupied().map(|slot| low[slot]).min().unwrap_or(0);
        let high = occupied().map(|slot| high[slot]).max().unwrap_or(0);
        extent(node)[axis] * f64::from(high - low)
    });
    x * y + y * z + z * x
}
