//! Light that was reflected several times: what reaches the points that gather rays hit.
//!
//! A coarse cell and the kind of surface that a ray hits in it name one record, a *node*, which gathers by rays of its own. What its rays hit is
//! asked in the same way. So light after any number of reflections is a sum over links:
//!
//! ```text
//! A_1(k) = Σ_j ω_j S_j        A_n(k) = Σ_j ω_j (S_j + k_d,j A_(n−1)(j))
//! ```
//!
//! over the rays j of node k. S_j is what is seen without other reflections. If something is between a hit and the record of its cell, such as a wall
//! that stands on a floor, or covers the record nearer than the cell is large, such as the other side of a slit, a smaller cell around the hit is asked,
//! up to twice (rays of nodes do so only for what is covered, or brighter than the mean of what they see); at last the mean of what the other hits receive stands for it: so nothing leaks.
//!
//! A node is linked once, whatever is asked of it. It keeps the light after each number of reflections: so what is known of it depends neither on who
//! asked for it nor on what was asked before. Twin: `bounce.cuh`.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use glam::Vec3;
use lightmesh_layout::constants::{BOUNCE_FINER, BOUNCE_SIDE, ORDERS as MAX_ORDERS};
use rayon::prelude::*;

use super::cells::{Asked, CellHasher, KIND_BITS, NAME_BITS, Record, nearest_of_kind};
use super::hemisphere_rays::HemisphereRays;
use super::rays::{Seen, Spot, brightness};
use super::scene::Scene;
use crate::shading::luminance;
use crate::stages::primary_rays::cpu::batch;

/// How often light is reflected before it reaches what a gather ray hits, at most, with the first time by a light's.
pub(crate) const ORDERS: usize = MAX_ORDERS as usize;
/// The rays of a node.
pub(super) const NODE_RAYS: HemisphereRays = HemisphereRays::new(BOUNCE_SIDE);

/// The name of a node: its cell, by how many levels that is smaller than what was asked at first, and its kind of surface.
type Name = u64;

impl Spot {
    fn asked(&self) -> Asked {
        Asked::new(self.place.level, self.place.cell())
    }

    fn name(&self) -> Name {
        self.asked().key << NAME_BITS | (self.finer as u64) << KIND_BITS | u64::from(self.kind)
    }

    /// The same in a cell of half the size, if there may be one.
    fn finer(self) -> Option<Spot> {
        (self.finer < BOUNCE_FINER).then(|| self.smaller(1))
    }

    /// The same in a cell that is smaller by so many levels.
    fn smaller(mut self, levels: i32) -> Spot {
        self.place.level -= levels;
        self.finer += levels;
        self
    }

    /// The same in the smallest cell that may be asked.
    pub(super) fn finest(self) -> Spot {
        self.smaller(BOUNCE_FINER - self.finer)
    }
}

/// What a node's rays see.
pub(super) struct Links {
    /// The nodes at hits, with the weights of what they receive.
    seen: Box<[(u32, Vec3)]>,
    /// The weight of hits that see no node.
    hidden: Vec3,
}

/// A record, and what its rays see.
pub(super) struct Node {
    /// Its level is that of the smallest cells that its rays ask: that of its cell, or what was asked at first. So cells do not become smaller from
    /// reflection to reflection.
    pub(super) record: Record,
    /// Whether something covers it: for smaller cells around a hit, others may answer better.
    pub(super) covered: bool,
    /// `None` if its rays were not cast.
    links: Option<Links>,
    /// How many of the values are known: what arrives after up to one, two, … reflections.
    pub(super) known: usize,
    /// How many are asked for.
    wanted: usize,
    pub(super) values: [Vec3; ORDERS],
}

impl Node {
    /// A node of which that much is known.
    pub(super) fn new(record: Record, covered: bool, known: usize, values: [Vec3; ORDERS]) -> Node {
        Node { record, covered, links: None, known, wanted: known, values }
    }

