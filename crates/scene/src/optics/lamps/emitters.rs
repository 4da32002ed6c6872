//! Lights for the patches of a lamp.
//!
//! Which way a patch shines: all sides of a closed lamp shine outwards, an open one shines to both sides, and so does one without anything else, in
//! front of which nothing is: the walls of a room. If a material is
//! [one-sided](crate::Material::one_sided), as in glTF, the order of corners decides instead.

use glam::DVec2;

use super::connected::{Lamp, is_lit};
use super::extent::{Extent, RAISED};
use super::glow::Glow;
use super::patches::Patch;
use super::pieces::{Piece, pieces};
use crate::{Falloff, Geometry, Light, LightKind};

/// Patches that give less than this share of the largest one's light are left out: the others shine for them.
const SMALL: f64 = 0.05;
/// How much of its rectangle a patch fills that is one.
const FILLED: f64 = 0.98;
/// The share of its square that a disc fills, and how much that may differ, also between its widths.
const DISC: (f64, f64) = (std::f64::consts::FRAC_PI_4, 0.06);
/// What lies less in front of a lamp than this share of the scene's diagonal is beside it, as the ceiling is in which a lamp is set.
const BESIDE: f64 = 1e-4;

impl Lamp {
    /// Lights that shine as it does.
    pub(super) fn lights(&self, glow: &Glow, geometry: &Geometry, scene: &Extent, alike: f64) -> Vec<Light> {
        let mut patches = self.patches(alike);
        // 1. Without those that are much weaker than the strongest one: the others shine for them.
        let strength = |patches: &[Patch]| patches.iter().map(Patch::strength).sum::<f64>();
        let (all, strongest) = (strength(&patches), patches.iter().map(Patch::strength).fold(0.0, f64::max));
        patches.retain(|patch| patch.strength() >= SMALL * strongest);
        let brighter = all / strength(&patches);
        // 2. Of a bent surface, the image is not cut.
        let cuts_image = glow.has_image() && patches.len() <= 2;
        let is_closed = self.one_sided || self.volume().is_some();
        let is_room = is_closed
            && !self.one_sided
            && self.is_alone(&geometry.mesh)
            && !patches.iter().any(|patch| patch.is_lit(geometry, scene));
        let sides = |patch| match is_closed {
            true if is_room => both(patch).into(),
            true => vec![patch],
            false => sides(patch, geometry, scene),
        };
        let lights = |patch: Patch| patch.lights(glow, geometry, scene, (brighter, cuts_image));
        patches.into_iter().flat_map(sides).flat_map(lights).collect()
    }
}

/// A patch, and its other side.
fn both(patch: Patch<'_>) -> [Patch<'_>; 2] {
    let other = Patch { outward: -patch.outward, ..patch.clone() };
    [patch, other]
}

/// A patch that shines to both sides, each as one; one in front of which nothing is left is left out, unless that is true of both.
fn sides<'l>(patch: Patch<'l>, geometry: &Geometry, scene: &Extent) -> Vec<Patch<'l>> {
    let [patch, other] = both(patch);
    match [&patch, &other].map(|patch| patch.is_lit(geometry, scene)) {
        [true, false] => vec![patch],
        [false, true] => vec![other],
        _ => vec![patch, other],
    }
}

impl Patch<'_> {
    /// Its light, over π: that of all its surface, also where that is curved.
    fn strength(&self) -> f64 {
        self.triangles.iter().map(|triangle| triangle.radiance * triangle.area()).sum()
    }

    /// Whether anything is in front of it.
    fn is_lit(&self, geometry: &Geometry, scene: &Extent) -> bool {
        let height = self.height() + BESIDE * scene.diagonal;
        is_lit(&geometry.mesh, &scene.bounds, self.normal(), height)
    }

    fn lights(
        &self,
        glow: &Glow,
        geometry: &Geometry,
        scene: &Extent,
        (brighter, cuts_image): (f64, bool),
    ) -> Vec<Light> {
        let normal = self.normal();
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let shape = self.rectangle(|corner| DVec2::new(u.dot(corner), v.dot(corner)));
        let axes = [shape.along.x * u + shape.along.y * v, shape.along.x * v - shape.along.y * u];
        let start = shape.middle.x * u + shape.middle.y * v;
        let pieces = pieces(self, glow, geometry, (start, axes, shape.half), scene, cuts_image);
        // The surface of all is what it is, whatever is lost at the edges of pieces.
        let surface: f64 = self.triangles.iter().map(|triangle| triangle.area()).sum();
        let brighter = brighter * surface / pieces.iter().map(|piece| piece.surface).sum::<f64>();
        let light = |piece: Piece| -> Light {
            let raised = piece.height + RAISED[0] * piece.area.sqrt() + RAISED[1] * scene.diagonal;
            let at = |[a, b]: [f64; 2]| (start + a * axes[0] + b * axes[1] + raised * normal).as_vec3();
            let filled = piece.area / (4.0 * piece.half.x * piece.half.y);
            let is_square = (piece.half.x / piece.half.y - 1.0).abs() < DISC.1;
            let kind = if piece.is_whole && is_square && (filled - DISC.0).abs() < DISC.1 {
                let radius = (piece.area / std::f64::consts::PI).sqrt() as f32;
                LightKind::Disk { position: at(piece.center.to_array()), normal: normal.as_vec3(), radius }
            } else {
                let is_full = filled > FILLED;
                let (middle, share) = if is_full { (piece.center, 1.0) } else { (piece.middle, filled.sqrt()) };
                let half_u = (share * piece.half.x * axes[0]).as_vec3();
                let half_v = (share * piece.half.y * axes[1]).as_vec3();
                LightKind::Rectangle { position: at(middle.to_array()), half_u, half_v }
            };
            Light::new(kind)
                .with_intensity((brighter * piece.strength).as_vec3())
                .with_falloff(Falloff::InverseSquare)
                .with_surface(normal.as_vec3())
                .with_lamp(true)
                .named(glow.name)
        };
        pieces.into_iter().map(light).collect()
    }
}
