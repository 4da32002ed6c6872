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
use super::rays::{Fan, Seen, Spot};
use super::scene::Scene;
use crate::stages::primary_rays::cpu::batch;

/// How often light is reflected before it reaches what a gather ray hits, at most, with the first time by a light's.
pub(crate) const ORDERS: usize = 2;
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
pub(super) struct Links {
    /// The sites there, with the weights of what they receive.
    seen: Vec<(u32, Vec3)>,
    /// The weight of what hits do not see of their sites.
    hidden: Vec3,
}

/// A site, and what its rays see.
pub(super) struct Node {
    pub(super) site: Site,
    /// What arrives with the last reflection alone; `None` if its rays were not cast.
    pub(super) first: Option<Vec3>,
    /// The distance of what is nearest in front of it.
    pub(super) nearest: f32,
    /// What its rays hit, with their weights.
    pub(super) hits: Vec<(Spot, Vec3)>,
    /// The sites there, once they are needed.
    pub(super) links: Links,
    /// How many of the values are known: what arrives after up to one, two, … reflections.
    pub(super) known: usize,
    pub(super) values: [Vec3; ORDERS],
}

/// All sites so far.
#[derive(Default)]
pub(super) struct Bounce {
    pub(super) numbers: HashMap<Name, u32, BuildHasherDefault<CellHasher>>,
    pub(super) nodes: Vec<Node>,
    pub(super) hits: usize,
}

impl Bounce {
    /// Bytes in memory.
    pub(super) fn memory(&self) -> usize {
        let of_hits = self.hits * (size_of::<(Spot, Vec3)>() + size_of::<(u32, Vec3)>());
        self.numbers.capacity() * size_of::<(Name, u32)>() + self.nodes.capacity() * size_of::<Node>() + of_hits
    }

    /// Adds to what the rays of fans see what is reflected of light that lights do not give.
    pub(super) fn complete(&mut self, scene: &Scene, seen: &[Seen], fan: Fan) -> Vec<Vec3> {
        let numbers = self.resolve(scene, seen, |seen| seen.spot.as_ref(), ORDERS);
        let mut radiance = vec![Vec3::ZERO; seen.len()];
        let fans = seen.par_chunks_exact(fan.len()).zip(numbers.par_chunks_exact(fan.len()));
        radiance.par_chunks_exact_mut(fan.len()).zip(fans).for_each(|(radiance, (seen, numbers))| {
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

    /// The numbers of the sites that the spots of rays see; what arrives there after up to `order` reflections is known. `None` without a spot,
    /// and where something is in the way.
    fn resolve<T: Sync>(
        &mut self,
        scene: &Scene,
        rays: &[T],
        spot: impl Fn(&T) -> Option<&Spot> + Sync,
        order: usize,
    ) -> Vec<Option<u32>> {
        self.ensure(scene, rays.par_iter().filter_map(&spot), order);
        let mut numbers = vec![None; rays.len()];
        let batch = batch(rays.len());
        rays.par_chunks(batch).zip(numbers.par_chunks_mut(batch)).for_each(|(rays, numbers)| {
            let (mut segments, mut owners) = (Vec::new(), Vec::new());
            for (index, (ray, number)) in rays.iter().zip(&mut *numbers).enumerate() {
                let Some(spot) = spot(ray) else { continue };
                let found = self.numbers[&spot.name()];
                let node = &self.nodes[found as usize];
                *number = Some(found);
                if spot.place.may_be_hidden(&node.site.point, node.nearest) {
                    segments.push(spot.place.segment(&node.site.point));
                    owners.push(index);
                }
            }
            let mut hidden = vec![false; segments.len()];
            scene.scene.geometry.accelerator.occluded(&segments, &mut hidden);
            owners.into_iter().zip(hidden).filter(|(_, hidden)| *hidden).for_each(|(index, _)| numbers[index] = None);
        });
        numbers
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
        for sites in sites.chunks(scene.fans_at_once(FAN)) {
            let of = |site: u32| &self.nodes[site as usize].hits;
            let lengths: Vec<usize> = sites.iter().map(|&site| of(site).len()).collect();
            let hits: Vec<(Spot, Vec3)> = sites.par_iter().flat_map_iter(|&site| of(site).iter().copied()).collect();
            let numbers = self.resolve(scene, &hits, |(spot, _)| Some(spot), order);
            let link = |(hits, numbers): (&[(Spot, Vec3)], &[Option<u32>])| {
                let mut links = Links { seen: Vec::with_capacity(hits.len()), hidden: Vec3::ZERO };
                for (&(_, weight), number) in hits.iter().zip(numbers) {
                    match *number {
                        Some(number) => links.seen.push((number, weight)),
                        None => links.hidden += weight,
                    }
                }
                links
            };
            let links: Vec<Links> =
                parts(&hits, &lengths).into_par_iter().zip(parts(&numbers, &lengths)).map(link).collect();
            sites.iter().zip(links).for_each(|(&site, links)| self.nodes[site as usize].links = links);
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
        for sites in sites.chunks(scene.fans_at_once(FAN)) {
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

/// Consecutive parts of some lengths.
fn parts<'a, T>(mut all: &'a [T], lengths: &[usize]) -> Vec<&'a [T]> {
    let part = |&length: &usize| all.split_off(..length).expect("there are as many as all parts have");
    lengths.iter().map(part).collect()
}

/// The mean; zero of nothing.
fn mean(values: impl Iterator<Item = Vec3>) -> Vec3 {
    let (sum, count) = values.fold((Vec3::ZERO, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    if count > 0.0 { sum / count } else { Vec3::ZERO }
}
