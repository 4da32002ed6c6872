//! Merged rays on the CPU.

use std::ops::Range;

use glam::Vec3;
use lightmesh_layout::constants::{MOST_MERGED, WARP};
use rayon::prelude::*;

use crate::accel::Hit;
use crate::data::rays::RayList;
use crate::data::wave::HostWave;
use crate::footprint::Cone;
use crate::stages::pixel_samples::alike::{Facet, lets_through, most_mirrored};

/// Number of rays per task, without the rest of the last pixel.
const BATCH: usize = 1024;

/// The mirrored rays that are left, and what they see.
pub(crate) fn merged_rays(wave: &HostWave) -> (RayList, Vec<Hit>) {
    let pixels = &wave.rays.pixels;
    let begins = |&ray: &usize| ray == 0 || pixels[ray] != pixels[ray - 1];
    let count = pixels.len();
    let starts: Vec<usize> =
        (0..count).step_by(BATCH).map(|ray| (ray..count).find(begins).unwrap_or(count)).chain([count]).collect();
    let parts: Vec<(RayList, Vec<Hit>)> = starts.par_windows(2).map(|ends| merge(wave, ends[0]..ends[1])).collect();
    let mut left = (wave.rays.beyond(), Vec::new());
    for (rays, mut hits) in parts {
        left.0.append(rays);
        left.1.append(&mut hits);
    }
    left
}

/// Merges the rays of some pixels.
fn merge(wave: &HostWave, rays: Range<usize>) -> (RayList, Vec<Hit>) {
    let list = wave.rays;
    let (mut left, mut hits) = (list.beyond(), Vec::new());
    let mut start = rays.start;
    while start < rays.end {
        let same = (start..rays.end).take(WARP as usize).take_while(|&ray| list.pixels[ray] == list.pixels[start]);
        let run = start..start + same.count();
        start = run.end;
        let mut taken = 0_u32;
        for first in run.clone() {
            if taken >> (first - run.start) & 1 != 0 {
                continue;
            }
            // 1. The rays on one surface.
            let part = part_of(wave, first, &run, taken);
            taken |= part << (first - run.start);
            // 2. As one.
            let cone = list.cone_of(first);
            left.rays.push(list.rays[first]);
            left.pixels.push(list.pixels[first]);
            left.samples.extend(list.samples.get(first));
            left.weights.push(weight_of(list, first, part));
            left.cones.extend((!list.cones.is_empty()).then(|| covering(cone, part.count_ones())));
            hits.push(wave.hits[first]);
        }
    }
    (left, hits)
}

/// The rays that ray `first` of a pixel takes: bit k stands for the k-th ray after it.
fn part_of(wave: &HostWave, first: usize, run: &Range<usize>, taken: u32) -> u32 {
    let (scene, list, hit) = (wave.scene, wave.rays, &wave.hits[first]);
    let may_merge = |ray: usize| wave.hits[ray].is_some() && list.throughs(ray) == 0;
    if !may_merge(first) || lets_through(scene, hit) {
        return 1;
    }
    let facet = |ray: usize| {
        let width = list.width_at(wave.surface_point(ray).position);
        Facet::new(scene, &list.rays[ray], &wave.hits[ray], width)
    };
    let own = facet(first);
    let is_alike = |other: usize| {
        let is_taken = taken >> (other - run.start) & 1 != 0;
        !is_taken && may_merge(other) && (wave.hits[other].triangle == hit.triangle || own.continues(&facet(other)))
    };
    let part = (first + 1..run.end).filter(|&other| is_alike(other)).fold(1, |part, other| part | 1 << (other - first));
    let mirrored = if list.mirrors(first) { most_mirrored(scene, hit) } else { 0.0 };
    if mirrored * weight_of(list, first, part).max_element() <= MOST_MERGED { part } else { 1 }
}

/// The sum of the weights of the rays of a part.
fn weight_of(list: &RayList, first: usize, part: u32) -> Vec3 {
    let rays = (0..u32::BITS).filter(|bit| part >> bit & 1 != 0);
    rays.fold(Vec3::ZERO, |sum, bit| sum + list.weight(first + bit as usize))
}

/// The cone around so many rays.
fn covering(cone: Cone, count: u32) -> Cone {
    let times = (count as f32).sqrt();
    Cone { width: times * cone.width, spread: times * cone.spread }
}

#[cfg(test)]
mod tests {
    use lightmesh_layout::constants::THROUGHS_SHIFT;
    use lightmesh_scene::Material;
    use lightmesh_testkit::SceneDraft;

