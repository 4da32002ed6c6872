//! Formula (1) on the CPU.

use glam::Vec3;
use rayon::prelude::*;

use crate::data::picture::{Picture, light_groups_of};
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shading::ambient::AmbientLight;
use crate::shading::environment::missed;
use crate::shading::ids::ids_of;
use crate::shading::seen_lights::SeenLights;
use crate::shading::{LightTargets, Surface, catches, luminance};
use crate::steps::spread_out;

/// Number of rays per task.
const BATCH: usize = 2048;
/// Number of terms of single lights that are held at once.
const TERMS: usize = 1 << 20;

pub(crate) fn shade(wave: &HostWave, visibility: &Visibility, gathered: Option<&Vec<Vec3>>, picture: &mut Picture) {
    let targets = LightTargets::new(wave.lights());
    let ambient = AmbientLight::of(wave.scene).with_gathered(gathered.map(Vec::as_slice));
    let mut sums = match visibility.lights.start {
        0 => vec![Vec3::ZERO; wave.hits.len()],
        _ => std::mem::take(&mut picture.sums),
    };
    spread_out(sums.chunks_mut(BATCH)).for_each(|(batch, sums)| {
        wave.context.piece(sums.len(), || {
            for (ray, sum) in (batch * BATCH..).zip(sums) {
                if wave.sees(ray) {
                    add_group(wave, visibility, &targets, &ambient, ray, sum);
                } else if visibility.lights.start == 0 {
                    *sum = missed(wave, ray);
                }
            }
        });
    });
    let seen = SeenLights::new(wave.lights());
    if visibility.lights.end == wave.lights().len() {
        let caught = if wave.scene.catches() { catch_shadows(wave, &targets, &ambient, &mut sums) } else { Vec::new() };
        let left = seen.put_in_front(wave, &mut sums);
        let keeps = picture.caught.is_some();
        for (ray, (&pixel, &sum)) in wave.rays.pixels.iter().zip(&sums).enumerate() {
            picture.add(pixel, weight_in_film(wave, &seen, keeps, ray) * sum);
        }
        if keeps {
            keep_what_is_behind(wave, &caught, &left, picture);
        }
    }
    add_light_groups(wave, visibility, (&targets, &seen), &ambient, &sums, picture);
    if visibility.lights.end != wave.lights().len() {
        picture.sums = sums;
    }
    if wave.rays.from_camera() {
        fill_layers(wave, visibility, picture);
    } else if !wave.rays.shared.is_empty() {
        add_to_layers(wave, visibility, picture);
    }
}

/// The mean of three channels.
fn mean(color: Vec3) -> f32 {
    color.element_sum() / 3.0
}

/// Adds how much of what is behind everything the camera's rays show, those of shadow catchers as much as they `caught`; lights in front leave a share.
fn keep_what_is_behind(wave: &HostWave, caught: &[f32], left: &[f32], picture: &mut Picture) {
    for (ray, &pixel) in wave.rays.pixels.iter().enumerate().filter(|(ray, _)| !wave.rays.is_mirrored(*ray)) {
        let passed = !wave.sees(ray) && wave.rays.throughs(ray) > 0;
        let share = if passed { 1.0 } else { caught.get(ray).copied().unwrap_or(0.0) };
        let share = left.get(ray).map_or(share, |left| left * share);
        picture.catch(pixel, mean(wave.rays.weight(ray)) * share);
    }
}

/// The share of a ray's radiance that reaches its pixel. What is behind everything is seen on shadow catchers, and by rays that went through all
/// surfaces: where the image `keeps` how much of it there is, for it to be taken out again, filters do not colour it, unless a light is in front.
fn weight_in_film(wave: &HostWave, seen: &SeenLights, keeps: bool, ray: usize) -> Vec3 {
    let (rays, weight) = (wave.rays, wave.rays.weight(ray));
    let through = keeps && rays.throughs(ray) > 0 && !rays.is_mirrored(ray);
    let is_behind = through && (!wave.sees(ray) || catches(wave, ray));
    if is_behind && seen.in_front(wave, ray, 1.0).left == 1.0 { Vec3::splat(mean(weight)) } else { weight }
}

