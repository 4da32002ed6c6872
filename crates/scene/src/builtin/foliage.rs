//! Leaves, blades of grass, and objects made of many of them.

use glam::{Vec2, Vec3};

use super::math::Random;
use super::parts::{Paint, Parts};

/// Size and colours of the leaves of a plant.
pub(super) struct Leaves<'a> {
    /// From stalk to tip.
    pub(super) length: f32,
    /// Width at the middle.
    pub(super) width: f32,
    /// Each leaf has one of these materials.
    pub(super) paints: &'a [Paint],
}

impl Leaves<'_> {
    /// One leaf of two triangles, folded along its midrib, that grows from `stalk` towards `along`.
    pub(super) fn grow(&self, parts: &mut Parts, random: &mut Random, stalk: Vec3, along: Vec3) {
        let along = along.normalize();
        let side = loop {
            let side = along.cross(random.direction());
            if side.length_squared() > 0.05 {
                break side.normalize();
            }
        };
        let fold = along.cross(side) * (0.18 * self.width);
        let scale = random.within(0.75, 1.25);
        let middle = stalk + along * (0.45 * self.length * scale) + fold;
        let half = side * (0.5 * self.width * scale);
        let tip = stalk + along * (self.length * scale);
        let [a, b, c, d] = [stalk, middle + half, tip, middle - half].map(|corner| parts.vertex(corner, Vec3::ZERO));
        let paint = random.pick(self.paints);
        parts.face([a, b, c], paint);
        parts.face([a, c, d], paint);
    }

    /// `count` leaves in the outer part of an ellipsoid, pointing outwards and a little down.
    pub(super) fn crown(&self, parts: &mut Parts, random: &mut Random, center: Vec3, radii: Vec3, count: usize) {
        for _ in 0..count {
            let direction = random.direction();
            let depth = 1.06 - 0.35 * random.unit() * random.unit();
            let along = direction / radii * radii.min_element() + 0.9 * random.direction() - 0.15 * Vec3::Y;
            let along = if along.length_squared() > 0.01 { along } else { direction };
            self.grow(parts, random, center + radii * direction * depth, along);
        }
    }
}

/// A blade of grass of three triangles that leans to `lean` (x, z) at its tip; `turn` is the direction of its width.
pub(super) fn blade(parts: &mut Parts, root: Vec3, height: f32, width: f32, lean: Vec2, turn: Vec2, paint: Paint) {
    let half = Vec3::new(turn.x, 0.0, turn.y) * (0.5 * width);
    let lean = Vec3::new(lean.x, 0.0, lean.y);
    let middle = root + Vec3::Y * (0.6 * height) + 0.35 * lean;
    let tip = root + Vec3::Y * height + lean;
    let [a, b, c, d, e] = [root - half, root + half, middle + 0.7 * half, middle - 0.7 * half, tip]
        .map(|corner| parts.vertex(corner, Vec3::ZERO));
    parts.face([a, b, c], paint);
    parts.face([a, c, d], paint);
    parts.face([d, c, e], paint);
}

/// A flower of `petals` triangles about a centre that faces `up`; the petals rise a little.
pub(super) fn blossom(parts: &mut Parts, center: Vec3, up: Vec3, radius: f32, petals: u32, paint: Paint) {
    let up = up.normalize();
    let helper = if up.x.abs() > 0.7 { Vec3::Z } else { Vec3::X };
    let side = up.cross(helper).normalize();
    let across = up.cross(side);
    let at = |step: f32, length: f32| {
        let circle = super::math::around(step / petals as f32) * length;
        center + side * circle.x + across * circle.y
    };
    for petal in 0..petals {
        let step = petal as f32;
        let rise = up * (0.35 * radius);
        let left = at(step - 0.42, 0.8 * radius) + rise;
        let right = at(step + 0.42, 0.8 * radius) + rise;
        let [a, b, c] = [center, left, right].map(|corner| parts.vertex(corner, Vec3::ZERO));
        parts.face([a, b, c], paint);
    }
}
