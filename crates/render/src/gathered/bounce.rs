//! Light that was reflected several times: what reaches the points that gather rays hit.
//!
//! A coarse cell and the kind of surface that a ray hits in it name one site, which gathers by a few rays of its own. What these hit is asked
//! in the same way. So light after any number of reflections is a sum over links:
//!
//! ```text
//! A_1(k) = Σ_j ω_j S_j        A_n(k) = Σ_j ω_j (S_j + k_d,j A_(n−1)(j))
//! ```
//!
//! over the rays j of site k. S_j is what is seen without other reflections. If something is between a hit and the site of its cell, such as a wall
//! that stands on a floor, the mean of what the other hits receive stands for it: so nothing leaks.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use glam::Vec3;
use lightmesh_layout::constants::BOUNCE_SIDE;
use rayon::prelude::*;

use super::cells::{Asked, CellHasher, Site, nearest_of_kind};
use super::rays::{Fan, RAYS_AT_ONCE, Seen, Spot};
use super::scene::Scene;

/// How often light is reflected before it reaches what a gather ray hits, at most, with the first time by a light's.
pub(super) const ORDERS: usize = 2;
/// The rays of a site.
pub(super) const FAN: Fan = Fan::new(BOUNCE_SIDE);

/// The name of a site: its cell and its kind of surface.
type Name = u64;

impl Spot {
    fn asked(&self) -> Asked {
        Asked::new(self.place.level, self.place.cell())
    }

    fn name(&self) -> Name {
        self.asked().key << 4 | u64::from(self.kind)
    }
}

/// What a site's rays hit.
#[derive(Default)]
struct Links {
    /// The sites there, with the weights of what they receive.
    seen: Vec<(u32, Vec3)>,
    /// The weight of what hits do not see of their sites.
    hidden: Vec3,
}

/// A site, and what its rays see.
struct Node {
    site: Site,
    /// What arrives with the last reflection alone; `None` if its rays were not cast.
    first: Option<Vec3>,
    /// The distance of what is nearest in front of it.
    nearest: f32,
    /// What its rays hit, with their weights.
    hits: Vec<(Spot, Vec3)>,
    /// The sites there, once they are needed.
    links: Links,
    /// How many of the values are known: what arrives after up to one, two, … reflections.
    known: usize,
    values: [Vec3; ORDERS],
}

/// All sites so far.
#[derive(Default)]
pub(super) struct Bounce {
    numbers: HashMap<Name, u32, BuildHasherDefault<CellHasher>>,
    nodes: Vec<Node>,
    hits: usize,
}

impl Bounce {
    /// Bytes in memory.
    pub(super) fn memory(&self) -> usize {
        let of_hits = self.hits * (size_of::<(Spot, Vec3)>() + size_of::<(u32, Vec3)>());
        self.numbers.capacity() * size_of::<(Name, u32)>() + self.nodes.capacity() * size_of::<Node>() + of_hits
    }

    /// Adds to what rays see what is reflected of light that lights do not give. `site` tells from which site a ray comes; those of a site follow
    /// each other.
    pub(super) fn complete(&mut self, scene: &Scene, seen: &[Seen], site: impl Fn(usize) -> usize) -> Vec<Vec3> {
        let rays: Vec<usize> = (0..seen.len()).filter(|&ray| seen[ray].spot.is_some()).collect();
        let spots: Vec<Spot> = seen.par_iter().filter_map(|seen| seen.spot).collect();
        let numbers = self.resolve(scene, &spots, ORDERS);
        let mut radiance: Vec<Vec3> = seen.par_iter().map(|seen| seen.radiance).collect();
        let mut first = 0;
        for rays in rays.chunk_by(|&a, &b| site(a) == site(b)) {
            let numbers = &numbers[first..first + rays.len()];
            first += rays.len();
            let value = |number: u32| self.nodes[number as usize].values[ORDERS - 1];
            let other = mean(numbers.iter().copied().flatten().map(value));
            for (&ray, number) in rays.iter().zip(numbers) {
                radiance[ray] += seen[ray].kd * number.map_or(other, value);
            }
        }
        radiance
    }

    /// The numbers of the sites that spots see; what arrives there after up to `order` reflections is known. `None` where something is in the
    /// way.
    fn resolve(&mut self, scene: &Scene, spots: &[Spot], order: usize) -> Vec<Option<u32>> {
        self.ensure(scene, spots.par_iter(), order);
        let batch = |spots: &[Spot]| {
            let mut numbers: Vec<Option<u32>> = spots.iter().map(|spot| Some(self.numbers[&spot.name()])).collect();
            self.hide(scene, spots, &mut numbers);
            numbers
        };
        spots.par_chunks(4096).flat_map_iter(batch).collect()
    }

    /// Takes away the sites that spots do not see.
    fn hide(&self, scene: &Scene, spots: &[Spot], numbers: &mut [Option<u32>]) {
        let (mut segments, mut owners) = (Vec::new(), Vec::new());
        for (index, (Spot { place, .. }, number)) in spots.iter().zip(&*numbers).enumerate() {
            let Some(number) = number else { continue };
            let node = &self.nodes[*number as usize];
            if place.may_be_hidden(&node.site.point, node.nearest) {
                segments.push(place.segment(&node.site.point));
                owners.push(index);
            }
        }
        let mut hidden = vec![false; segments.len()];
        scene.scene.geometry.accelerator.occluded(&segments, &mut hidden);
        owners.into_iter().zip(hidden).filter(|(_, hidden)| *hidden).for_each(|(index, _)| numbers[index] = None);
    }