    /// Nothing arrives where no surface was found; all is known of that.
    fn placed(found: Option<(Record, bool)>) -> Node {
        let (record, is_open) = found.unwrap_or_default();
        Node::new(record, !is_open, if found.is_some() { 0 } else { ORDERS }, [Vec3::ZERO; ORDERS])
    }

    fn is_somewhere(&self) -> bool {
        self.record.point.normal != Vec3::ZERO
    }

    fn is_covered(&self) -> bool {
        self.is_somewhere() && self.covered
    }

    /// Whether it may answer what is asked in a cell that is smaller by so many levels than the one that was asked at first.
    fn may_answer(&self, finer: i32) -> bool {
        self.is_somewhere() && (!self.covered || finer == BOUNCE_FINER)
    }
}

/// All nodes so far.
#[derive(Default)]
pub(super) struct Bounce {
    pub(super) numbers: HashMap<Name, u32, BuildHasherDefault<CellHasher>>,
    pub(super) nodes: Vec<Node>,
    /// Links of all of them.
    links: usize,
}

impl Bounce {
    /// Nodes that were known before, none of which is linked.
    pub(super) fn with_nodes(numbers: impl Iterator<Item = (Name, u32)>, nodes: Vec<Node>) -> Bounce {
        Bounce { numbers: numbers.collect(), nodes, links: 0 }
    }

    /// Bytes in memory.
    pub(super) fn memory(&self) -> usize {
        let links = self.links * size_of::<(u32, Vec3)>();
        self.numbers.capacity() * size_of::<(Name, u32)>() + self.nodes.capacity() * size_of::<Node>() + links
    }

    /// Adds to what rays see what is reflected of light that lights do not give.
    pub(super) fn complete(&mut self, scene: &Scene, seen: &[Seen], hemisphere: HemisphereRays) -> Vec<Vec3> {
        let numbers = self.resolve(scene, seen, |_| true);
        self.ensure(scene, &numbers);
        let mut radiance = vec![Vec3::ZERO; seen.len()];
        let hemispheres = seen.par_chunks_exact(hemisphere.len()).zip(numbers.par_chunks_exact(hemisphere.len()));
        radiance.par_chunks_exact_mut(hemisphere.len()).zip(hemispheres).for_each(|(radiance, (seen, numbers))| {
            let value = |number: u32| self.nodes[number as usize].values[ORDERS - 1];
            let other = mean(numbers.iter().copied().flatten().map(value));
            for ((radiance, seen), number) in radiance.iter_mut().zip(seen).zip(numbers) {
                *radiance = seen.radiance;
                if seen.spot.is_some() {
                    *radiance += seen.kd * number.map_or(other, value);
                }
            }
        });
        radiance
    }

    /// The numbers of the nodes that the spots of rays see; they are added where they are new. `None` without a spot, and where something is in the
    /// way to all that are asked. Only rays that `insist` ask on where something is in the way: from reflection to reflection that would take too long
    /// among leaves.
    fn resolve(&mut self, scene: &Scene, rays: &[Seen], insist: impl Fn(u32) -> bool + Sync) -> Vec<Option<u32>> {
        let mut numbers = vec![None; rays.len()];
        let spots = rays.par_iter().enumerate();
        let mut asking: Vec<(u32, Spot)> = spots.filter_map(|(ray, seen)| Some((ray as u32, seen.spot?))).collect();
        while !asking.is_empty() {
            self.admit(scene, &asking);
            let found: Vec<Option<u32>> =
                asking.par_chunks(batch(asking.len())).flat_map_iter(|asking| self.seen_by(scene, asking)).collect();
            for (&(ray, _), number) in asking.iter().zip(&found) {
                numbers[ray as usize] = *number;
            }
            let is_covered = |spot: &Spot| self.nodes[self.numbers[&spot.name()] as usize].is_covered();
            let asks_on = |((ray, spot), number): &((u32, Spot), Option<u32>)| {
                number.is_none() && (insist(*ray) || is_covered(spot))
            };
            let again = asking.into_par_iter().zip(found).filter(asks_on);
            asking = again.filter_map(|((ray, spot), _)| Some((ray, spot.finer()?))).collect();
        }
        numbers
    }

