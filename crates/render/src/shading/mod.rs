//! Formula (1), Whitted's model with Phong terms, for one surface point.
//!
//! ```text
//! I(P) = I_a k_a + Σ_i V(L_i, P) · I_i · [ k_d (N·D_i) + k_s (R_i·View)^pow ] + k_s · I_r
//! ```
//!
//! or, of surfaces with [`facets`], their lobe in place of the Phong lobe.
//! Both dot products are clamped at 0, channels are independent. This module has the terms, their coefficients ([`tint`]) and the points
//! that represent a light; the stages [`shade`](crate::stages::shade) and [`mirror_rays`](crate::stages::mirror_rays) combine them. Twins:
//! `shading.cuh`, `tint.cuh`.

pub(crate) mod ambient;
pub(crate) mod dielectric;
pub(crate) mod environment;
pub(crate) mod facets;
pub(crate) mod ids;
pub(crate) mod irradiance;
pub(crate) mod normal_map;
pub(crate) mod seen_lights;
mod texel;
pub(crate) mod tint;
pub(crate) mod turns;

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;
use lightmesh_layout::constants::{
    LIGHT_TARGETS, LUMINANCE_BLUE, LUMINANCE_GREEN, LUMINANCE_RED, PART_OF_LIGHT, STRIP_OF_TARGET,
};
use lightmesh_layout::scene;
use lightmesh_scene::{Facets, Falloff, Geometry, Light, LightKind, Lights, Material};
use lightmesh_trace::accel::Hit;

use crate::data::wave::HostWave;
use crate::footprint::{Cone, curvature};
use crate::sampling::{Pattern, light_center, light_point};
use crate::shadow::size;
use crate::surface::{SurfacePoint, shading_normal};
use ambient::AmbientLight;
use dielectric::{eta_seen, refracted};
use facets::{Lobe, Sight};
use irradiance::{irradiance, nearness};
use normal_map::{Relief, has_relief, mapped_normal, mean_normal, mirroring, normal_at};
use tint::{Coefficients, is_tinted};

/// A surface point with what formula (1) needs.
pub(crate) struct Surface {
    pub(crate) point: SurfacePoint,
    normal: Vec3,
    /// If it has an image of normals.
    relief: Option<Relief>,
    /// Unit vector to the viewer.
    view: Vec3,
    pub(crate) coefficients: Coefficients,
    /// Phong exponent.
    shininess: f32,
    /// In its place, of a surface with facets.
    pub(crate) lobe: Option<Lobe>,
    /// n₁/n₂, from the side of the viewer to the other, of a surface that bends light.
    eta: Option<f32>,
    /// Whether its mirror ray is followed.
    followed: bool,
}

impl Surface {
    #[inline(always)]
    pub(crate) fn new(wave: &HostWave, index: usize) -> Surface {
        let point = wave.surface_point(index);
        let (ray, cone, hit) = (&wave.rays.rays[index], wave.rays.cone_of(index), &wave.hits[index]);
        let geometry = &wave.scene.scene.geometry;
        let mesh = &geometry.mesh;
        let material = &geometry.materials[mesh.materials[mesh.stored(hit.triangle)] as usize];
        let (normal, relief) = normal_at(wave.scene, material, (ray, cone), hit, &point);
        let mut coefficients = Coefficients::at(wave.scene, material, ray, cone, hit);
        // Highlights show the rest of the light that stands for what it emits.
        let shown = wave.rays.lights_share(index);
        if material.lamp && shown < 1.0 {
            coefficients.emission *= shown;
        }
        let surface = Surface {
            normal,
            relief,
            point,
            view: -ray.direction,
            coefficients,
            shininess: material.shininess,
            lobe: None,
            followed: wave.rays.mirrors(index),
            eta: material
                .boundary()
                .and_then(|glass| eta_seen(glass, ray, &wave.scene.geometry.triangles.at(hit.triangle))),
        };
        surface.faceted(wave, index, material)
    }

