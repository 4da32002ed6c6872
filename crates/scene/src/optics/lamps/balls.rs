//! A lamp that is nearly a ball becomes a ball: one light with its shape and its power, seen evenly from all sides.
//!
//! 1. It is closed, and nothing shines through it.
//! 2. The sphere nearest to its corners, by least squares: |p|² = 2 c·p + (r² − |c|²) is linear in what is looked for. No corner is farther from
//!    that sphere than [`ROUND`] of its radius.
//! 3. It fills [`FILLED`] of that ball: a cube's corners lie on a sphere, too, but it fills 0.37. A ball of 8 segments and 4 rings fills 0.77, one
//!    of 16 and 8 0.94.
//! 4. It emits evenly, within [`EVEN`].
//!
//! The ball is as large as to contain the lamp, which hides none of its light; the sum of radiance times area over π, a quarter of which a ball of
//! radiance L has as its intensity, L π r², is that of the lamp.

use glam::{DMat4, DVec3, DVec4};

use super::connected::Lamp;
use super::extent::{Extent, RAISED};
use super::glow::Glow;
use crate::{Falloff, Geometry, Light, LightKind};

/// How far a corner of a ball may be from its sphere, as a share of the radius.
const ROUND: f64 = 0.01;
/// What a ball fills of its sphere, at least and at most.
const FILLED: [f64; 2] = [0.75, 1.01];
/// The radiance of triangles of a ball differs less from its mean, as a share of that.
const EVEN: f64 = 0.02;
/// Corners that lie in a plane, or nearly, have a smaller determinant.
const FLAT: f64 = 1e-9;

/// A sphere about a place.
struct Sphere {
    center: DVec3,
    radius: f64,
}

impl Lamp {
    /// The ball that shines as it does, if it is nearly one, and of material number `material`.
    pub(super) fn ball(&self, glow: &Glow, geometry: &Geometry, scene: &Extent, material: u32) -> Option<Light> {
        // 1. What is closed.
        if geometry.materials[material as usize].is_transmissive() {
            return None;
        }
        let volume = self.volume()?;
        let volume = if self.one_sided { volume } else { volume.abs() };
        // 2. The sphere.
        let Sphere { center, radius } = self.sphere()?;
        let off = |corner: DVec3| (corner.distance(center) / radius - 1.0).abs();
        if !self.corners().all(|corner| off(corner) <= ROUND) {
            return None;
        }
        // 3. What it fills of that: six times 4/3 π r³.
        let filled = volume / (8.0 * std::f64::consts::PI * radius.powi(3));
        if !(FILLED[0]..=FILLED[1]).contains(&filled) {
            return None;
        }
        // 4. Its strength.
        let radiance = |stored: usize| glow.of_triangle(&geometry.mesh, stored);
        let area: f64 = self.triangles.iter().map(|triangle| triangle.area()).sum();
        let strength: DVec3 = self.triangles.iter().map(|triangle| triangle.area() * radiance(triangle.stored)).sum();
        let mean = strength / area;
        let is_even = |stored: usize| (radiance(stored) - mean).abs().max_element() <= EVEN * mean.abs().max_element();
        // Triangles without an area are those at the poles.
        let mut solid = self.triangles.iter().filter(|triangle| triangle.area() > 0.0);
        if glow.has_image() && !solid.all(|triangle| is_even(triangle.stored)) {
            return None;
        }
        let around = self.corners().map(|corner| corner.distance(center)).fold(0.0, f64::max);
        let radius = (around + RAISED[0] * around + RAISED[1] * scene.diagonal) as f32;
        let light = Light::new(LightKind::Sphere { position: center.as_vec3(), radius })
            .with_intensity((0.25 * strength).as_vec3())
            .with_falloff(Falloff::InverseSquare)
            .with_lamp(true)
            .named(glow.name);
        Some(light)
    }

    /// The sphere nearest to its corners; `None` if they lie in a plane.
    fn sphere(&self) -> Option<Sphere> {
        let count = (3 * self.triangles.len()) as f64;
        let middle = self.corners().sum::<DVec3>() / count;
        let size = self.corners().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
        let (mut matrix, mut sums) = (DMat4::ZERO, DVec4::ZERO);
        for corner in self.corners() {
            let place = (corner - middle) / size;
            let row = place.extend(1.0) / count;
            matrix += DMat4::from_cols(place.x * row, place.y * row, place.z * row, row);
            sums += place.length_squared() * row;
        }
        let is_flat = matrix.determinant() <= FLAT;
        if is_flat {
            return None;
        }
        let found = matrix.inverse() * sums;
        let center = 0.5 * found.truncate();
        let square = found.w + center.length_squared();
        (square > 0.0).then(|| Sphere { center: middle + size * center, radius: size * square.sqrt() })
    }
}
