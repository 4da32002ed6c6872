//! Formula (1), Whitted's model with Phong terms, for one surface point.
//!
//! ```text
//! I(P) = I_a k_a + Σ_i V(L_i, P) · I_i · [ k_d (N·D_i) + k_s (R_i·View)^pow ] + k_s · I_r
//! ```
//!
//! Both dot products are clamped at 0, channels are independent. This module has the terms, their coefficients ([`tint`]) and the points
//! that represent a light; the stages [`shade`](crate::stages::shade) and [`mirror_rays`](crate::stages::mirror_rays) combine them. Twins:
//! `shading.cuh`, `tint.cuh`.

pub(crate) mod ambient;
pub(crate) mod dielectric;
pub(crate) mod environment;
pub(crate) mod ids;
#[cfg(test)]
mod tests;
pub(crate) mod tint;

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;
use lightmesh_layout::constants::{LIGHT_TARGETS, LUMINANCE_BLUE, LUMINANCE_GREEN, LUMINANCE_RED, STRIP_OF_TARGET};
use lightmesh_scene::{Falloff, Light, LightKind, Material};

use crate::data::wave::HostWave;
use crate::sampling::{Pattern, light_center, light_point};
use crate::surface::{SurfacePoint, shading_normal};
use ambient::AmbientLight;
use dielectric::{eta_seen, refracted};
use tint::{Coefficients, is_tinted};

/// A surface point with what formula (1) needs.
pub(crate) struct Surface {
    pub(crate) point: SurfacePoint,
    normal: Vec3,
    /// Unit vector to the viewer.
    view: Vec3,
    pub(crate) coefficients: Coefficients,
    /// Phong exponent.
    shininess: f32,
    /// n₁/n₂, from the side of the viewer to the other, of a surface that bends light.
    eta: Option<f32>,
}

impl Surface {
    #[inline(always)]
    pub(crate) fn new(wave: &HostWave, ray: usize) -> Surface {
        let point = wave.surface_point(ray);
        let (ray, cone, hit) = (&wave.rays.rays[ray], wave.rays.cone_of(ray), &wave.hits[ray]);
        let geometry = &wave.scene.scene.geometry;
        let mesh = &geometry.mesh;
        let material = &geometry.materials[mesh.materials[hit.triangle as usize] as usize];
        Surface {
            normal: shading_normal(mesh, hit, point.normal),
            point,
            view: -ray.direction,
            coefficients: Coefficients::at(wave.scene, material, ray, cone, hit),
            shininess: material.shininess,
            eta: material
                .boundary()
                .and_then(|glass| eta_seen(glass, ray, &wave.scene.geometry.triangles[hit.triangle as usize])),
        }
    }

    /// What ray number `ray` sees of it without lights: ambient, or gathered, and emitted light.
    #[inline(always)]
    pub(crate) fn unlit(&self, ambient: &AmbientLight, ray: usize) -> Vec3 {
        match ambient.gathered {
            Some(gathered) => gathered[ray] * self.coefficients.kd + self.coefficients.emission,
            None => self.alone(ambient),
        }
    }

    /// The same if nothing else was there.
    #[inline(always)]
    pub(crate) fn alone(&self, ambient: &AmbientLight) -> Vec3 {
        let reflected = if ambient.gathered.is_some() { self.coefficients.kd } else { self.coefficients.ka };
        ambient.at(self.normal) * reflected + self.coefficients.emission
    }

    /// The same with the mean colour of the samples of its pixel that are shaded with it.
    #[inline(always)]
    pub(crate) fn shared(wave: &HostWave, ray: usize) -> Surface {
        let mut surface = Surface::new(wave, ray);
        if let Some(sampled) = &wave.rays.sampled {
            let geometry = &wave.scene.scene.geometry;
            let material = &geometry.materials[geometry.mesh.materials[wave.hits[ray].triangle as usize] as usize];
            let shared = wave.rays.shared.get(ray).copied().unwrap_or(u32::MAX);
            if is_tinted(geometry, material) && shared != 0 {
                let hits = sampled.hits_of(wave.rays.pixels[ray], shared);
                let (ray, cone) = (&wave.rays.rays[ray], wave.rays.cone_of(ray));
                let mean = Coefficients::mean(wave.scene, material, ray, cone, hits);
                surface.coefficients = mean.unwrap_or(surface.coefficients);
            }
        }
        surface
    }

