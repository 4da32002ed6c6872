//! Walls, path and fountain.

use glam::{Vec2, Vec3};

use super::plan::{FOUNTAIN, HALF, Paints};
use crate::builtin::math::{Random, around};
use crate::builtin::parts::{Open, Parts, Place};
use crate::builtin::surfaces::bezier;

/// Four walls of rough blocks around a core of mortar.
pub(super) fn walls(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    for (x, z, degrees, half) in [
        (0.0, -HALF.y, 0.0, HALF.x),
        (0.0, HALF.y, 180.0, HALF.x),
        (-HALF.x, 0.0, 90.0, HALF.y),
        (HALF.x, 0.0, -90.0, HALF.y),
    ] {
        parts.put(Place::at(x, 0.0, z).turned(degrees), |parts| wall(parts, random, half, paints));
    }
}

/// A wall along X whose face looks towards +Z.
fn wall(parts: &mut Parts, random: &mut Random, half: f32, paints: &Paints) {
    const COURSES: u32 = 9;
    const COURSE: f32 = 0.33;
    const JOINT: f32 = 0.02;
    let top = COURSES as f32 * COURSE;
    parts.cuboid(Vec3::new(-half, 0.0, 0.0), Vec3::new(half, top, 0.3), Open::Bottom, paints.soil);
    for course in 0..COURSES {
        let mut x = -half + 0.3;
        while x < half - 0.35 {
            let end = (x + random.within(0.42, 0.95)).min(half - 0.3);
            let low = Vec3::new(x + JOINT, course as f32 * COURSE + JOINT, 0.2);
            let high = Vec3::new(end - JOINT, (course + 1) as f32 * COURSE - JOINT, random.within(0.33, 0.38));
            parts.cuboid(low, high, Open::Nothing, random.pick(&paints.stones));
            x = end;
        }
    }
    let mut x = -half + 0.46;
    while x < half - 0.5 {
        let end = (x + 0.8).min(half - 0.46);
        let low = Vec3::new(x + 0.008, top, 0.03);
        parts.cuboid(low, Vec3::new(end - 0.008, top + 0.14, 0.45), Open::Nothing, paints.coping);
        x = end;
    }
}

/// Points along the middle of the path, one flagstone apart, from behind the camera to the fountain.
pub(super) fn path_points() -> Vec<Vec2> {
    const APART: f32 = 0.55;
    let control = [[2.4, 6.0], [1.8, -2.0], [-1.2, -6.0], [0.3, -9.2]].map(|[x, z]| Vec3::new(x, 0.0, z));
    let mut points: Vec<Vec2> = Vec::new();
    for step in bezier(control, 1025) {
        let spot = Vec2::new(step.x, step.z);
        if points.last().is_none_or(|last| last.distance(spot) >= APART) {
            points.push(spot);
        }
    }
    points
}

/// Irregular flagstones, two abreast, and a ring of them around the fountain.
pub(super) fn path(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    for middle in path_points() {
        for side in [-0.285, 0.285] {
            let x = middle.x + side + random.within(-0.01, 0.01);
            flagstone(parts, random, Vec2::new(x, middle.y + 0.5 * side), 0.28, paints);
        }
    }
    for stone in 0..16 {
        let spot = FOUNTAIN + around(stone as f32 / 16.0) * 1.12;
        flagstone(parts, random, spot, 0.21, paints);
    }
}

/// A low prism of seven uneven sides.
fn flagstone(parts: &mut Parts, random: &mut Random, spot: Vec2, radius: f32, paints: &Paints) {
    const SIDES: usize = 7;
    let height = random.within(0.035, 0.05);
    let paint = random.pick(&paints.flags);
    let corner = |side: usize, radius: f32, height: f32| {
        let flat = spot + around(-(side as f32) / SIDES as f32) * radius;
        Vec3::new(flat.x, height, flat.y)
    };
    let reach: Vec<f32> = (0..SIDES).map(|_| radius * random.within(0.82, 1.0)).collect();
    let top: Vec<Vec3> = (0..SIDES).map(|side| corner(side, 0.93 * reach[side], height)).collect();
    let foot: Vec<Vec3> = (0..SIDES).map(|side| corner(side, reach[side], -0.01)).collect();
    parts.polygon(&top, paint);
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        parts.polygon(&[foot[side], foot[next], top[next], top[side]], paint);
    }
}

/// A basin, a foot and a bowl, both filled.
pub(super) fn fountain(parts: &mut Parts, paints: &Paints) {
    let points = |profile: &[(f32, f32)]| -> Vec<Vec2> { profile.iter().map(|&(r, y)| Vec2::new(r, y)).collect() };
    let basin =
        [(0.86, 0.0), (0.86, 0.1), (0.78, 0.12), (0.78, 0.34), (0.86, 0.36), (0.86, 0.44), (0.7, 0.44), (0.7, 0.2)];
    parts.lathe(&points(&basin), 32, false, paints.marble);
    parts.disk(Vec3::Y * 0.36, 0.7, 32, true, paints.water);
    let foot =
        [(0.2, 0.3), (0.19, 0.42), (0.1, 0.5), (0.08, 0.62), (0.12, 0.74), (0.08, 0.86), (0.1, 0.96), (0.2, 1.02)];
    parts.lathe(&points(&foot), 24, true, paints.marble);
    let bowl =
        [(0.14, 1.0), (0.3, 1.05), (0.42, 1.13), (0.47, 1.22), (0.5, 1.23), (0.5, 1.26), (0.44, 1.26), (0.4, 1.18)];
    parts.lathe(&points(&bowl), 28, false, paints.marble);
    parts.disk(Vec3::Y * 1.22, 0.43, 28, true, paints.water);
    let finial = [(0.06, 1.2), (0.05, 1.34), (0.11, 1.42), (0.12, 1.48), (0.07, 1.57), (0.02, 1.62), (0.0, 1.68)];
    parts.lathe(&points(&finial), 20, true, paints.marble);
}