/// Formula (1) without its last term: the terms of a group of lights are added to those before.
fn add_group(
    wave: &HostWave,
    visibility: &Visibility,
    targets: &LightTargets,
    ambient: &AmbientLight,
    ray: usize,
    radiance: &mut Vec3,
) {
    let is_first = visibility.lights.start == 0;
    if !is_first && visibility.lights.clone().all(|light| visibility.of(light, ray) <= 0.0) {
        return;
    }
    let surface = Surface::shared(wave, ray);
    if is_first {
        *radiance = surface.unlit(ambient, ray);
    }
    let reach = wave.scene.geometry.sun_distance(surface.point.origin);
    for index in visibility.lights.clone() {
        if visibility.of(index, ray) > 0.0 {
            let light = &wave.lights()[index];
            *radiance +=
                targets.shown(&surface, (light, index), reach, (visibility.color(index, ray), visibility.weighed));
        }
    }
}

/// Adds what each ray gets from each light of this group by itself, and what belongs to no light, to their planes. The sums of rays are
/// complete after the last group.
fn add_light_groups(
    wave: &HostWave,
    visibility: &Visibility,
    (targets, seen): (&LightTargets, &SeenLights),
    ambient: &AmbientLight,
    sums: &[Vec3],
    picture: &mut Picture,
) {
    let start = (picture.rows.start * picture.size[0]) as usize;
    let Some(layers) = picture.layers.as_mut().filter(|layers| !layers.rest.is_empty()) else { return };
    let (lights, keeps) = (visibility.lights.clone(), picture.caught.is_some());
    let planes = lights.len() + 1;
    let mut groups: Vec<&mut Vec<[f32; 3]>> = light_groups_of(layers).skip(lights.start).collect();
    // The last one belongs to no light.
    let last = groups.len() - 1;
    groups.swap(lights.len(), last);
    let rest = lights.len();
    let shows_sum = |ray: usize| wave.sees(ray) && catches(wave, ray);
    for (part, sums) in sums.chunks((TERMS / planes).max(1)).enumerate() {
        let first = part * (TERMS / planes).max(1);
        let mut terms = vec![Vec3::ZERO; planes * sums.len()];
        terms.par_chunks_mut(BATCH * planes).zip(sums.par_chunks(BATCH)).enumerate().for_each(
            |(batch, (terms, sums))| {
                wave.context.piece(0, || {
                    for (index, (terms, &sum)) in terms.chunks_exact_mut(planes).zip(sums).enumerate() {
                        let ray = first + batch * BATCH + index;
                        by_light(wave, visibility, targets, ambient, ray, sum, terms);
                        if !shows_sum(ray) {
                            let left = seen.in_front(wave, ray, 1.0).left;
                            terms.iter_mut().for_each(|term| *term *= left);
                        }
                    }
                });
            },
        );
        for (ray, terms) in (first..).zip(terms.chunks_exact(planes)) {
            let (pixel, weight) = (wave.rays.pixels[ray] as usize - start, weight_in_film(wave, seen, keeps, ray));
            for (plane, &term) in groups.iter_mut().zip(terms) {
                plane[pixel] = (Vec3::from_array(plane[pixel]) + weight * term).to_array();
            }
            // Lights in front of all that.
            if !seen.is_empty() && !shows_sum(ray) {
                seen.each(wave, ray, 1.0, |light, radiance| {
                    if let Some(plane) = (light as usize).checked_sub(lights.start).filter(|&light| light < rest) {
                        let plane = &mut groups[plane][pixel];
                        *plane = (Vec3::from_array(*plane) + weight * radiance).to_array();
                    }
                });
            }
        }
    }
}

