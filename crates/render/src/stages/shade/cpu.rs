//! Formula (1) on the CPU.

use glam::Vec3;
use rayon::prelude::*;

use crate::data::picture::Picture;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shading::{DEFAULT_AMBIENT, LightTargets, Surface};

/// Number of rays per task.
const BATCH: usize = 2048;

pub(crate) fn shade(wave: &HostWave, visibility: &Visibility, picture: &mut Picture) {
    let targets = LightTargets::new(wave.lights());
    let radiance = |ray: usize| {
        wave.rays.weight(ray)
            * match wave.sees(ray) {
                true => surface_radiance(wave, visibility, &targets, ray),
                false => wave.lights().background.unwrap_or(Vec3::ZERO),
            }
    };
    let mut radiances = vec![Vec3::ZERO; wave.hits.len()];
    radiances.par_chunks_mut(BATCH).enumerate().for_each(|(batch, radiances)| {
        wave.job.piece(radiances.len(), || {
            for (index, value) in radiances.iter_mut().enumerate() {
                *value = radiance(batch * BATCH + index);
            }
        });
    });
    for (&pixel, radiance) in wave.rays.pixels.iter().zip(radiances) {
        picture.add(pixel, radiance);
    }
    if wave.rays.from_camera() {
        fill_layers(wave, visibility, picture);
    }
}

/// Formula (1) without its last term.
fn surface_radiance(wave: &HostWave, visibility: &Visibility, targets: &LightTargets, ray: usize) -> Vec3 {
    let surface = Surface::new(wave, ray);
    let ambient = wave.lights().ambient.unwrap_or(DEFAULT_AMBIENT);
    let mut radiance = ambient * surface.coefficients.ka + surface.coefficients.emission;
    let reach = wave.scene.geometry.reach(surface.point.origin);
    for (index, light) in wave.lights().iter().enumerate() {
        let share = visibility.of(index, ray);
        if share > 0.0 {
            radiance += share * targets.unshadowed(&surface, light, index, reach);
        }
    }
    radiance
}

/// Stores what each pixel sees.
fn fill_layers(wave: &HostWave, visibility: &Visibility, picture: &mut Picture) {
    let start = (picture.rows.start * picture.size[0]) as usize;
    let Some(layers) = &mut picture.layers else { return };
    for (ray, hit) in wave.hits.iter().enumerate().filter(|(_, hit)| hit.is_some()) {
        let pixel = wave.rays.pixels[ray] as usize - start;
        let point = wave.surface_point(ray);
        layers.depth[pixel] = hit.t;
        layers.normal[pixel] = point.normal.to_array();
        layers.position[pixel] = wave.scene.scene.to_world(point.position).as_vec3().to_array();
        layers.used[pixel] = visibility.used.get(ray).copied().unwrap_or(0);
        for (light, plane) in layers.visibility.iter_mut().enumerate() {
            plane[pixel] = visibility.of(light, ray);
        }
    }
}
