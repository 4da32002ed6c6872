//! What coarse sites gather: light from everywhere, by direction.

use glam::Vec3;
use lightmesh_layout::constants::{EVEN, NEAR_CELLS};
use rayon::prelude::*;

use super::bounce::Bounce;
use super::cells::{Cells, Site, size_of_level};
use super::light::{Bins, Light};
use super::rays::{Cast, Fan};
use super::scene::Scene;

/// What a coarse site gathers.
pub(super) struct Far {
    pub(super) light: Light,
    /// The radiance that all rays see.
    pub(super) all: Bins,
    /// That of rays that go far.
    pub(super) beyond: Bins,
    pub(super) has_near: bool,
}

impl Far {
    const EMPTY: Far = Far { light: Light::NONE, all: Bins::EMPTY, beyond: Bins::EMPTY, has_near: false };

    /// Adds what other rays see; the numbers of rays of both are given.
    fn join(&mut self, other: &Far, [count, others]: [f32; 2]) {
        let share = others / (count + others);
        let mut light = Light::default();
        light.add(1.0 - share, &self.light, Vec3::ZERO);
        light.add(share, &other.light, Vec3::ZERO);
        self.light = light;
        self.all.join(&other.all);
        self.beyond.join(&other.beyond);
        self.has_near |= other.has_near;
    }
}

/// How far near light reaches from a site.
pub(super) fn near(site: &Site) -> f32 {
    NEAR_CELLS * size_of_level(site.level)
}

/// Computes what coarse sites gather, unless it is known.
pub(super) fn ensure(
    scene: &Scene,
    cells: &Cells,
    bounce: &mut Bounce,
    known: &mut Vec<Option<Box<Far>>>,
    wanted: &[u32],
    fans: [Fan; 2],
) {
    known.resize_with(cells.sites.len(), || None);
    let new: Vec<u32> = wanted.iter().copied().filter(|&site| known[site as usize].is_none()).collect();
    for new in new.chunks(scene.fans_at_once(fans[0])) {
        let sites: Vec<Site> = new.iter().map(|&site| cells.sites[site as usize]).collect();
        for (&number, seen) in new.iter().zip(gathered(scene, bounce, &sites, fans)) {
            known[number as usize] = Some(seen.far);
        }
    }
}

/// What sites receive by their own rays alone.
pub(super) fn plain(scene: &Scene, bounce: &mut Bounce, sites: &[Site], fans: [Fan; 2]) -> Vec<Light> {
    let each = |sites: &[Site]| -> Vec<Light> {
        gathered(scene, bounce, sites, fans).into_iter().map(|seen| seen.far.light).collect()
    };
    sites.chunks(scene.fans_at_once(fans[0])).flat_map(each).collect()
}

/// What some sites gather.
fn gathered(scene: &Scene, bounce: &mut Bounce, sites: &[Site], fans: [Fan; 2]) -> Vec<SeenByFan> {
    // 1. A few rays from each.
    let mut first = seen_by_fans(scene, bounce, sites, fans[0]);
    // 2. More where these see different things.
    let mut uneven: Vec<(&Site, &mut Far)> = sites
        .iter()
        .zip(&mut first)
        .filter(|(_, seen)| seen.is_uneven())
        .map(|(site, seen)| (site, &mut *seen.far))
        .collect();
    for uneven in uneven.chunks_mut(scene.fans_at_once(fans[1])) {
        let sites: Vec<Site> = uneven.iter().map(|(site, _)| **site).collect();
        let more = seen_by_fans(scene, bounce, &sites, fans[1]);
        let both = uneven.par_iter_mut().zip(more);
        both.for_each(|((_, far), more)| far.join(&more.far, fans.map(|fan| fan.len() as f32)));
    }
    first
}

/// What the rays of a fan see.
struct SeenByFan {
    far: Box<Far>,
    /// The mean luminance, and the mean of its square.
    luminance: [f32; 2],
}

impl SeenByFan {
    fn is_uneven(&self) -> bool {
        let [mean, square] = self.luminance;
        square > (1.0 + EVEN * EVEN) * mean * mean
    }
}

fn seen_by_fans(scene: &Scene, bounce: &mut Bounce, sites: &[Site], fan: Fan) -> Vec<SeenByFan> {
    let cast = scene.cast(sites.iter().map(|site| (site, f32::INFINITY)), fan);
    let radiance = bounce.complete(scene, &scene.seen(&cast), fan);
    let Cast { list, hits, weights, .. } = &cast;
    let gather = |(index, site): (usize, &Site)| {
        let near = near(site);
        let mut far = Box::new(Far::EMPTY);
        let mut luminance = [0.0; 2];
        for ray in index * fan.len()..(index + 1) * fan.len() {
            let (direction, radiance, weight) = (list.rays[ray].direction, radiance[ray], weights[ray]);
            far.light.take(site.point.normal, direction, weight * radiance);
            far.light.most = far.light.most.max(radiance);
            far.all.take(direction, radiance);
            if hits[ray].t < near {
                far.has_near = true;
            } else {
                far.beyond.take(direction, radiance);
            }
            let bright = crate::shading::luminance(radiance);
            luminance[0] += weight * bright;
            luminance[1] += weight * bright * bright;
        }
        SeenByFan { far, luminance }
    };
    sites.par_iter().enumerate().map(gather).collect()
}