    /// The numbers of the nodes that spots ask, which are there; `None` where something is in the way, or no surface was found.
    fn seen_by(&self, scene: &Scene, asking: &[(u32, Spot)]) -> Vec<Option<u32>> {
        let mut numbers: Vec<Option<u32>> = asking.iter().map(|(_, spot)| Some(self.numbers[&spot.name()])).collect();
        let (mut segments, mut owners) = (Vec::new(), Vec::new());
        for (index, ((_, spot), number)) in asking.iter().zip(&mut numbers).enumerate() {
            let node = number.map(|number| &self.nodes[number as usize]).filter(|node| node.may_answer(spot.finer));
            match node {
                Some(node) => {
                    segments.push(spot.place.segment(&node.record.point, node.covered));
                    owners.push(index);
                }
                None => *number = None,
            }
        }
        let mut hidden = vec![false; segments.len()];
        scene.scene.geometry.accelerator.occluded(&segments, &mut hidden);
        owners.into_iter().zip(hidden).filter(|(_, hidden)| *hidden).for_each(|(index, _)| numbers[index] = None);
        numbers
    }

    /// Adds the nodes that spots ask where they are new.
    fn admit(&mut self, scene: &Scene, asking: &[(u32, Spot)]) {
        let named = asking.par_iter().map(|(_, spot)| (spot.name(), spot));
        let mut new: Vec<(Name, &Spot)> = named.filter(|(name, _)| !self.numbers.contains_key(name)).collect();
        new.par_sort_unstable_by_key(|(name, _)| *name);
        new.dedup_by_key(|(name, _)| *name);
        let find = |new: &[(Name, &Spot)]| {
            let mut triangles = Vec::new();
            let record = |(_, spot): &(Name, &Spot)| {
                let (record, is_open) = nearest_of_kind(scene.scene, &spot.asked(), spot.kind, &mut triangles)?;
                Some((Record { level: record.level + spot.finer, ..record }, is_open))
            };
            new.iter().map(record).collect::<Vec<_>>()
        };
        let records: Vec<Option<(Record, bool)>> = new.par_chunks(64).flat_map_iter(find).collect();
        for ((name, _), record) in new.iter().zip(records) {
            self.numbers.insert(*name, self.nodes.len() as u32);
            self.nodes.push(Node::placed(record));
        }
    }

    /// All that arrives at nodes is known afterwards.
    fn ensure(&mut self, scene: &Scene, asked: &[Option<u32>]) {
        // 1. From reflection to reflection back, the nodes of which more is asked than is known. Each is listed with the highest number first.
        let (mut lacking, mut ends) = (Vec::new(), [0; ORDERS]);
        let mut frontier = self.lacking(asked.par_iter().copied().flatten(), ORDERS);
        for order in (1..=ORDERS).rev() {
            frontier.iter().for_each(|&node| self.nodes[node as usize].wanted = order);
            self.link(scene, &frontier);
            let seen = frontier.par_iter().flat_map_iter(|&node| self.links_of(node).seen.iter());
            let next = self.lacking(seen.map(|(number, _)| *number), order - 1);
            lacking.append(&mut frontier);
            ends[order - 1] = lacking.len();
            frontier = next;
        }
        // 2. The sums.
        for (before, &end) in ends.iter().enumerate().skip(1) {
            let is_lacking = |&&node: &&u32| self.nodes[node as usize].known == before;
            let sums: Vec<(u32, Vec3)> =
                lacking[..end].par_iter().filter(is_lacking).map(|&node| (node, self.sum(node, before))).collect();
            for (node, sum) in sums {
                let node = &mut self.nodes[node as usize];
                node.values[before] = sum;
                node.known = before + 1;
            }
        }
    }