/// What a ray gets from each light of the group, and then what belongs to no light.
fn by_light(
    wave: &HostWave,
    visibility: &Visibility,
    targets: &LightTargets,
    ambient: &AmbientLight,
    ray: usize,
    sum: Vec3,
    terms: &mut [Vec3],
) {
    let lights = visibility.lights.clone();
    let (is_first, is_last) = (lights.start == 0, lights.end == wave.lights().len());
    let rest = lights.len();
    if !wave.sees(ray) {
        if is_first {
            terms[rest] = missed(wave, ray);
        }
        return;
    }
    if !is_first && !is_last && lights.clone().all(|light| visibility.of(light, ray) <= 0.0) {
        return;
    }
    // A shadow catcher shows what is behind it.
    if catches(wave, ray) {
        if is_last {
            terms[rest] = sum;
        }
        return;
    }
    let surface = Surface::shared(wave, ray);
    if is_first {
        terms[rest] = surface.unlit(ambient, ray);
    }
    let reach = wave.scene.geometry.sun_distance(surface.point.origin);
    for (index, term) in lights.zip(terms) {
        if visibility.of(index, ray) > 0.0 {
            let light = &wave.lights()[index];
            *term = targets.shown(&surface, (light, index), reach, (visibility.color(index, ray), visibility.weighed));
        }
    }
}

/// Shows what is behind shadow catchers, as far as they get light. Returns how much they get, as a share of what they would get
/// alone, by ray.
fn catch_shadows(wave: &HostWave, targets: &LightTargets, ambient: &AmbientLight, sums: &mut [Vec3]) -> Vec<f32> {
    let catch = |(ray, sum): (usize, &mut Vec3)| {
        if !catches(wave, ray) {
            return 0.0;
        }
        let share = lit_share(wave, &Surface::new(wave, ray), targets, ambient, *sum);
        *sum = share * missed(wave, ray);
        share
    };
    sums.par_iter_mut().enumerate().map(catch).collect()
}

/// The light that a surface gets as a share of what it would get alone.
fn lit_share(wave: &HostWave, surface: &Surface, targets: &LightTargets, ambient: &AmbientLight, lit: Vec3) -> f32 {
    let reach = wave.scene.geometry.sun_distance(surface.point.origin);
    let mut alone = surface.alone(ambient);
    for (index, light) in wave.lights().iter().enumerate() {
        alone += targets.unshadowed(surface, light, index, reach);
    }
    let alone = luminance(alone);
    if alone > 0.0 { (luminance(lit) / alone).min(1.0) } else { 1.0 }
}

/// Stores what each pixel sees.
fn fill_layers(wave: &HostWave, visibility: &Visibility, picture: &mut Picture) {
    let start = (picture.rows.start * picture.size[0]) as usize;
    let Some(layers) = &mut picture.layers else { return };
    for (ray, hit) in wave.hits.iter().enumerate().filter(|(_, hit)| hit.is_some()) {
        let pixel = wave.rays.pixels[ray] as usize - start;
        // With several samples, these layers are the nearest one's.
        if wave.rays.sampled.is_none() {
            let point = wave.surface_point(ray);
            layers.depth[pixel] = hit.t;
            layers.normal[pixel] = point.normal.to_array();
            layers.position[pixel] = wave.scene.scene.to_world(point.position).as_vec3().to_array();
            if !layers.object.is_empty() {
                [layers.object.nearest[pixel], layers.material.nearest[pixel]] = ids_of(wave.scene, hit);
            }
        }
        layers.used[pixel] = visibility.used.get(ray).copied().unwrap_or(0);
        for light in visibility.lights.clone() {
            layers.visibility[light][pixel] = visibility.of(light, ray);
        }
    }
}

/// Adds what fragments see to the layers of their pixels.
fn add_to_layers(wave: &HostWave, visibility: &Visibility, picture: &mut Picture) {
    let start = (picture.rows.start * picture.size[0]) as usize;
    let Some(layers) = &mut picture.layers else { return };
    for (ray, pixel) in wave.rays.pixels.iter().enumerate().filter(|(ray, _)| wave.sees(*ray)) {
        let (pixel, weight) = (*pixel as usize - start, wave.rays.weights[ray].x);
        layers.used[pixel] = layers.used[pixel].max(visibility.used.get(ray).copied().unwrap_or(0));
        for light in visibility.lights.clone() {
            layers.visibility[light][pixel] += weight * visibility.of(light, ray);
        }
    }
}
