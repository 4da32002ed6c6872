//! Formula (1) on the CPU.

use glam::Vec3;
use rayon::prelude::*;

use super::{DEFAULT_AMBIENT, LightTargets, Surface};
use crate::Picture;
use crate::accel::Hit;
use crate::job::Job;
use crate::prepared::PreparedScene;
use crate::stages::primary_rays::{RayList, object_point};
use crate::stages::shadow_rays::Visibility;

/// Rays that one task shades.
const BATCH: usize = 2048;

pub(crate) fn shade(
    job: &Job,
    scene: &PreparedScene,
    list: &RayList,
    hits: &[Hit],
    visibility: &Visibility,
    picture: &mut Picture,
) {
    let targets = LightTargets::new(&scene.scene.lights);
    let radiance = |ray: usize| {
        list.weight(ray)
            * match hits[ray].is_some() {
                true => surface_radiance(scene, list, hits, visibility, &targets, ray),
                false => scene.scene.background.unwrap_or(Vec3::ZERO),
            }
    };
    let mut radiances = vec![Vec3::ZERO; hits.len()];
    radiances.par_chunks_mut(BATCH).enumerate().for_each(|(batch, radiances)| {
        if job.observer.cancelled() {
            return;
        }
        for (index, value) in radiances.iter_mut().enumerate() {
            *value = radiance(batch * BATCH + index);
        }
        job.observer.advance(radiances.len() as u64);
    });
    for (&pixel, radiance) in list.pixels.iter().zip(radiances) {
        picture.add(pixel, radiance);
    }
    if list.from_camera() {
        fill_layers(scene, list, hits, visibility, picture);
    }
}

/// Formula (1) without its last term.
fn surface_radiance(
    scene: &PreparedScene,
    list: &RayList,
    hits: &[Hit],
    visibility: &Visibility,
    targets: &LightTargets,
    ray: usize,
) -> Vec3 {
    let surface = Surface::new(scene, list, hits, ray);
    let ambient = scene.scene.ambient.unwrap_or(DEFAULT_AMBIENT);
    let mut radiance = ambient * surface.coefficients.ka + surface.coefficients.emission;
    if let Some(&direct) = visibility.direct.get(ray) {
        return radiance + direct;
    }
    let shares = &visibility.share[ray * visibility.lights..][..visibility.lights];
    let reach = scene.reach(surface.point.origin);
    for (index, (light, &share)) in scene.scene.lights.iter().zip(shares).enumerate() {
        if share > 0.0 {
            radiance += share * targets.unshadowed(&surface, light, index, reach);
        }
    }
    radiance
}

/// What each pixel saw.
fn fill_layers(scene: &PreparedScene, list: &RayList, hits: &[Hit], visibility: &Visibility, picture: &mut Picture) {
    let start = (picture.rows.start * picture.size[0]) as usize;
    let Some(layers) = &mut picture.layers else { return };
    for (ray, hit) in hits.iter().enumerate().filter(|(_, hit)| hit.is_some()) {
        let pixel = list.pixels[ray] as usize - start;
        let point = object_point(scene, list, hits, ray);
        layers.depth[pixel] = hit.t;
        layers.normal[pixel] = point.normal.to_array();
        layers.position[pixel] = scene.scene.to_world(point.position).as_vec3().to_array();
        layers.used[pixel] = visibility.used.get(ray).copied().unwrap_or(0);
        for (light, plane) in layers.visibility.iter_mut().enumerate() {
            plane[pixel] = visibility.share[ray * visibility.lights + light];
        }
    }
}