    /// Those of the nodes of which less is known, or asked for, than the light after up to `order` reflections.
    fn lacking(&self, nodes: impl ParallelIterator<Item = u32>, order: usize) -> Vec<u32> {
        let mut lacking: Vec<u32> = nodes.filter(|&node| self.nodes[node as usize].wanted < order).collect();
        lacking.par_sort_unstable();
        lacking.dedup();
        lacking
    }

    fn links_of(&self, node: u32) -> &Links {
        self.nodes[node as usize].links.as_ref().expect("it was linked")
    }

    /// Casts the rays of nodes and finds the nodes that they see, unless it was done.
    fn link(&mut self, scene: &Scene, nodes: &[u32]) {
        let new: Vec<u32> = nodes.iter().copied().filter(|&node| self.nodes[node as usize].links.is_none()).collect();
        for new in new.chunks(scene.records_at_once(NODE_RAYS)) {
            let of = |&node: &u32| (&self.nodes[node as usize].record, f32::INFINITY);
            let cast = scene.cast(new.iter().map(of), NODE_RAYS, None);
            let seen = scene.seen(&cast);
            let hemispheres =
                seen.par_chunks_exact(NODE_RAYS.len()).zip(cast.weights.par_chunks_exact(NODE_RAYS.len()));
            let brightness: Vec<f32> = hemispheres.map(|(seen, weights)| brightness(seen, weights)).collect();
            // Where others see little, what is lit matters: most of what is reflected comes from there.
            let is_bright =
                |ray: u32| luminance(seen[ray as usize].radiance) > brightness[ray as usize / NODE_RAYS.len()];
            let numbers = self.resolve(scene, &seen, is_bright);
            let hemispheres = seen.par_chunks_exact(NODE_RAYS.len()).zip(numbers.par_chunks_exact(NODE_RAYS.len()));
            let links = hemispheres.zip(cast.weights.par_chunks_exact(NODE_RAYS.len()));
            let links: Vec<(Vec3, Links)> =
                links.map(|((seen, numbers), weights)| linked(seen, numbers, weights)).collect();
            for (&node, (first, links)) in new.iter().zip(links) {
                self.links += links.seen.len();
                let node = &mut self.nodes[node as usize];
                (node.values[0], node.links, node.known) = (first, Some(links), node.known.max(1));
            }
        }
    }

    /// What arrives at a node after one reflection more than `before`.
    fn sum(&self, node: u32, before: usize) -> Vec3 {
        let Links { seen, hidden } = self.links_of(node);
        let first = self.nodes[node as usize].values[0];
        let value = |number: u32| self.nodes[number as usize].values[before - 1];
        let lit: Vec3 = seen.iter().map(|&(number, weight)| weight * value(number)).sum();
        first + lit + *hidden * mean(seen.iter().map(|&(number, _)| value(number)))
    }
}

/// What arrives at a node with the last reflection alone, and what its rays see.
fn linked(seen: &[Seen], numbers: &[Option<u32>], weights: &[f32]) -> (Vec3, Links) {
    let (mut first, mut hidden, mut links) = (Vec3::ZERO, Vec3::ZERO, Vec::with_capacity(seen.len()));
    for ((seen, number), &weight) in seen.iter().zip(numbers).zip(weights) {
        first += weight * seen.radiance;
        match (seen.spot, *number) {
            (Some(_), Some(number)) => links.push((number, weight * seen.kd)),
            (Some(_), None) => hidden += weight * seen.kd,
            (None, _) => {}
        }
    }
    (first, Links { seen: links.into(), hidden })
}

/// The mean; zero of nothing.
fn mean(values: impl Iterator<Item = Vec3>) -> Vec3 {
    let (sum, count) = values.fold((Vec3::ZERO, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    if count > 0.0 { sum / count } else { Vec3::ZERO }
}
