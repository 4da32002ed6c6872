//! What fine sites receive: from afar what coarse sites gather, and from nearby what their own rays hit.
//!
//! ```text
//! A = far + Σ_j ω_j (L_j − all_j)        L_j: what ray j hits nearby, or else what coarse sites see beyond
//! ```
//!
//! The mean of what coarse sites see along the ray, all_j, is a control variate: its integral is the light `far` that they receive. So where
//! nothing is near, there is no noise but theirs.

use glam::Vec3;
use lightmesh_layout::constants::{CLOSER, COARSER, CROWDED, CROWDED_AGAIN, HOPELESS, NEAR_REACH};
use lightmesh_trace::accel::Hit;
use rayon::prelude::*;

use super::bounce::Bounce;
use super::cells::{Cells, Site, size_of_level};
use super::directions::bin;
use super::fan::Fans;
use super::far::{self, Far};
use super::light::Light;
use super::lookup::{Link, Links, Place};
use super::rays::Cast;
use super::scene::Scene;

/// What coarse sites know.
pub(super) struct Coarse<'a> {
    pub(super) cells: &'a mut Cells,
    pub(super) known: &'a mut Vec<Option<Box<Far>>>,
    pub(super) bounce: &'a mut Bounce,
}

/// Computes what fine sites receive, unless it is known.
pub(super) fn ensure(
    scene: &Scene,
    cells: &Cells,
    known: &mut Vec<Option<Light>>,
    coarse: &mut Coarse,
    wanted: &[u32],
    fans: &Fans,
) {
    known.resize_with(cells.sites.len(), || None);
    let new: Vec<u32> = wanted.iter().copied().filter(|&site| known[site as usize].is_none()).collect();
    for new in new.chunks(scene.fans_at_once(fans.near)) {
        // As coarse as what they ask.
        let coarser = |site: &Site| Site { level: site.level + COARSER, ..*site };
        let sites: Vec<Site> = new.iter().map(|&site| coarser(&cells.sites[site as usize])).collect();
        for (&number, fine) in new.iter().zip(received(scene, coarse, &sites, fans)) {
            known[number as usize] = Some(fine);
        }
    }
}

/// What sites receive that belong to no cell, as coarse as what they ask.
pub(super) fn plain(scene: &Scene, coarse: &mut Coarse, sites: &[Site], fans: &Fans) -> Vec<Light> {
    let each = |sites: &[Site]| received(scene, coarse, sites, fans);
    sites.chunks(scene.fans_at_once(fans.near)).flat_map(each).collect()
}

/// How far the near rays of a site reach.
fn reach(site: &Site) -> f32 {
    NEAR_REACH * far::near(site)
}

/// Sites among near things ask smaller coarse cells: light changes fast from place to place there. What is near is measured as Ward measures how fast
/// irradiance changes, by the mean inverse distance of what rays hit (Ward, Rubinstein, Clear: *A Ray Tracing Solution for Diffuse Interreflection*,
/// 1988, the split sphere).
fn come_closer(cast: &mut Cast, sites: &mut [Site]) {
    cast.fans().zip(sites.par_iter_mut()).for_each(|((hits, weights), site)| {
        let mut most = CROWDED;
        for _ in 0..CLOSER {
            let near = hits.iter().zip(weights).filter(|(hit, _)| hit.t < reach(site));
            let near = near.fold(0.0, |sum, (hit, weight)| sum + weight / hit.t);
            let crowded = near * size_of_level(site.level);
            if crowded <= most || crowded > HOPELESS {
                break;
            }
            site.level -= 1;
            most *= CROWDED_AGAIN;
        }
        hits.iter_mut().filter(|hit| hit.t >= reach(site)).for_each(|hit| *hit = Hit::MISS);
    });
    cast.set_levels(sites.iter().map(|site| site.level));
}

fn received(scene: &Scene, coarse: &mut Coarse, sites: &[Site], fans: &Fans) -> Vec<Light> {
    let fan = fans.near;
    // 1. What is near.
    let mut cast = scene.cast(sites.iter().map(|site| (site, reach(site))), fan, None);
    let mut sites = sites.to_vec();
    come_closer(&mut cast, &mut sites);

    // 2. The coarse sites around that are seen, and what they gather.
    let places: Vec<Place> = sites.iter().map(|site| Place::new(&site.point, site.level)).collect();
    let mut links = Links::new(scene, coarse.cells, &places);
    links.settle(scene, coarse.cells, &places);
    far::ensure(scene, coarse.cells, coarse.bounce, coarse.known, &links.sites(), fans.far);

    // 3. What near rays see.
    let near = coarse.bounce.complete(scene, &scene.seen(&cast), fan);

    // 4. Both together; more rays of their own for sites that see no coarse one.
    let sees = |site: usize| links.of(site).next().is_some();
    let alone: Vec<usize> = (0..sites.len()).into_par_iter().filter(|&site| !sees(site)).collect();
    let own: Vec<Site> = alone.iter().map(|&site| sites[site]).collect();
    let own = far::plain(scene, coarse.bounce, &own, fans.far);
    let coarse = &*coarse;
    let both = |site: usize| {
        let rays = site * fan.len()..(site + 1) * fan.len();
        if !sees(site) {
            return Light::default();
        }
        near_and_far(coarse, sites[site].point.normal, links.of(site), &cast, &near, rays)
    };
    let mut fine: Vec<Light> = (0..sites.len()).into_par_iter().map(both).collect();
    alone.iter().zip(own).for_each(|(&site, light)| fine[site] = light);
    fine
}

/// What a fine site receives from coarse sites, and from what its rays hit nearby: `near` is the radiance along each ray.
fn near_and_far(
    coarse: &Coarse,
    normal: Vec3,
    links: impl Iterator<Item = Link> + Clone,
    cast: &Cast,
    near: &[Vec3],
    rays: std::ops::Range<usize>,
) -> Light {
    let far = |site: u32| coarse.known[site as usize].as_ref().expect("it was ensured");
    let total: f32 = links.clone().map(|(_, weight)| weight).sum();
    let mut light = Light::NONE;
    let mut has_near = cast.hits[rays.clone()].iter().any(Hit::is_some);
    for (site, weight) in links.clone() {
        light.add(weight / total, &far(site).light, normal - coarse.cells.sites[site as usize].point.normal);
        has_near |= far(site).has_near;
    }
    if !has_near {
        return light;
    }
    let mean = light.mean;
    for ray in rays {
        let direction = cast.list.rays[ray].direction;
        let bin = bin(direction);
        let (mut all, mut beyond) = (Mean::default(), Mean::default());
        for (site, weight) in links.clone() {
            let far = far(site);
            all.add(weight, far.all.of(bin));
            beyond.add(weight, far.beyond.of(bin));
        }
        let all = all.or(mean);
        let seen = if cast.hits[ray].is_some() { near[ray] } else { beyond.or(all) };
        light.most = light.most.max(seen);
        light.take(normal, direction, cast.weights[ray] * (seen - all));
    }
    light
}

/// A weighted mean.
#[derive(Default)]
struct Mean {
    sum: Vec3,
    weight: f32,
}

impl Mean {
    #[inline(always)]
    fn add(&mut self, weight: f32, (sum, count): (Vec3, f32)) {
        // By the mean of the rays: with their sum, sites with many rays would count more here than in the light that is corrected.
        if count > 0.0 {
            self.sum += weight * (sum / count);
            self.weight += weight;
        }
    }

    /// The mean, or something else without any.
    #[inline(always)]
    fn or(&self, other: Vec3) -> Vec3 {
        if self.weight > 0.0 { self.sum / self.weight } else { other }
    }
}
