//! Mirror rays on the CPU.

use glam::Vec3;

use crate::accel::{Hit, Ray};
use crate::prepared::PreparedScene;
use crate::stages::primary_rays::RayList;
use crate::stages::shade::Surface;

pub(crate) fn mirror_rays(scene: &PreparedScene, list: &RayList, hits: &[Hit]) -> RayList {
    let mut next = RayList::default();
    for ray in (0..hits.len()).filter(|&ray| hits[ray].is_some()) {
        let surface = Surface::new(scene, list, hits, ray);
        let weight = list.weight(ray) * surface.coefficients.ks;
        if weight == Vec3::ZERO {
            continue;
        }
        next.rays.push(Ray {
            origin: surface.point.origin,
            direction: surface.mirrored().normalize(),
            t_max: f32::INFINITY,
        });
        next.pixels.push(list.pixels[ray]);
        next.weights.push(weight);
    }
    next
}
