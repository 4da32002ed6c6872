//! Rays that go on, on the CPU.

use std::ops::Range;

use glam::Vec3;
use lightmesh_layout::constants::{
    DIRECTION_SHIFT, FADE_SHIFT, LEAST_ONWARD, LEAST_THIN, LOBE_PATTERN, MOST_THROUGHS, THROUGHS_SHIFT,
};
use rayon::prelude::*;

use super::thinning::Thinning;
use crate::accel::Ray;
use crate::data::rays::RayList;
use crate::data::wave::HostWave;
use crate::footprint::Cone;
use crate::sampling::Pattern;
use crate::shading::Surface;
use crate::shading::facets::{blurred, directions, faded};
use crate::shading::seen_lights::SeenLights;

/// Number of rays per task, without the rest of the last pixel.
const BATCH: usize = 1024;

/// The mirrored rays of a wave.
pub fn mirror_rays(wave: &HostWave) -> RayList {
    let (count, pixels) = (wave.hits.len(), &wave.rays.pixels);
    let begins = |&ray: &usize| ray == 0 || pixels[ray] != pixels[ray - 1];
    let first_from = |ray: usize| (ray..count).find(begins).unwrap_or(count);
    let starts: Vec<usize> = (0..count).step_by(BATCH).map(first_from).chain([count]).collect();
    let seen = SeenLights::new(wave.lights());
    let parts: Vec<RayList> = starts.par_windows(2).map(|ends| onward(wave, &seen, ends[0]..ends[1])).collect();
    let mut next = beyond(wave.rays);
    parts.into_iter().for_each(|part| next.append(part));
    next
}

/// No rays that go on from those of `list`.
fn beyond(list: &RayList) -> RayList {
    RayList { depth: list.depth + 1, ..list.beyond() }
}

/// The pattern of the directions of all mirror rays of a ray's pixel at this depth: samples take parts of it that follow each other.
fn pattern_of(wave: &HostWave, ray: usize) -> Pattern {
    let list = wave.rays;
    let key = u64::from(list.depth) << 32 | u64::from(list.window.number(list.pixels[ray]));
    Pattern::new(wave.job.sampling.seed, key, LOBE_PATTERN as usize)
}

/// The rays that go on from those in `range`.
fn onward(wave: &HostWave, seen: &SeenLights, range: Range<usize>) -> RayList {
    let (list, has_cones) = (wave.rays, wave.rays.has_cones());
    let mut next = beyond(list);
    let mut thinning = Thinning::new(list);
    let thins = wave.scene.lets_through();
    let least = if thins { LEAST_THIN } else { LEAST_ONWARD };
    let mut thinned = |index: usize, weight: Vec3| if thins { thinning.weight(index, weight) } else { Some(weight) };
    let mut add = |index: usize, ray: Ray, cone: Option<Cone>, weight: Vec3, sample: u32| {
        next.rays.push(ray);
        next.cones.extend(cone);
        next.pixels.push(list.pixels[index]);
        next.weights.push(weight);
        next.samples.push(sample);
    };
    for index in range.filter(|&ray| wave.sees(ray)) {
        let surface = Surface::new(wave, index);
        let (hit, throughs) = (&wave.hits[index], list.throughs(index));
        let cone = || list.cone_of(index).after(hit.t);
        let reaches = seen.in_front(wave, index, 1.0).left * list.weight(index);

        // 1. Through the surface.
        let weight = reaches * surface.coefficients.transmittance;
        if weight.max_element() >= least
            && throughs < MOST_THROUGHS
            && let Some(weight) = thinned(index, weight)
        {
            let (origin, direction) = surface.onward();
            let onward = Ray { origin, direction, t_max: f32::INFINITY };
            add(index, onward, has_cones.then(cone), weight, list.sample(index) + (1 << THROUGHS_SHIFT));
        }

        // 2. Mirrored.
        let weight = reaches * surface.coefficients.mirrored;
        if !(weight.max_element() >= least && list.mirrors(index)) {
            continue;
        }
        let (origin, t_max) = (surface.point.origin, f32::INFINITY);
        let cone = || surface.mirrored_cone(wave, hit, cone());
        let sample = list.unfaded(index);
        let Some(lobe) = &surface.lobe else {
            if let Some(weight) = thinned(index, weight) {
                let direction = surface.mirrored().normalize();
                add(index, Ray { origin, direction, t_max }, has_cones.then(cone), weight, sample);
            }
            continue;
        };

        // 3. In some directions, if it is rough.
        let roughness = surface.coefficients.roughness;
        let count = if list.is_mirrored(index) { 1 } else { directions(weight.max_element(), roughness) };
        let cone = || blurred(cone(), roughness, count, list.weight(index).max_element());
        let sample = sample | faded(roughness) << FADE_SHIFT;
        let pattern = pattern_of(wave, index);
        for number in 0..count {
            let point = pattern.point(list.sample_index(index) * count + number);
            let (direction, share) = surface.drawn(lobe, [point.x, point.y]);
            let weight = reaches * share / count as f32;
            if weight.max_element() >= least
                && let Some(weight) = thinned(index, weight)
            {
                add(
                    index,
                    Ray { origin, direction, t_max },
                    has_cones.then(cone),
                    weight,
                    sample | number << DIRECTION_SHIFT,
                );
            }
        }
    }
    next
}