    /// The same with what facets make of its coefficients, if its material has any.
    #[inline(always)]
    fn faceted(mut self, wave: &HostWave, ray: usize, material: &Material) -> Surface {
        if let Some(facets) = material.faceted() {
            let Coefficients { roughness, metallic, .. } = self.coefficients;
            let facets = Facets::new(roughness).with_metallic(metallic).with_grazing(facets.grazing);
            let (hit, followed) = (&wave.hits[ray], self.followed);
            let cone = wave.rays.cone_of(ray).after(hit.t);
            let spread = if cone.is_point() { 0.0 } else { self.mirrored_cone(wave, hit, cone).spread.abs() };
            let mirrored = wave.rays.is_mirrored(ray);
            let sight = Sight { cosine: self.normal.dot(self.view), spread, followed, mirrored };
            self.lobe = Some(Lobe::new(&facets, &mut self.coefficients, &sight));
        }
        self
    }

    /// The cone that the surface mirrors, if it is smooth, of one that meets it at `hit`.
    pub(crate) fn mirrored_cone(&self, wave: &HostWave, hit: &Hit, cone: Cone) -> Cone {
        let corners = wave.scene.geometry.triangles.at(hit.triangle).corners();
        cone.reflected(curvature(&wave.scene.scene.geometry.mesh, hit, corners, self.point.normal))
    }

    /// What ray number `ray` sees of it without lights: ambient, or gathered, and emitted light.
    #[inline(always)]
    pub(crate) fn unlit(&self, ambient: &AmbientLight, ray: usize) -> Vec3 {
        match ambient.gathered {
            Some(gathered) => gathered[ray] * self.coefficients.all + self.coefficients.emission,
            None => self.alone(ambient),
        }
    }

    /// The same if nothing else was there.
    #[inline(always)]
    pub(crate) fn alone(&self, ambient: &AmbientLight) -> Vec3 {
        let received = match (ambient.gathered, &ambient.terms) {
            (None, _) => ambient.at(self.normal) * self.coefficients.ka,
            (Some(_), Some(_)) => ambient.at(self.normal) * self.coefficients.all,
            // Where nothing surrounds the scene, there is nothing to gather.
            (Some(_), None) => Vec3::ZERO,
        };
        received + self.coefficients.emission
    }

    /// The same with the mean colour, and the mean of the normals, of the samples of its pixel that are shaded with it.
    #[inline(always)]
    pub(crate) fn shared(wave: &HostWave, ray: usize) -> Surface {
        let mut surface = Surface::new(wave, ray);
        let geometry = &wave.scene.scene.geometry;
        let material =
            &geometry.materials[geometry.mesh.materials[geometry.mesh.stored(wave.hits[ray].triangle)] as usize];
        if wave.rays.sampled.is_none() || !is_tinted(geometry, material) {
            return surface;
        }
        let along = (&wave.rays.rays[ray], wave.rays.cone_of(ray));
        if let Some(hits) = wave.rays.shared_hits(ray)
            && let Some(mean) = Coefficients::mean(wave.scene, material, along.0, along.1, hits)
        {
            surface = Surface { coefficients: mean, ..surface }.faceted(wave, ray, material);
        }
        if surface.relief.is_some()
            && let Some(hits) = wave.rays.shared_hits(ray)
        {
            surface.normal = mean_normal(wave.scene, material, along, hits, surface.normal);
        }
        surface
    }

