//! Improves a binary tree by taking nodes out and inserting them where the surface of all nodes becomes smallest: *Parallel
//! Reinsertion for Bounding Volume Hierarchy Optimization* (Meister, Bittner 2018).
//!
//! A search prunes what cannot be better than the best place known. Where boxes hold each other that prunes nothing, so a search ends
//! after a fixed number of nodes, and no move is made that would add a level beyond [`LEVELS`].

use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node as Node;
use obvhs::bvh2::reinsertion::reinsert_node;
use rayon::prelude::*;

use super::work::{LEVELS, Work};

/// Share of the nodes that are moved in the first round,
const SHARE: f32 = 0.1;
/// and by which it is divided in each round.
const DIVISORS: [f32; 16] = [1.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0, 15.0, 17.0, 19.0, 21.0, 23.0, 25.0, 27.0, 29.0, 31.0];
/// Most nodes that a search looks at.
const MOST: u32 = 1024;

/// Moves nodes of a tree whose root is not a leaf.
pub(super) fn reinsert(tree: &mut Bvh2, work: &mut Work) {
    tree.init_parents_if_uninit();
    let mut heights = heights(tree);
    let mut touched = vec![false; tree.nodes.len()];
    for divisor in DIVISORS {
        let count = ((tree.nodes.len() as f32 * SHARE / divisor) as usize).clamp(1, tree.nodes.len() - 1);
        let searches: Vec<(Move, u32)> =
            candidates(tree, count).par_iter().map(|&node| Search::new(tree, node).run()).collect();
        work.boxes += searches.iter().map(|&(_, looked_at)| u64::from(looked_at)).sum::<u64>();
        let mut moves: Vec<Move> = searches.into_iter().map(|(best, _)| best).filter(|best| best.gain > 0.0).collect();
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        touched.fill(false);
        for best in moves {
            let changed = best.changed(tree);
            if changed.iter().any(|&node| touched[node]) || best.levels(tree, &heights) > LEVELS {
                continue;
            }
            changed.iter().for_each(|&node| touched[node] = true);
            best.make(tree, &mut heights);
        }
    }
}

/// The nodes with the largest surfaces, in no order, among the first ones, which lie near the root.
fn candidates(tree: &Bvh2, count: usize) -> Vec<u32> {
    let mut candidates: Vec<u32> = (1..tree.nodes.len().min(2 * count + 2) as u32).collect();
    let surface = |&node: &u32| tree.nodes[node as usize].aabb().half_area();
    if count < candidates.len() {
        candidates.select_nth_unstable_by(count, |a, b| surface(b).total_cmp(&surface(a)).then(a.cmp(b)));
        candidates.truncate(count);
    }
    candidates
}

/// Levels of inner nodes below and at each node. Children come after their parents.
fn heights(tree: &Bvh2) -> Vec<u8> {
    let mut heights = vec![0; tree.nodes.len()];
    for node in (0..tree.nodes.len()).rev() {
        heights[node] = height(tree, &heights, node);
    }
    heights
}

fn height(tree: &Bvh2, heights: &[u8], node: usize) -> u8 {
    let node = &tree.nodes[node];
    let first = node.first_index as usize;
    if node.is_leaf() { 0 } else { 1 + heights[first].max(heights[first + 1]) }
}

/// A node taken out and made the sibling of another.
#[derive(Clone, Copy)]
struct Move {
    from: usize,
    to: usize,
    /// By how much the surface of all nodes shrinks; 0: there is nothing to gain.
    gain: f32,
}

impl Move {
    /// The nodes whose content changes.
    fn changed(&self, tree: &Bvh2) -> [usize; 5] {
        let parent = |node: usize| tree.parents[node] as usize;
        [self.to, self.from, Node::get_sibling_id(self.from), parent(self.to), parent(self.from)]
    }

    /// Most levels that the tree then has on the way to the two nodes.
    fn levels(&self, tree: &Bvh2, heights: &[u8]) -> usize {
        let above = std::iter::successors(Some(self.to), |&node| (node != 0).then(|| tree.parents[node] as usize));
        above.count() + usize::from(heights[self.from].max(heights[self.to]))
    }

    fn make(&self, tree: &mut Bvh2, heights: &mut [u8]) {
        let (sibling, parent) = (Node::get_sibling_id(self.from), tree.parents[self.from] as usize);
        // The sibling moves into the place of its parent, and the target into that of the sibling.
        (heights[parent], heights[sibling]) = (heights[sibling], heights[self.to]);
        reinsert_node(tree, self.from, self.to);
        for lowest in [self.to, parent] {
            let mut node = lowest;
            loop {
                heights[node] = height(tree, heights, node);
                if node == 0 {
                    break;
                }
                node = tree.parents[node] as usize;
            }
        }
    }
}

/// The search for a node's best place. Going up from the node to the root, it looks at the subtrees next to the way.
struct Search<'a> {
    tree: &'a Bvh2,
    node: usize,
    best: Move,
    looked_at: u32,
    /// Nodes to look at, with what is gained before the moved node is added there.
    open: Vec<(f32, usize)>,
}

impl Search<'_> {
    fn new(tree: &Bvh2, node: u32) -> Search<'_> {
        let node = node as usize;
        Search { tree, node, best: Move { from: node, to: 0, gain: 0.0 }, looked_at: 0, open: Vec::with_capacity(64) }
    }

    fn run(mut self) -> (Move, u32) {
        let (nodes, parents) = (&self.tree.nodes, &self.tree.parents);
        let parent = parents[self.node] as usize;
        let mut sibling = Node::get_sibling_id(self.node);
        // What remains of the node on the way once the moved one is gone.
        let mut rest = *nodes[sibling].aabb();
        let mut gain = nodes[parent].aabb().half_area();
        let mut way = parent;
        loop {
            self.descend(gain, sibling);
            if way != parent {
                rest = rest.union(nodes[sibling].aabb());
                gain += nodes[way].aabb().half_area() - rest.half_area();
            }
            if way == 0 || self.looked_at >= MOST {
                break;
            }
            sibling = Node::get_sibling_id(way);
            way = parents[way] as usize;
        }
        if self.best.to == Node::get_sibling_id(self.node) || self.best.to == parent {
            self.best.gain = 0.0;
        }
        (self.best, self.looked_at)
    }

    /// Looks at a subtree.
    fn descend(&mut self, gain: f32, root: usize) {
        let moved = &self.tree.nodes[self.node];
        let least = moved.aabb().half_area();
        self.open.clear();
        self.open.push((gain, root));
        while let Some((gain, at)) = self.open.pop() {
            if gain - least <= self.best.gain {
                continue;
            }
            self.looked_at += 1;
            if self.looked_at > MOST {
                return;
            }
            let place = &self.tree.nodes[at];
            let after = gain - place.aabb().union(moved.aabb()).half_area();
            if after > self.best.gain {
                (self.best.to, self.best.gain) = (at, after);
            }
            if !place.is_leaf() {
                let (below, first) = (after + place.aabb().half_area(), place.first_index as usize);
                self.open.extend([(below, first), (below, first + 1)]);
            }
        }
    }
}
