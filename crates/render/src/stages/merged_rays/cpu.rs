//! Merged rays on the CPU.

use std::ops::Range;

use glam::Vec3;
use lightmesh_layout::constants::{MAX_MERGED, WARP};
use lightmesh_trace::accel::Hit;
use rayon::prelude::*;

use crate::data::rays::RayList;
use crate::data::wave::HostWave;
use crate::footprint::Cone;
use crate::shading::seen_lights::SeenLights;
use crate::stages::pixel_samples::same_surface::{Facet, is_transmissive, most_mirrored};

/// Number of rays per task, without the rest of the last pixel.
const BATCH: usize = 1024;

/// The mirrored rays that are left, and what they see.
pub fn merged_rays(wave: &HostWave) -> (RayList, Vec<Hit>) {
    let (pixels, seen) = (&wave.rays.pixels, SeenLights::new(wave.lights()));
    let begins = |&ray: &usize| ray == 0 || pixels[ray] != pixels[ray - 1];
    let count = pixels.len();
    let starts: Vec<usize> =
        (0..count).step_by(BATCH).map(|ray| (ray..count).find(begins).unwrap_or(count)).chain([count]).collect();
    let parts: Vec<(RayList, Vec<Hit>)> =
        starts.par_windows(2).map(|ends| merge(wave, &seen, ends[0]..ends[1])).collect();
    let mut left = (wave.rays.beyond(), Vec::new());
    for (rays, mut hits) in parts {
        left.0.append(rays);
        left.1.append(&mut hits);
    }
    left
}

/// Merges the rays of some pixels.
fn merge(wave: &HostWave, seen: &SeenLights, rays: Range<usize>) -> (RayList, Vec<Hit>) {
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
            let part = part_of(wave, seen, first, &run, taken);
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
fn part_of(wave: &HostWave, seen: &SeenLights, first: usize, run: &Range<usize>, taken: u32) -> u32 {
    let (scene, list, hit) = (wave.scene, wave.rays, &wave.hits[first]);
    // Nor do those that see lights, or would if they were as wide as all.
    let all = (WARP as f32).sqrt();
    let may_merge =
        |ray: usize| wave.hits[ray].is_some() && list.throughs(ray) == 0 && seen.in_front(wave, ray, all).left == 1.0;
    if !may_merge(first) || is_transmissive(scene, hit) {
        return 1;
    }
    let facet = |ray: usize| {
        let width = list.width_at(wave.surface_point(ray).position);
        Facet::new(scene, &list.rays[ray], &wave.hits[ray], width)
    };
    let own = facet(first);
    let is_blurred = list.lights_share(first) < 1.0;
    let is_alike = |other: usize| {
        let is_taken = taken >> (other - run.start) & 1 != 0;
        if is_taken || !may_merge(other) {
            return false;
        }
        let are_blurred = is_blurred && list.lights_share(other) < 1.0;
        let is_like = |seen: Facet| own.continues(&seen) || are_blurred && own.resembles(&seen);
        wave.hits[other].triangle == hit.triangle || is_like(facet(other))
    };
    let part = (first + 1..run.end).filter(|&other| is_alike(other)).fold(1, |part, other| part | 1 << (other - first));
    let varying = match is_blurred {
        true => 1.0,
        false if list.mirrors(first) => most_mirrored(scene, hit),
        false => 0.0,
    };
    if varying * weight_of(list, first, part).max_element() <= MAX_MERGED { part } else { 1 }
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
