//! Sorts boxes into a binary tree, bottom up: *Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction*
//! (Meister, Bittner 2018).
//!
//! Boxes lie in the order of a space-filling curve. In each round every box chooses the partner near it with which it has the
//! smallest surface, and two that chose each other are joined. That takes O(n log n) time as long as a fixed share of the boxes
//! finds a partner in each round, which the paper hopes for. Two rules make sure of it:
//!
//! * Pairs are in a strict order: those of equal surface, as in a row of equal boxes, by a fixed rule that fits neighbours
//!   together. So ties never make everyone choose the same partner.
//! * A round that joins too few, as with boxes that hold each other, joins neighbours as well, as does every round that would
//!   otherwise leave more than the remaining levels can hold.

use glam::DVec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node as Node;
use obvhs::ploc::morton::morton_encode_u128_unorm;
use rayon::prelude::*;

use super::work::{LEVELS, Work};

/// Neighbours that a box looks at on each side,
const DISTANCE: usize = 14;
/// but one in the first rounds, when there are most boxes and the next is mostly the best,
const SHORT_ROUNDS: usize = 3;
const SHORT_DISTANCE: usize = 1;
/// At least this share of the boxes finds a partner in a round, one in so many,
const LEAST: usize = 8;
/// unless there are this few left, which form the levels that matter most.
const FEW: usize = 1024;

/// The tree over the boxes, none of which may be empty: at most [`LEVELS`] levels of inner nodes.
pub(super) fn cluster(boxes: &[Aabb], work: &mut Work) -> Bvh2 {
    let mut tree = Bvh2::zeroed(boxes.len());
    tree.primitive_indices = (0..boxes.len() as u32).collect();
    let mut clusters = leaves(boxes);
    let mut choices = Vec::new();
    let mut free = tree.nodes.len();
    for round in 0.. {
        if clusters.len() <= 1 {
            break;
        }
        let distance = if round < SHORT_ROUNDS { SHORT_DISTANCE } else { DISTANCE };
        choose(&clusters, distance, &mut choices);
        work.boxes += (clusters.len() * distance) as u64;
        let joined = (0..clusters.len()).filter(|&at| is_mutual(&choices, at)).count();
        if clusters.len() > 1 << (LEVELS - 1 - round).min(31) {
            // Half are left, rounded up, and so in every later round.
            join_all(&mut choices);
        } else if clusters.len() > FEW && joined * LEAST < clusters.len() {
            join_rest(&mut choices);
        }
        clusters = join(&clusters, &choices, &mut tree.nodes, &mut free);
    }
    if let Some(root) = clusters.first() {
        tree.nodes[0] = *root;
    }
    tree
}

/// A leaf for each box, along a space-filling curve through their centres.
fn leaves(boxes: &[Aabb]) -> Vec<Node> {
    let all = boxes.iter().fold(Aabb::empty(), |all, bounds| all.union(bounds));
    let scale = all.diagonal().as_dvec3().map(|edge| if edge > 0.0 { edge.recip() } else { 0.0 });
    let code = |at: u32| {
        let center = boxes[at as usize].center().as_dvec3() - all.min.as_dvec3();
        morton_encode_u128_unorm((center * scale).min(DVec3::splat(1.0 - f64::EPSILON)))
    };
    let mut order: Vec<(u128, u32)> = (0..boxes.len() as u32).into_par_iter().map(|at| (code(at), at)).collect();
    order.par_sort_unstable();
    order.into_iter().map(|(_, at)| Node::new(boxes[at as usize], 1, at)).collect()
}

/// The partner that a box would rather have than any other so far.
#[derive(Clone, Copy)]
struct Choice {
    surface: f32,
    partner: u32,
}

/// Every box's best partner at most `distance` away.
fn choose(clusters: &[Node], distance: usize, choices: &mut Vec<Choice>) {
    choices.clear();
    choices.resize(clusters.len(), Choice { surface: f32::INFINITY, partner: u32::MAX });
    for (at, cluster) in clusters.iter().enumerate() {
        for (other, candidate) in clusters.iter().enumerate().skip(at + 1).take(distance) {
            let surface = cluster.aabb().union(candidate.aabb()).half_area();
            for (own, partner) in [(at, other as u32), (other, at as u32)] {
                let known = choices[own];
                let better = surface < known.surface
                    || surface == known.surface && rank(own as u32, partner) < rank(own as u32, known.partner);
                if better {
                    choices[own] = Choice { surface, partner };
                }
            }
        }
    }
}

/// The order of pairs with equal surfaces, the same for both partners and different for all pairs: first those that fit together without
/// leaving one over, then any, but as if by chance, so that many are a pair's first choice from both sides.
fn rank(a: u32, b: u32) -> (bool, u64) {
    let pair = u64::from(a.min(b)) << 32 | u64::from(a.max(b));
    (a ^ 1 != b, pair.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(32).wrapping_mul(0xbf58_476d_1ce4_e5b9))
}

fn is_mutual(choices: &[Choice], at: usize) -> bool {
    choices[choices[at].partner as usize].partner as usize == at
}

/// Makes partners of neighbours, two by two. One may be left over: it is its own partner.
fn join_all(choices: &mut [Choice]) {
    let last = choices.len() - 1;
    for (at, choice) in choices.iter_mut().enumerate() {
        choice.partner = (at ^ 1).min(last) as u32;
    }
}

/// Makes partners of any two neighbours that would both be left over.
fn join_rest(choices: &mut [Choice]) {
    let mut at = 0;
    while at + 1 < choices.len() {
        if is_mutual(choices, at) || is_mutual(choices, at + 1) {
            at += 1;
            continue;
        }
        (choices[at].partner, choices[at + 1].partner) = (at as u32 + 1, at as u32);
        at += 2;
    }
}

/// The clusters of the next round. Pairs that are joined become siblings in front of `free`.
fn join(clusters: &[Node], choices: &[Choice], nodes: &mut [Node], free: &mut usize) -> Vec<Node> {
    let mut next = Vec::with_capacity(clusters.len());
    for (at, cluster) in clusters.iter().enumerate() {
        let partner = choices[at].partner as usize;
        if partner == at || !is_mutual(choices, at) {
            next.push(*cluster);
        } else if partner < at {
            // In the place of the later one.
            *free -= 2;
            (nodes[*free], nodes[*free + 1]) = (*cluster, clusters[partner]);
            next.push(Node::new(cluster.aabb().union(clusters[partner].aabb()), 0, *free as u32));
        }
    }
    next
}
