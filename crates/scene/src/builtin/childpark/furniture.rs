//! The surroundings of the playground: benches, lamps, a bin, the fence.

use glam::{Vec2, Vec3};

use super::paints::Paints;
use crate::builtin::parts::{Open, Paint, Parts};

/// A bench that faces +Z: slats on two cast feet.
pub(super) fn bench(parts: &mut Parts, paints: &Paints) {
    const HALF: f32 = 8.0;
    for x in [-6.2, 6.2] {
        parts.cuboid(Vec3::new(x - 0.4, 0.0, -1.6), Vec3::new(x + 0.4, 4.0, 2.0), Open::Bottom, paints.iron);
        parts.beam(Vec3::new(x, 3.6, -1.5), Vec3::new(x, 9.4, -3.1), 0.8, 0.6, paints.iron);
    }
    for slat in 0..4 {
        let z = -1.5 + 1.15 * slat as f32;
        parts.cuboid(Vec3::new(-HALF, 4.0, z - 0.45), Vec3::new(HALF, 4.5, z + 0.45), Open::Nothing, paints.plank);
    }
    for slat in 0..3 {
        let rise = 5.8 + 1.5 * slat as f32;
        let z = -1.65 - 0.276 * (rise - 5.0);
        parts.cuboid(Vec3::new(-HALF, rise, z), Vec3::new(HALF, rise + 1.05, z + 0.5), Open::Nothing, paints.plank);
    }
}

/// A lamp on a slender pole.
pub(super) fn lamp(parts: &mut Parts, paints: &Paints) {
    let pole = [(1.5, 0.0), (1.3, 1.6), (0.7, 2.2), (0.5, 24.0), (1.4, 25.0), (1.4, 25.5)];
    parts.lathe(&pole.map(|(radius, height)| Vec2::new(radius, height)), 10, false, paints.iron);
    parts.ball(Vec3::Y * 27.6, 2.4, 9, paints.white);
    let cap = [Vec2::new(2.3, 29.0), Vec2::new(0.0, 31.4)];
    parts.lathe(&cap, 10, false, paints.iron);
}

/// A litter bin.
pub(super) fn bin(parts: &mut Parts, paints: &Paints) {
    let profile = [(1.7, 0.0), (2.1, 6.0), (2.3, 6.0), (2.3, 6.7), (1.8, 6.7), (1.6, 3.0), (0.0, 3.0)];
    parts.lathe(&profile.map(|(radius, height)| Vec2::new(radius, height)), 12, false, paints.green);
}

/// A picket fence from `from` to `to`, both on the ground.
pub(super) fn fence(parts: &mut Parts, from: Vec3, to: Vec3, paints: &Paints) {
    const SPACING: f32 = 2.6;
    let length = (to - from).length();
    let along = (to - from) / length;
    let back = along.cross(Vec3::Y) * 0.55;
    for height in [2.4, 6.2] {
        let rise = Vec3::Y * height + back;
        parts.beam(from + rise, to + rise, 0.5, 0.9, paints.white);
    }
    let pickets = (length / SPACING) as usize;
    for index in 0..pickets {
        let foot = from + along * (length * (index as f32 + 0.5) / pickets as f32);
        picket(parts, foot, along, paints.white);
    }
}

/// A pointed board of 12 triangles, its width along `along`.
fn picket(parts: &mut Parts, foot: Vec3, along: Vec3, paint: Paint) {
    let outline = [(-0.75, 0.0), (0.75, 0.0), (0.75, 7.4), (0.0, 8.8), (-0.75, 7.4)];
    let depth = along.cross(Vec3::Y) * 0.29;
    let front = outline.map(|(x, y)| foot + along * x + Vec3::Y * y - depth);
    let rear = front.map(|corner| corner + 2.0 * depth);
    parts.polygon(&rear, paint);
    let mut turned = front;
    turned.reverse();
    parts.polygon(&turned, paint);
    for edge in 1..5 {
        let next = (edge + 1) % 5;
        parts.polygon(&[front[edge], front[next], rear[next], rear[edge]], paint);
    }
}
