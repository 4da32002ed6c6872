//! Formula (1) on the CPU.

use glam::Vec3;
use lightmesh_layout::constants::{LUMINANCE_BLUE, LUMINANCE_GREEN, LUMINANCE_RED};
use rayon::prelude::*;

use crate::data::picture::Picture;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shading::{LightTargets, Surface};

/// Number of rays per task.
const BATCH: usize = 2048;

pub(crate) fn shade(wave: &HostWave, visibility: &Visibility, picture: &mut Picture) {
    let (targets, ambient) = (LightTargets::new(wave.lights()), wave.scene.ambient());
    let mut sums = match visibility.lights.start {
        0 => vec![wave.lights().background.unwrap_or(Vec3::ZERO); wave.hits.len()],
        _ => std::mem::take(&mut picture.sums),
    };
    sums.par_chunks_mut(BATCH).enumerate().for_each(|(batch, sums)| {
        wave.job.piece(sums.len(), || {
            for (index, sum) in sums.iter_mut().enumerate().filter(|(index, _)| wave.sees(batch * BATCH + index)) {
                add_group(wave, visibility, &targets, ambient, batch * BATCH + index, sum);
            }
        });
    });
    if visibility.lights.end == wave.lights().len() {
        let caught = if wave.scene.catches() { catch_shadows(wave, &targets, ambient, &mut sums) } else { Vec::new() };
        for (ray, (&pixel, sum)) in wave.rays.pixels.iter().zip(sums).enumerate() {
            picture.add(pixel, wave.rays.weight(ray) * sum);
        }
        if wave.rays.from_camera() || !wave.rays.shared.is_empty() {
            for (ray, (&pixel, caught)) in wave.rays.pixels.iter().zip(caught).enumerate() {
                picture.catch(pixel, wave.rays.weight(ray).x * caught);
            }
        }
    } else {
        picture.sums = sums;
    }
    if wave.rays.from_camera() {
        fill_layers(wave, visibility, picture);
    } else if !wave.rays.shared.is_empty() {
        add_to_layers(wave, visibility, picture);
    }
}

/// Formula (1) without its last term: the terms of a group of lights are added to those before.
fn add_group(
    wave: &HostWave,
    visibility: &Visibility,
    targets: &LightTargets,
    ambient: Vec3,
    ray: usize,
    radiance: &mut Vec3,
) {
    let is_first = visibility.lights.start == 0;
    if !is_first && visibility.lights.clone().all(|light| visibility.of(light, ray) <= 0.0) {
        return;
    }
    let surface = Surface::shared(wave, ray);
    if is_first {
        *radiance = ambient * surface.coefficients.ka + surface.coefficients.emission;
    }
    let reach = wave.scene.geometry.reach(surface.point.origin);
    for index in visibility.lights.clone() {
        let share = visibility.of(index, ray);
        if share > 0.0 {
            *radiance += share * targets.unshadowed(&surface, &wave.lights()[index], index, reach);
        }
    }
}

/// Shows the background on shadow catchers, as far as they get light. Returns how much they get, as a share of what they would get
/// alone, by ray.
fn catch_shadows(wave: &HostWave, targets: &LightTargets, ambient: Vec3, sums: &mut [Vec3]) -> Vec<f32> {
    let background = wave.lights().background.unwrap_or(Vec3::ZERO);
    let geometry = &wave.scene.scene.geometry;
    let is_catcher = |ray: usize| {
        let triangle = wave.hits[ray].triangle as usize;
        wave.sees(ray) && geometry.materials[geometry.mesh.materials[triangle] as usize].catcher
    };
    let catch = |(ray, sum): (usize, &mut Vec3)| {
        if !is_catcher(ray) {
            return 0.0;
        }
        let share = lit_share(wave, &Surface::new(wave, ray), targets, ambient, *sum);
        *sum = share * background;
        share
    };
    sums.par_iter_mut().enumerate().map(catch).collect()
}

/// The light that a surface gets as a share of what it would get alone.
fn lit_share(wave: &HostWave, surface: &Surface, targets: &LightTargets, ambient: Vec3, lit: Vec3) -> f32 {
    let reach = wave.scene.geometry.reach(surface.point.origin);
    let mut alone = ambient * surface.coefficients.ka + surface.coefficients.emission;
    for (index, light) in wave.lights().iter().enumerate() {
        alone += targets.unshadowed(surface, light, index, reach);
    }
    let alone = luminance(alone);
    if alone > 0.0 { (luminance(lit) / alone).min(1.0) } else { 1.0 }
}

fn luminance(color: Vec3) -> f32 {
    LUMINANCE_RED * color.x + LUMINANCE_GREEN * color.y + LUMINANCE_BLUE * color.z
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