    use super::*;
    use crate::accel::Ray;
    use crate::data::lights::LightGroup;
    use crate::data::wave::Wave;
    use crate::job::{Job, Sampling};
    use crate::observer::Unobserved;
    use crate::prepared::PreparedScene;
    use crate::settings::Acceleration;

    /// What is left of rays straight down from these places, in these pixels, above a floor that mirrors `ks` and, at x < 0, a higher one.
    fn left(ks: f32, rays: &[(f32, u32)], throughs: u32) -> (RayList, Vec<Hit>) {
        let floor = |x: f64, y: f64| [[x, y, -5.0], [x, y, 5.0], [x + 5.0, y, 5.0], [x + 5.0, y, -5.0]];
        let draft = SceneDraft::new().painted(Material::default().with_ks(Vec3::splat(ks)));
        let scene = draft.quad(floor(0.0, 0.0)).quad(floor(-5.0, 1.0)).finish("floors");
        let scene = PreparedScene::new(&scene, &Acceleration::BruteForce, &Unobserved).unwrap();
        let down = |x: f32| Ray { origin: Vec3::new(x, 4.0, 0.2), direction: Vec3::NEG_Y, t_max: f32::INFINITY };
        let list = RayList {
            rays: rays.iter().map(|&(x, _)| down(x)).collect(),
            pixels: rays.iter().map(|&(_, pixel)| pixel).collect(),
            samples: (0..rays.len() as u32).map(|ray| ray + 1 + (throughs << THROUGHS_SHIFT)).collect(),
            weights: (0..rays.len()).map(|ray| Vec3::splat(0.25 + ray as f32 / 64.0)).collect(),
            cones: vec![Cone { width: 0.5, spread: -0.25 }; rays.len()],
            depth: 1 + throughs,
            bounces: 2,
            spacing: [0.0, 0.01],
            eye: Vec3::splat(2.0),
            ..RayList::default()
        };
        let mut hits = vec![Hit::MISS; rays.len()];
        scene.geometry.accelerator.closest_hits(&list.rays, &mut hits);
        let job = Job::new(&Unobserved, Sampling { samples: 1, seed: 0, spread: false });
        merged_rays(&Wave { job: &job, scene: &scene, rays: &list, hits: &hits, lights: LightGroup::ALL, parts: 1 })
    }

    const RAYS: [(f32, u32); 7] = [(1.0, 3), (-1.0, 3), (1.1, 3), (9.0, 3), (-1.1, 3), (1.2, 5), (8.0, 5)];

    #[test]
    fn rays_of_a_pixel_on_one_surface_are_one() {
        let (rays, hits) = left(0.0, &RAYS, 0);
        let origins: Vec<f32> = rays.rays.iter().map(|ray| ray.origin.x).collect();
        assert_eq!(origins, [1.0, -1.0, 9.0, 1.2, 8.0], "what sees nothing stays apart");
        assert_eq!(rays.pixels, [3, 3, 3, 5, 5]);
        assert_eq!(rays.samples, [1, 2, 4, 6, 7]);
        let weights: Vec<f32> = rays.weights.iter().map(|weight| 64.0 * weight.x).collect();
        assert_eq!(weights, [34.0, 37.0, 19.0, 21.0, 22.0]);
        assert_eq!(hits.iter().map(|hit| hit.is_some()).collect::<Vec<_>>(), [true, true, false, true, false]);
        let root = 2.0_f32.sqrt();
        let widths: Vec<f32> = rays.cones.iter().map(|cone| cone.width).collect();
        assert_eq!(widths, [0.5 * root, 0.5 * root, 0.5, 0.5, 0.5]);
        assert_eq!((rays.depth, rays.bounces, rays.spacing), (1, 2, [0.0, 0.01]));
    }

    #[test]
    fn rays_that_meet_clear_mirrors_or_went_through_something_stay_apart() {
        assert_eq!(left(0.05, &RAYS, 0).1.len(), 5, "a twentieth of half a pixel's light may be merged");
        assert_eq!(left(0.5, &RAYS, 0).1.len(), RAYS.len());
        assert_eq!(left(0.0, &RAYS, 1).1.len(), RAYS.len());
    }

    #[test]
    fn many_rays_of_one_pixel_are_merged_32_at_a_time() {
        let rays: Vec<(f32, u32)> = (0..2100).map(|ray| (1.0, ray / 70)).collect();
        let (rays, _) = left(0.0, &rays, 0);
        assert_eq!(rays.pixels, (0..30).flat_map(|pixel| [pixel; 3]).collect::<Vec<u32>>());
    }
}
