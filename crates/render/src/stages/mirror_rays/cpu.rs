//! Mirror rays on the CPU.

use glam::Vec3;

use crate::accel::Ray;
use crate::data::rays::RayList;
use crate::data::wave::HostWave;
use crate::footprint::{Cone, curvature};
use crate::shading::Surface;

pub(crate) fn mirror_rays(wave: &HostWave) -> RayList {
    let mut next = RayList { window: wave.rays.window, ..RayList::default() };
    for ray in (0..wave.hits.len()).filter(|&ray| wave.sees(ray)) {
        let surface = Surface::new(wave, ray);
        let weight = wave.rays.weight(ray) * surface.coefficients.ks;
        if weight == Vec3::ZERO {
            continue;
        }
        next.rays.push(Ray {
            origin: surface.point.origin,
            direction: surface.mirrored().normalize(),
            t_max: f32::INFINITY,
        });
        if wave.rays.has_cones() {
            next.cones.push(reflected(wave, ray, &surface));
        }
        next.pixels.push(wave.rays.pixels[ray]);
        next.weights.push(weight);
        if !wave.rays.samples.is_empty() {
            next.samples.push(wave.rays.sample(ray));
        }
    }
    next
}

/// The cone that a mirror reflects.
fn reflected(wave: &HostWave, ray: usize, surface: &Surface) -> Cone {
    let hit = &wave.hits[ray];
    let corners = wave.scene.geometry.triangles[hit.triangle as usize].corners();
    let curvature = curvature(&wave.scene.scene.geometry.mesh, hit, corners, surface.point.normal);
    wave.rays.cone_of(ray).after(hit.t).reflected(curvature)
}