    /// Light of `light` that reaches the eye if all of it comes from `target`: one term of the sum without V.
    #[inline(always)]
    pub(crate) fn reflected(&self, light: &Light, target: Vec3) -> Vec3 {
        let to_light = target - self.point.position;
        let distance = to_light.length();
        if distance == 0.0 {
            return Vec3::ZERO;
        }
        let direction = to_light / distance;
        let cosine = self.normal.dot(direction);
        if cosine <= 0.0 {
            return Vec3::ZERO;
        }
        let mut answer = cosine * self.coefficients.kd;
        if self.coefficients.ks != Vec3::ZERO {
            let mirrored = 2.0 * cosine * self.normal - direction;
            answer += mirrored.dot(self.view).max(0.0).powf(self.shininess) * self.coefficients.ks;
        }
        strength(light, direction, distance) * answer
    }

    /// The light of `light` that arrives, times the cosine, if nothing is in the way; `None` if a part of the light is below the horizon.
    pub(crate) fn arriving(&self, targets: &LightTargets, light: &Light, index: usize, reach: f32) -> Option<Vec3> {
        let points = targets.points[index].as_slice();
        if points.is_empty() {
            return Some(self.arriving_from(light, light_center(light, self.point.origin, reach)));
        }
        let mut sum = Vec3::ZERO;
        for &target in points {
            let place = self.place_of(light, target, reach);
            if self.point.normal.dot(place - self.point.origin) <= 0.0 {
                return None;
            }
            sum += self.arriving_from(light, place);
        }
        Some(sum / points.len() as f32)
    }

    /// The same if all of it comes from `target`.
    pub(crate) fn arriving_from(&self, light: &Light, target: Vec3) -> Vec3 {
        let to_light = target - self.point.position;
        let distance = to_light.length();
        let cosine = self.normal.dot(to_light) / distance;
        if cosine > 0.0 { cosine * strength(light, to_light / distance, distance) } else { Vec3::ZERO }
    }

    /// The same for the whole light, averaged over `targets`; those of a directional light are seen from the surface, at distance 1.
    #[inline(always)]
    pub(crate) fn reflected_from_all(&self, light: &Light, targets: &[Vec3], reach: f32) -> Vec3 {
        let place = |target: Vec3| self.place_of(light, target, reach);
        let sum: Vec3 = targets.iter().map(|&target| self.reflected(light, place(target))).sum();
        sum / targets.len() as f32
    }

    /// Where a target of a light is seen from here.
    #[inline(always)]
    fn place_of(&self, light: &Light, target: Vec3, reach: f32) -> Vec3 {
        let directional = matches!(light.kind, LightKind::Directional { .. });
        if directional { self.point.origin + reach * target } else { target }
    }

    /// The reflection direction of the view. A smooth normal may reflect into the surface; then the geometric normal is used.
    pub(crate) fn mirrored(&self) -> Vec3 {
        let about = |normal: Vec3| 2.0 * normal.dot(self.view) * normal - self.view;
        let direction = about(self.normal);
        if direction.dot(self.point.normal) > 0.0 { direction } else { about(self.point.normal) }
    }

    /// Where a ray starts, and its direction, that the surface lets through: straight on from the other side, bent by a body, or reflected where
    /// the body reflects everything. A smooth normal may bend it back; then the geometric normal is used.
    pub(crate) fn onward(&self) -> (Vec3, Vec3) {
        let direction = -self.view;
        let Some(eta) = self.eta else { return (self.point.behind(), direction) };
        let bent = refracted(direction, self.normal, eta).and_then(|bent| {
            let is_behind = bent.dot(self.point.normal) < 0.0;
            if is_behind { Some(bent) } else { refracted(direction, self.point.normal, eta) }
        });
        match bent {
            Some(bent) => (self.point.behind(), bent),
            None => (self.point.origin, self.mirrored().normalize()),
        }
    }
}

/// The material of what a ray sees, if it sees anything.
pub(crate) fn material_of<'a>(wave: &HostWave<'a>, ray: usize) -> Option<&'a Material> {
    let geometry = &wave.scene.scene.geometry;
    let material = || &geometry.materials[geometry.mesh.materials[wave.hits[ray].triangle as usize] as usize];
    wave.sees(ray).then(material)
}

/// Whether a ray sees a shadow catcher.
pub(crate) fn catches(wave: &HostWave, ray: usize) -> bool {
    material_of(wave, ray).is_some_and(|material| material.catcher)
}

/// The luminance of a colour.
#[inline(always)]
pub(crate) fn luminance(color: Vec3) -> f32 {
    LUMINANCE_RED * color.x + LUMINANCE_GREEN * color.y + LUMINANCE_BLUE * color.z
}