    /// What arrives at sites after up to `order` reflections is known afterwards.
    fn ensure<'s>(&mut self, scene: &Scene, spots: impl ParallelIterator<Item = &'s Spot>, order: usize) {
        // 1. The sites of which it is not.
        let is_lacking =
            |name: &Name| self.numbers.get(name).is_none_or(|&number| self.nodes[number as usize].known < order);
        let named = spots.map(|spot| (spot.name(), spot));
        let mut new: Vec<(Name, &Spot)> = named.filter(|(name, _)| is_lacking(name)).collect();
        if new.is_empty() {
            return;
        }
        new.par_sort_unstable_by_key(|(name, _)| *name);
        new.dedup_by_key(|(name, _)| *name);
        self.admit(scene, &new);
        let sites: Vec<u32> = new.iter().map(|(name, _)| self.numbers[name]).collect();
        self.cast(scene, &sites);
        // 2. What arrives at those that their rays hit, after one reflection less.
        if order > 1 {
            self.link(scene, &sites, order - 1);
        }
        // 3. The sums.
        for before in 0..order {
            let lacking = sites.par_iter().filter(|&&site| self.nodes[site as usize].known == before);
            let sums: Vec<(u32, Vec3)> = lacking.map(|&site| (site, self.sum(site, before))).collect();
            for (site, sum) in sums {
                let node = &mut self.nodes[site as usize];
                node.values[before] = sum;
                node.known = before + 1;
            }
        }
    }

    /// Finds the sites that the rays of sites hit, of which as many reflections are known afterwards.
    fn link(&mut self, scene: &Scene, sites: &[u32], order: usize) {
        for sites in sites.chunks(RAYS_AT_ONCE / FAN.len()) {
            let hits = sites.iter().flat_map(|&site| &self.nodes[site as usize].hits);
            let spots: Vec<Spot> = hits.map(|&(spot, _)| spot).collect();
            let mut numbers = self.resolve(scene, &spots, order).into_iter();
            for &site in sites {
                let node = &mut self.nodes[site as usize];
                let mut links = Links { seen: Vec::with_capacity(node.hits.len()), hidden: Vec3::ZERO };
                for (&(_, weight), number) in node.hits.iter().zip(&mut numbers) {
                    match number {
                        Some(number) => links.seen.push((number, weight)),
                        None => links.hidden += weight,
                    }
                }
                node.links = links;
            }
        }
    }

    /// What arrives at a site after one reflection more than `before`.
    fn sum(&self, site: u32, before: usize) -> Vec3 {
        let node = &self.nodes[site as usize];
        let first = node.first.unwrap_or_default();
        if before == 0 {
            return first;
        }
        let Links { seen, hidden } = &node.links;
        let value = |number: u32| self.nodes[number as usize].values[before - 1];
        let lit: Vec3 = seen.iter().map(|&(number, weight)| weight * value(number)).sum();
        first + lit + *hidden * mean(seen.iter().map(|&(number, _)| value(number)))
    }

    /// Adds sites where they are new. Their names ascend.
    fn admit(&mut self, scene: &Scene, asked: &[(Name, &Spot)]) {
        let is_new = |(name, _): &&(Name, &Spot)| !self.numbers.contains_key(name);
        let new: Vec<(Name, &Spot)> = asked.iter().filter(is_new).copied().collect();
        let find = |new: &[(Name, &Spot)]| {
            let mut triangles = Vec::new();
            let site =
                |(_, spot): &(Name, &Spot)| nearest_of_kind(scene.scene, &spot.asked(), spot.kind, &mut triangles);
            new.iter().map(site).collect::<Vec<_>>()
        };
        let sites: Vec<Option<Site>> = new.par_chunks(64).flat_map_iter(find).collect();
        for ((name, _), site) in new.iter().zip(sites) {
            self.numbers.insert(*name, self.nodes.len() as u32);
            // Nothing arrives where rounding hides the surface that was hit.
            let first = if site.is_some() { None } else { Some(Vec3::ZERO) };
            self.nodes.push(Node {
                site: site.unwrap_or_default(),
                first,
                nearest: f32::INFINITY,
                hits: Vec::new(),
                links: Links::default(),
                known: 0,
                values: [Vec3::ZERO; ORDERS],
            });
        }
    }

    /// Casts the rays of sites, if they have not been cast.
    fn cast(&mut self, scene: &Scene, sites: &[u32]) {
        let sites: Vec<u32> = sites.iter().copied().filter(|&site| self.nodes[site as usize].first.is_none()).collect();
        for sites in sites.chunks(RAYS_AT_ONCE / FAN.len()) {
            let of = |&site: &u32| (&self.nodes[site as usize].site, f32::INFINITY);
            let cast = scene.cast(sites.iter().map(of), FAN);
            let seen = scene.seen(&cast);
            let found: Vec<(Vec3, Vec<(Spot, Vec3)>)> = seen
                .par_chunks_exact(FAN.len())
                .zip(cast.weights.par_chunks_exact(FAN.len()))
                .map(|(seen, weights)| {
                    let rays = || seen.iter().zip(weights);
                    let first: Vec3 = rays().map(|(seen, &weight)| weight * seen.radiance).sum();
                    let hits = rays().filter_map(|(seen, &weight)| Some((seen.spot?, weight * seen.kd)));
                    (first, hits.collect())
                })
                .collect();
            for ((&site, (first, hits)), nearest) in sites.iter().zip(found).zip(cast.nearest()) {
                self.hits += hits.capacity();
                let node = &mut self.nodes[site as usize];
                (node.first, node.nearest, node.hits) = (Some(first), nearest, hits);
            }
        }
    }
}

/// The mean; zero of nothing.
fn mean(values: impl Iterator<Item = Vec3>) -> Vec3 {
    let (sum, count) = values.fold((Vec3::ZERO, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    if count > 0.0 { sum / count } else { Vec3::ZERO }
}