    /// Light of `light` that reaches the eye if all of it comes from `target`: one term of the sum without V.
    #[inline(always)]
    fn reflected(&self, light: &Light, target: Vec3, glint: Glint) -> Vec3 {
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
        let softened = self.softened(direction, cosine);
        let mut answer = softened * self.coefficients.kd;
        if let Some(lobe) = &self.lobe {
            let share = match glint.seen {
                0 => 1.0,
                seen if seen & scene::Light::BOXED != 0 => 1.0 - lobe.boxed,
                seen if seen & scene::Light::PAINTED != 0 => 1.0 - lobe.shown,
                _ => lobe.unmirrored,
            };
            answer += (softened * share) * lobe.toward(self.normal, self.view, direction, glint.part / distance);
        } else if self.coefficients.ks != Vec3::ZERO && !(glint.seen != 0 && self.followed) {
            // What mirror rays see is no highlight, too.
            let mirrored = 2.0 * cosine * self.normal - direction;
            let highlight = mirrored.dot(self.view).max(0.0).powf(self.shininess);
            let highlight = if softened == cosine { highlight } else { softened / cosine * highlight };
            answer += highlight * self.coefficients.ks;
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
        let mean = sum / points.len() as f32;
        Some(mean + self.of_whole(light, points, reach))
    }

    /// By how much the light that arrives from all of a light that is near or wide differs from what its points say.
    #[inline(always)]
    fn of_whole(&self, light: &Light, points: &[Vec3], reach: f32) -> Vec3 {
        let way = light_center(light, self.point.origin, reach) - self.point.position;
        let share = nearness(light, way);
        if share > 0.0 { share * self.beyond_points(light, points, reach, way) } else { Vec3::ZERO }
    }

    /// The same for all of its irradiance. What the image of normals and a spot's cone change is known from the points.
    #[inline(never)]
    fn beyond_points(&self, light: &Light, points: &[Vec3], reach: f32, way: Vec3) -> Vec3 {
        let (mut arriving, mut plain) = (Vec3::ZERO, Vec3::ZERO);
        for &target in points {
            let place = self.place_of(light, target, reach);
            arriving += self.arriving_from(light, place);
            plain += self.arriving_plainly(light, place);
        }
        let whole = irradiance(light, way, self.normal) * light.intensity;
        let shaped =
            |arriving: f32, plain: f32, whole: f32| if plain > 0.0 { whole * (arriving / plain) } else { whole };
        let whole = Vec3::new(
            shaped(arriving.x, plain.x, whole.x),
            shaped(arriving.y, plain.y, whole.y),
            shaped(arriving.z, plain.z, whole.z),
        );
        whole - arriving / points.len() as f32
    }

    /// The light of `light` that arrives from `target`, times the cosine, without a cone or an image of normals.
    #[inline(always)]
    fn arriving_plainly(&self, light: &Light, target: Vec3) -> Vec3 {
        let Some((direction, distance, cosine)) = self.way_to(target) else { return Vec3::ZERO };
        let emitted = light.surface.map_or(1.0, |_| cone(light, direction));
        (cosine * emitted * falloff(light, distance)) * light.intensity
    }

    /// The same if all of it comes from `target`.
    pub(crate) fn arriving_from(&self, light: &Light, target: Vec3) -> Vec3 {
        let Some((direction, distance, cosine)) = self.way_to(target) else { return Vec3::ZERO };
        self.softened(direction, cosine) * strength(light, direction, distance)
    }

    /// The direction, the distance and the cosine of a point above the horizon; `None` for others, also for the surface point itself.
    #[inline(always)]
    fn way_to(&self, target: Vec3) -> Option<(Vec3, f32, f32)> {
        let to_light = target - self.point.position;
        let distance = to_light.length();
        let cosine = self.normal.dot(to_light) / distance;
        (cosine > 0.0).then(|| (to_light / distance, distance, cosine))
    }

    /// The cosine of light along `direction`, by the image of normals if there is one.
    #[inline(always)]
    fn softened(&self, direction: Vec3, cosine: f32) -> f32 {
        self.relief.map_or(cosine, |relief| relief.softened(direction, cosine))
    }

    /// The same for the whole light, averaged over `targets`; those of a directional light are seen from the surface, at distance 1.
    #[inline(always)]
    fn reflected_from_all(&self, light: &Light, targets: &[Vec3], reach: f32, glint: Glint) -> Vec3 {
        let place = |target: Vec3| self.place_of(light, target, reach);
        let sum: Vec3 = targets.iter().map(|&target| self.reflected(light, place(target), glint)).sum();
        sum / targets.len() as f32
    }

    /// Where a target of a light is seen from here.
    #[inline(always)]
    fn place_of(&self, light: &Light, target: Vec3, reach: f32) -> Vec3 {
        let directional = matches!(light.kind, LightKind::Directional { .. });
        if directional { self.point.origin + reach * target } else { target }
    }

    /// The normal of mirrored and refracted rays.
    fn mirroring(&self) -> Vec3 {
        self.relief.map_or(self.normal, |_| mirroring(self.normal, self.point.normal, self.view))
    }

    /// A direction in which its facets reflect the view, and its share of the radiance there; see [`Lobe::drawn`]. A smooth normal may reflect into
    /// the surface; then the direction is reflected there.
    pub(crate) fn drawn(&self, lobe: &Lobe, u: [f32; 2]) -> (Vec3, Vec3) {
        let (direction, share) = lobe.drawn(self.mirroring(), self.view, u);
        let height = direction.dot(self.point.normal);
        (if height < 0.0 { direction - 2.0 * height * self.point.normal } else { direction }, share)
    }

    /// The reflection direction of the view. A smooth normal may reflect into the surface; then the geometric normal is used.
    pub(crate) fn mirrored(&self) -> Vec3 {
        let about = |normal: Vec3| 2.0 * normal.dot(self.view) * normal - self.view;
        let direction = about(self.mirroring());
        if direction.dot(self.point.normal) > 0.0 { direction } else { about(self.point.normal) }
    }

    /// Where a ray starts, and its direction, that the surface lets through: straight on from the other side, bent by a body, or reflected where
    /// the body reflects everything. A smooth normal may bend it back; then the geometric normal is used.
    pub(crate) fn onward(&self) -> (Vec3, Vec3) {
        let direction = -self.view;
        let Some(eta) = self.eta else { return (self.point.behind(), direction) };
        let bent = refracted(direction, self.mirroring(), eta).and_then(|bent| {
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
    let material =
        || &geometry.materials[geometry.mesh.materials[geometry.mesh.stored(wave.hits[ray].triangle)] as usize];
    wave.sees(ray).then(material)
}

/// Whether any material has an image of normals.
pub(crate) fn has_reliefs(geometry: &Geometry) -> bool {
    geometry.materials.iter().any(|material| has_relief(geometry, material))
}

/// The normal that shading uses of what ray number `ray` sees; the mean over the samples of its pixel that are shaded with it.
pub(crate) fn normal_seen(wave: &HostWave, ray: usize) -> Vec3 {
    let (hit, point) = (&wave.hits[ray], wave.surface_point(ray));
    let smooth = shading_normal(&wave.scene.scene.geometry.mesh, hit, point.normal);
    match material_of(wave, ray) {
        Some(material) if has_relief(&wave.scene.scene.geometry, material) => {
            let along = (&wave.rays.rays[ray], wave.rays.cone_of(ray));
            let own = mapped_normal(wave.scene, material, along, hit, smooth);
            let shared = wave.rays.shared_hits(ray);
            shared.map_or(own, |hits| mean_normal(wave.scene, material, along, hits, own))
        }
        _ => smooth,
    }
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
pub fn strength(light: &Light, direction: Vec3, distance: f32) -> Vec3 {
    falloff(light, distance) * cone(light, direction) * light.intensity
}

/// What is left of a light at `distance`, over π where that is its unit.
#[inline(always)]
pub(crate) fn falloff(light: &Light, distance: f32) -> f32 {
    match (light.falloff, &light.kind) {
        (Falloff::None, _) => 1.0,
        (Falloff::InverseSquare, LightKind::Directional { .. }) => FRAC_1_PI,
        (Falloff::InverseSquare, _) => FRAC_1_PI / (distance * distance),
    }
}

/// The share of a light's strength along `direction`, from the surface to the light. A spot's falls as glTF recommends (KHR_lights_punctual, inner
/// and outer cone angles), that of an emissive surface with the cosine.
#[inline(always)]
pub fn cone(light: &Light, direction: Vec3) -> f32 {
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
pub struct LightTargets {
    /// By light; empty for a light without a size.
    pub points: Vec<Vec<Vec3>>,
    /// How mirror rays see each light, too.
    seen: Vec<u32>,
}

/// What the highlight of a light is about.
#[derive(Clone, Copy)]
struct Glint {
    /// Half of the width of the part of the light that a point stands for.
    part: f32,
    /// How mirror rays see the light, too.
    seen: u32,
}

/// How rays see a light, bits of [`scene::Light`]'s constants: as an emissive surface, or the sun of what surrounds the scene, or in its image, as the soft box
/// around a studio's key light, or as a surface that is none of the scene's.
pub(crate) fn seen_as(lights: &Lights, light: &Light) -> u32 {
    if light.lamp || lights.sun_is(light) {
        scene::Light::SEEN
    } else if lights.studio || lights.surroundings_show(light) {
        let boxed = if lights.studio { scene::Light::BOXED } else { 0 };
        scene::Light::SEEN | scene::Light::PAINTED | boxed
    } else if lights.is_shown(light) {
        scene::Light::SEEN | scene::Light::SURFACE | if light.visible { scene::Light::CAMERA } else { 0 }
    } else {
        0
    }
}

impl LightTargets {
    /// The points of these lights.
    pub fn new(lights: &Lights) -> LightTargets {
        let pattern = Pattern::new(0, 0, 0);
        // In pairs on either side of the centre: what falls off linearly over the light is averaged exactly.
        let pair = |light: &Light, index: u32| {
            let point = light_point(light, Vec3::ZERO, 1.0, pattern.point(index));
            [point, 2.0 * light_center(light, Vec3::ZERO, 1.0) - point]
        };
        let spread = |light: &Light| (0..LIGHT_TARGETS / 2).flat_map(|index| pair(light, index)).collect();
        LightTargets {
            points: lights.iter().map(|light| if light.has_size() { spread(light) } else { Vec::new() }).collect(),
            seen: lights.iter().map(|light| seen_as(lights, light)).collect(),
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
    /// part of that share, nor of the [unshadowed light](Self::unshadowed), and must not be taken away twice. Near a light whose samples were
    /// `weighed`, it is the share of what is above the horizon.
    #[inline(always)]
    pub(crate) fn shown(
        &self,
        surface: &Surface,
        (light, index): (&Light, usize),
        reach: f32,
        (seen, weighed): (Vec3, bool),
    ) -> Vec3 {
        // Of lights without light, such as the suns whose hours are counted, only what sees them matters.
        if light.intensity == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let way = light_center(light, surface.point.origin, reach) - surface.point.position;
        if weighed && light.has_size() && nearness(light, way) > 0.0 {
            return seen * self.unshadowed(surface, light, index, reach);
        }
        let seen = (seen / self.above_horizon(surface, light, index, reach)).min(Vec3::ONE);
        seen * self.unshadowed(surface, light, index, reach)
    }

    /// The share of the light above the horizon; 1 of a light without an area, and where there is none. Each point stands for a strip.
    #[inline(always)]
    fn above_horizon(&self, surface: &Surface, light: &Light, index: usize, reach: f32) -> f32 {
        let points = self.points[index].as_slice();
        // That of the surface, whatever its relief.
        let normal = surface.relief.map_or(surface.normal, |relief| relief.smooth);
        let height = |target: Vec3| normal.dot(surface.place_of(light, target, reach) - surface.point.position);
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
        let glint = Glint { part: PART_OF_LIGHT * size(light, reach), seen: self.seen[index] };
        match self.points[index].as_slice() {
            [] => surface.reflected(light, light_center(light, surface.point.origin, reach), glint),
            points => {
                let whole = surface.of_whole(light, points, reach);
                surface.reflected_from_all(light, points, reach, glint) + whole * surface.coefficients.kd
            }
        }
    }
}
