//! Rays that go on, on the CPU.

use std::ops::Range;

use glam::Vec3;
use lightmesh_layout::constants::{LEAST_ONWARD, LEAST_THIN, MOST_THROUGHS, THROUGHS_SHIFT};
use lightmesh_scene::Material;
use rayon::prelude::*;

use super::thinning::Thinning;
use crate::accel::Ray;
use crate::data::rays::RayList;
use crate::data::wave::HostWave;
use crate::footprint::Cone;
use crate::shading::facets::blurred;
use crate::shading::seen_lights::SeenLights;
use crate::shading::{Surface, material_of};

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

/// The rays that go on from those in `range`.
fn onward(wave: &HostWave, seen: &SeenLights, range: Range<usize>) -> RayList {
    let (list, has_cones) = (wave.rays, wave.rays.has_cones());
    let mut next = beyond(list);
    let mut thinning = Thinning::new(list);
    let thins = wave.scene.lets_through();
    let least = if thins { LEAST_THIN } else { LEAST_ONWARD };
    let has_samples = !list.samples.is_empty() || wave.scene.lets_through();
    let mut thinned = |index: usize, weight: Vec3| if thins { thinning.weight(index, weight) } else { Some(weight) };
    let mut add = |index: usize, ray: Ray, cone: Option<Cone>, weight: Vec3, sample: u32| {
        next.rays.push(ray);
        next.cones.extend(cone);
        next.pixels.push(list.pixels[index]);
        next.weights.push(weight);
        if has_samples {
            next.samples.push(sample);
        }
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
        if weight.max_element() >= least
            && list.mirrors(index)
            && let Some(weight) = thinned(index, weight)
        {
            let direction = surface.mirrored().normalize();
            let onward = Ray { origin: surface.point.origin, direction, t_max: f32::INFINITY };
            let cone = || {
                let cone = surface.mirrored_cone(wave, hit, cone());
                let facets = material_of(wave, index).and_then(Material::faceted);
                facets.map_or(cone, |_| blurred(cone, surface.coefficients.roughness))
            };
            add(index, onward, has_cones.then(cone), weight, list.sample(index));
        }
    }
    next
}
