//! Lights for lamps: surfaces that emit light.
//!
//! Gather rays rarely find a small bright surface, and none are cast where the ambient light is constant. So every surface that emits light gets
//! lights, whatever its size, its strength or its texture.
//!
//! 1. The triangles of a material that share corners form a lamp ([`connected`]), also those of instances, where they are placed.
//! 2. A lamp that is nearly a ball becomes a ball ([`balls`]).
//! 3. Else its triangles that face a similar way form a patch ([`patches`]): an emitter in one plane.
//! 4. A large patch, or one that a texture makes uneven, is cut into pieces ([`pieces`]). Each has the mean radiance of its texels ([`glow`]).
//! 5. A patch or piece becomes a rectangle, or a disc, of its area. A rectangle and a disc become just that.
//! 6. If there are very many, those that are near each other and face the same way become one ([`merged`]). No light is lost by that.
//!
//! What surrounds the scene, such as a dome with an image of the sky, has no lights: every gather ray finds it.

mod balls;
mod connected;
mod emitters;
mod extent;
mod glow;
pub(crate) mod merged;
mod patches;
mod pieces;

use glam::Vec3;

use self::{connected::Lamp, extent::Extent, glow::Glow};
use crate::{Geometry, Light, LightKind, Material, Scene};

/// If there are more lights, triangles whose normals differ more form one patch.
const MANY: usize = 32;
/// Triangles whose normals deviate more, by cosine, begin a patch of their own. If there are too many lights, the next one counts.
const SAME_PATCH: [f64; 5] = [0.85, 0.75, 0.6, 0.4, 0.2];
/// A lamp, and the ball that it is, if it is one.
type Found = (Lamp, Option<Light>);

/// Makes lights for the lamps of a geometry, among the materials that are [marked](crate::Material::lamp). The mark of those that
/// emit nothing is taken away. Triangles of a lamp that surrounds the scene get a material without mark if others have theirs.
pub fn lamps(geometry: &mut Geometry) -> Vec<Light> {
    for material in &mut geometry.materials {
        material.lamp = may_be_lamp(material);
    }
    if !geometry.materials.iter().any(|material| material.lamp) {
        return Vec::new();
    }
    let bounds = geometry.mesh.bounds();
    let middle = bounds.center().as_dvec3();
    let scene = Extent { middle, diagonal: f64::from(bounds.diagonal()), bounds };
    let mut found = connected::lamps(geometry, &scene);
    for (material, lamps) in &mut found {
        let (around, others) = std::mem::take(lamps).into_iter().partition(|lamp| lamp.surrounds(geometry, &scene));
        *lamps = others;
        leave_to_rays(geometry, *material, &around, lamps.is_empty());
    }
    let found: Vec<(u32, Vec<Found>)> = found
        .into_iter()
        .map(|(number, lamps)| {
            let glow = Glow::of(geometry, number);
            let ball = |lamp: Lamp| {
                let ball = lamp.ball(&glow, geometry, &scene, number);
                (lamp, ball)
            };
            (number, lamps.into_iter().map(ball).collect())
        })
        .collect();
    let count = |alike: f64| -> usize {
        let count = |(lamp, ball): &Found| if ball.is_some() { 1 } else { lamp.patches(alike).len() };
        found.iter().flat_map(|(_, lamps)| lamps).map(count).sum()
    };
    let alike = SAME_PATCH.into_iter().find(|&alike| count(alike) <= MANY).unwrap_or(SAME_PATCH[4]);
    let mut lights = Vec::new();
    for (number, lamps) in found {
        let glow = Glow::of(geometry, number);
        let lights_of = |(lamp, ball): Found| match ball {
            Some(ball) => vec![ball],
            None => lamp.lights(&glow, geometry, &scene, alike),
        };
        let own: Vec<Light> = lamps.into_iter().flat_map(lights_of).collect();
        let is_finite = own.iter().all(|light| light.intensity.is_finite());
        geometry.materials[number as usize].lamp &= is_finite;
        if is_finite {
            lights.extend(own.into_iter().filter(is_usable));
        }
    }
    merged::merged(lights)
}

/// Whether lights may stand for what surfaces of a material emit: not for what is merely shown as its image is.
fn may_be_lamp(material: &Material) -> bool {
    material.lamp && material.emission != Vec3::ZERO && material.emission_tinted == Vec3::ZERO
}

/// Takes the mark from a material, or gives some of its lamps another one without.
fn leave_to_rays(geometry: &mut Geometry, material: u32, lamps: &[Lamp], are_all: bool) {
    if lamps.is_empty() {
        return;
    }
    if are_all {
        geometry.materials[material as usize].lamp = false;
        return;
    }
    let other = geometry.materials.len() as u32;
    geometry.materials.push(geometry.materials[material as usize].clone().with_lamp(false));
    for triangle in lamps.iter().flat_map(|lamp| &lamp.triangles) {
        geometry.mesh.materials[triangle.stored] = other;
    }
}

/// Whether a light has a size and a strength in single precision.
fn is_usable(light: &Light) -> bool {
    let has_size = match light.kind {
        LightKind::Rectangle { half_u, half_v, .. } => half_u.cross(half_v).length_squared() > 0.0,
        LightKind::Disk { radius, .. } | LightKind::Sphere { radius, .. } => radius > 0.0,
        _ => false,
    };
    has_size && light.intensity != Vec3::ZERO
}

impl Scene {
    /// Makes lights for lamps, as opened files have them: surfaces that emit light. Their [materials](crate::Material::lamp) are
    /// marked; lights that were made before are replaced.
    pub fn add_lamps(&mut self) {
        self.lights.list.retain(|light| !light.lamp);
        let geometry = self.geometry_mut();
        for material in &mut geometry.materials {
            material.lamp = true;
        }
        let lights = lamps(geometry);
        self.lights.list.extend(lights);
    }
}