/// Intensity of `light` at `distance` along `direction` (from the surface to the light), falloff and cone included.
#[inline(always)]
fn strength(light: &Light, direction: Vec3, distance: f32) -> Vec3 {
    let falloff = match (light.falloff, &light.kind) {
        (Falloff::None, _) => 1.0,
        (Falloff::InverseSquare, LightKind::Directional { .. }) => FRAC_1_PI,
        (Falloff::InverseSquare, _) => FRAC_1_PI / (distance * distance),
    };
    falloff * cone(light, direction) * light.intensity
}

/// The share of a light's strength along `direction`, from the surface to the light. A spot's falls as glTF recommends (KHR_lights_punctual, inner
/// and outer cone angles), that of an emissive surface with the cosine.
#[inline(always)]
fn cone(light: &Light, direction: Vec3) -> f32 {
    if let Some(normal) = light.surface {
        return (-direction.dot(normal)).max(0.0);
    }
    let LightKind::Spot { direction: axis, inner, outer, .. } = light.kind else { return 1.0 };
    let scale = 1.0 / (inner.cos() - outer.cos()).max(1e-3);
    let linear = ((-direction.dot(axis) - outer.cos()) * scale).clamp(0.0, 1.0);
    linear * linear
}

/// The points of each light from which its unshadowed light is computed: its centre, or several distributed over it. Those of a directional
/// light are at distance 1 from the origin.
pub(crate) struct LightTargets {
    points: Vec<Vec<Vec3>>,
}

impl LightTargets {
    pub(crate) fn new(lights: &[Light]) -> LightTargets {
        let pattern = Pattern::new(0, 0, 0);
        // In pairs on either side of the centre: what falls off linearly over the light is averaged exactly.
        let pair = |light: &Light, index: u32| {
            let point = light_point(light, Vec3::ZERO, 1.0, pattern.point(index));
            [point, 2.0 * light_center(light, Vec3::ZERO, 1.0) - point]
        };
        let spread = |light: &Light| (0..LIGHT_TARGETS / 2).flat_map(|index| pair(light, index)).collect();
        LightTargets {
            points: lights.iter().map(|light| if light.has_size() { spread(light) } else { Vec::new() }).collect(),
        }
    }

    /// The points of all lights in sequence, [`LIGHT_TARGETS`] each; zeros for a light without an area.
    pub(crate) fn flat(&self) -> Vec<Vec3> {
        let padded = |points: &Vec<Vec3>| {
            (0..LIGHT_TARGETS as usize).map(|i| points.get(i).copied().unwrap_or_default()).collect()
        };
        self.points.iter().flat_map(|points| -> Vec<Vec3> { padded(points) }).collect()
    }

    /// The light of light number `index` that reaches the eye if `seen` is the share of the light that arrives. What is below the horizon is no
    /// part of that share, nor of the [unshadowed light](Self::unshadowed), and must not be taken away twice.
    #[inline(always)]
    pub(crate) fn shown(&self, surface: &Surface, light: &Light, index: usize, reach: f32, seen: Vec3) -> Vec3 {
        let seen = (seen / self.above_horizon(surface, light, index, reach)).min(Vec3::ONE);
        seen * self.unshadowed(surface, light, index, reach)
    }

    /// The share of the light above the horizon; 1 of a light without an area, and where there is none. Each point stands for a strip.
    #[inline(always)]
    fn above_horizon(&self, surface: &Surface, light: &Light, index: usize, reach: f32) -> f32 {
        let points = self.points[index].as_slice();
        let height = |target: Vec3| surface.normal.dot(surface.place_of(light, target, reach) - surface.point.position);
        let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
        for &target in points {
            let height = height(target);
            (least, most) = (least.min(height), most.max(height));
        }
        if least >= 0.0 || most <= 0.0 {
            return 1.0;
        }
        let strip = (most - least) * STRIP_OF_TARGET;
        let sum: f32 = points.iter().map(|&target| (0.5 + height(target) / strip).clamp(0.0, 1.0)).sum();
        sum / points.len() as f32
    }

    /// Unshadowed light of light number `index` at `surface`.
    #[inline(always)]
    pub(crate) fn unshadowed(&self, surface: &Surface, light: &Light, index: usize, reach: f32) -> Vec3 {
        match self.points[index].as_slice() {
            [] => surface.reflected(light, light_center(light, surface.point.origin, reach)),
            points => surface.reflected_from_all(light, points, reach),
        }
    }
}
