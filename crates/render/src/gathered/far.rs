//! What coarse sites gather: light from everywhere, by direction.

use glam::Vec3;
use lightmesh_layout::constants::{EVEN, FIRST_COUNT, NEAR_CELLS};
use rayon::prelude::*;

use super::bounce::Bounce;
use super::cells::{Cells, Site, size_of_level};
use super::fan::Fan;
use super::guide::Guides;
use super::light::{Bins, Light};
use super::rays::Cast;
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

    /// Adds what guided rays see; the numbers of rays of both are given.
    fn join(&mut self, other: &Far, [count, others]: [f32; 2]) {
        let share = others / (FIRST_COUNT * count + others);
        let mut light = Light::default();
        light.add(1.0 - share, &self.light, Vec3::ZERO);
        light.add(share, &other.light, Vec3::ZERO);
        self.light = light;
        self.all.join(FIRST_COUNT, &other.all);
        self.beyond.join(FIRST_COUNT, &other.beyond);
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
    let (mut first, bright) = seen_by_fans(scene, bounce, sites, fans[0], None);
    // 2. More where these see different things.
    let uneven = sites.iter().zip(&mut first).zip(bright.chunks_exact(fans[0].len()));
    let mut uneven: Vec<((&Site, &mut SeenByFan), &[f32])> = uneven.filter(|((_, seen), _)| seen.is_uneven()).collect();
    for uneven in uneven.chunks_mut(scene.fans_at_once(fans[1])) {
        let sites: Vec<Site> = uneven.iter().map(|((site, _), _)| **site).collect();
        let mut guides = Guides::new(fans[0]);
        uneven.iter().for_each(|(_, bright)| guides.add(fans[0], fans[1], bright));
        let (more, _) = seen_by_fans(scene, bounce, &sites, fans[1], Some(&guides));
        let both = uneven.par_iter_mut().zip(more);
        both.for_each(|(((_, seen), _), more)| seen.far.join(&more.far, fans.map(|fan| fan.len() as f32)));
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

/// What fans see, and the luminance times the weight of each ray.
fn seen_by_fans(
    scene: &Scene,
    bounce: &mut Bounce,
    sites: &[Site],
    fan: Fan,
    guides: Option<&Guides>,
) -> (Vec<SeenByFan>, Vec<f32>) {
    let cast = scene.cast(sites.iter().map(|site| (site, f32::INFINITY)), fan, guides);
    let radiance = bounce.complete(scene, &scene.seen(&cast), fan);
    let Cast { list, hits, weights, areas, .. } = &cast;
    let mut bright = vec![0.0; radiance.len()];
    let gather = |((index, site), bright): ((usize, &Site), &mut [f32])| {
        let near = near(site);
        let mut far = Box::new(Far::EMPTY);
        let mut luminance = [0.0; 2];
        for (ray, bright) in (index * fan.len()..).zip(bright) {
            let (direction, radiance, weight) = (list.rays[ray].direction, radiance[ray], weights[ray]);
            far.light.take(site.point.normal, direction, weight * radiance);
            far.light.most = far.light.most.max(radiance);
            far.all.take(direction, radiance, areas[ray]);
            if hits[ray].t < near {
                far.has_near = true;
            } else {
                far.beyond.take(direction, radiance, areas[ray]);
            }
            let seen = crate::shading::luminance(radiance);
            luminance[0] += weight * seen;
            luminance[1] += weight * seen * seen;
            *bright = weight * seen;
        }
        SeenByFan { far, luminance }
    };
    let fans = sites.par_iter().enumerate().zip(bright.par_chunks_exact_mut(fan.len()));
    let seen = fans.map(gather).collect();
    (seen, bright)
}
