//! Rays that go on, on the CPU.

use std::ops::Range;

use glam::Vec3;
use lightmesh_layout::constants::{
    DIRECTION_SHIFT, FADE_SHIFT, LOBE_PATTERN, LOBE_TILE, MAX_DIRECTIONS, MAX_THROUGHS, MIN_ONWARD, MIN_THIN,
    THROUGHS_SHIFT, UPPER_BITS, UPPER_NIBBLES, UPPER_PAIRS,
};
use lightmesh_trace::accel::Ray;
use rayon::prelude::*;

use super::thinning::Thinning;
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

/// The points that select the directions of the `count` mirror rays of a ray.
fn points(wave: &HostWave, ray: usize, count: u32) -> impl Fn(u32) -> [f32; 2] {
    let list = wave.rays;
    // 1. Those of a tile of pixels are one pattern at each depth, in the order of a curve.
    let place = list.window.place(list.pixels[ray]);
    let [column, row] = place.map(|place| place.rem_euclid(LOBE_TILE as i32) as u32);
    // Tiles to the left of the image, and above, have negative numbers.
    let [across, down] = place.map(|place| place.div_euclid(LOBE_TILE as i32) as u32);
    let tile = (down << 16).wrapping_add(across);
    let key = u64::from(list.depth) << 32 | u64::from(tile);
    let pattern = Pattern::new(wave.context.sampling.seed, key, LOBE_PATTERN as usize);
    let place = along_curve(column, row);

    // 2. Those of a pixel follow each other: of its first sample, or of the only one, and so on.
    let samples = if list.sample(ray) == 0 { 1 } else { wave.context.pixel_samples.next_power_of_two() };
    let directions = if list.is_mirrored(ray) { MAX_DIRECTIONS } else { count };
    // Of very many samples it does not matter where the numbers begin anew.
    let first = place.wrapping_mul(samples * directions).wrapping_add(list.number_in_pixel(ray) * count);
    move |number| {
        let point = pattern.point(first.wrapping_add(number));
        [point.x, point.y]
    }
}

/// The number of a pixel of a tile along the curve that visits the squares of 2, 4, 8 … pixels one after the other: the bits of both
/// coordinates in turn.
fn along_curve(x: u32, y: u32) -> u32 {
    spaced(x) | (spaced(y) << 1)
}

/// Eight bits with a zero above each.
fn spaced(bits: u32) -> u32 {
    let bits = (bits | bits << 4) & !UPPER_NIBBLES;
    let bits = (bits | bits << 2) & !UPPER_PAIRS;
    (bits | bits << 1) & !UPPER_BITS
}

/// The rays that go on from those in `range`.
fn onward(wave: &HostWave, seen: &SeenLights, range: Range<usize>) -> RayList {
    let (list, has_cones) = (wave.rays, wave.rays.has_cones());
    let mut next = beyond(list);
    let mut thinning = Thinning::new(list);
    let thins = wave.scene.is_transmissive();
    let least = if thins { MIN_THIN } else { MIN_ONWARD };
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
            && throughs < MAX_THROUGHS
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
        let point = points(wave, index, count);
        for number in 0..count {
            let (direction, share) = surface.drawn(lobe, point(number));
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
