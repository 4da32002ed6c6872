//! Formula (1) on the CPU.

use glam::Vec3;
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
        for (ray, (&pixel, sum)) in wave.rays.pixels.iter().zip(sums).enumerate() {
            picture.add(pixel, wave.rays.weight(ray) * sum);
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
