//! The playground equipment. Each piece is placed at its own origin on the ground; about 9 units are a metre.

use glam::{Vec2, Vec3};

use super::paints::Paints;
use crate::builtin::math::around;
use crate::builtin::parts::{Open, Paint, Parts, Place};
use crate::builtin::surfaces::bezier;

/// A tower with a roof, a ladder behind (−Z) and a chute in front (+Z).
pub(super) fn slide(parts: &mut Parts, paints: &Paints) {
    const DECK: f32 = 17.0;
    for (x, z) in [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)] {
        parts.cuboid(Vec3::new(x - 0.6, 0.0, z - 0.6), Vec3::new(x + 0.6, 29.0, z + 0.6), Open::Bottom, paints.timber);
    }
    for plank in 0..6 {
        let x = -5.9 + 2.0 * plank as f32;
        parts.cuboid(Vec3::new(x, DECK - 0.8, -6.0), Vec3::new(x + 1.8, DECK, 6.0), Open::Nothing, paints.plank);
    }
    for side in [-5.0, 5.0] {
        balustrade(parts, Vec3::new(side, DECK, -4.4), Vec3::new(side, DECK, 4.4), paints.blue);
    }
    let eaves = [Vec2::new(10.2, 28.0), Vec2::new(10.2, 28.8)];
    parts.lathe(&eaves, 4, false, paints.yellow);
    parts.lathe(&[Vec2::new(10.2, 28.8), Vec2::new(0.0, 37.0)], 4, false, paints.red);
    parts.ball(Vec3::Y * 37.3, 0.9, 5, paints.yellow);
    ladder(parts, Vec3::new(0.0, DECK, -6.2), Vec3::new(0.0, 0.0, -12.5), paints);
    chute(parts, Vec3::new(0.0, DECK + 2.4, 5.6), paints);
}

/// Upright boards under a handrail.
fn balustrade(parts: &mut Parts, from: Vec3, to: Vec3, paint: Paint) {
    const BOARDS: usize = 5;
    for board in 0..BOARDS {
        let foot = from + (to - from) * ((board as f32 + 0.5) / BOARDS as f32);
        let half = Vec3::new(0.25, 0.0, 0.7);
        parts.cuboid(foot - half, foot + half + Vec3::Y * 6.0, Open::Nothing, paint);
    }
    parts.beam(from + Vec3::Y * 6.4, to + Vec3::Y * 6.4, 1.0, 0.8, paint);
}

fn ladder(parts: &mut Parts, top: Vec3, foot: Vec3, paints: &Paints) {
    const RUNGS: usize = 7;
    let side = Vec3::X * 2.6;
    let handle = Vec3::new(0.0, 5.0, 0.9);
    for side in [side, -side] {
        parts.tube(&[foot + side, top + side, top + handle + side], |_| 0.45, 7, paints.steel);
    }
    for rung in 0..RUNGS {
        let middle = foot + (top - foot) * ((rung as f32 + 0.9) / RUNGS as f32);
        parts.rod(middle - side, middle + side, 0.38, 6, paints.red);
    }
}

/// A half-pipe between two round rims.
fn chute(parts: &mut Parts, top: Vec3, paints: &Paints) {
    const RADIUS: f32 = 3.0;
    const ARC: u32 = 8;
    let control = [Vec3::ZERO, Vec3::new(0.0, -1.0, 9.0), Vec3::new(0.0, -15.4, 16.0), Vec3::new(0.0, -15.6, 31.0)];
    let path: Vec<Vec3> = bezier(control, 16).into_iter().map(|point| top + point).collect();
    let last = path.len() - 1;
    let row = |index: usize| -> Vec<(Vec3, Vec3)> {
        let along = (path[(index + 1).min(last)] - path[index.saturating_sub(1)]).normalize();
        let up = along.cross(Vec3::X);
        let point = |step: u32| {
            let circle = around(1.0 - 0.5 * step as f32 / ARC as f32);
            let outward = Vec3::X * circle.x + up * circle.y;
            (path[index] + outward * RADIUS, -outward)
        };
        (0..=ARC).map(point).collect()
    };
    let rows: Vec<_> = (0..=last).map(row).collect();
    for edge in [0, ARC as usize] {
        let rim: Vec<Vec3> = rows.iter().map(|row| row[edge].0).collect();
        parts.tube(&rim, |_| 0.42, 6, paints.yellow);
    }
    parts.sheet(&rows, paints.chute);
    parts.rod(top + Vec3::new(0.0, -18.6, 30.0), top + Vec3::new(0.0, -22.0, 30.0), 0.6, 7, paints.steel);
}

/// A bar on two trestles with three swings, along X.
pub(super) fn swings(parts: &mut Parts, paints: &Paints) {
    const HEIGHT: f32 = 25.0;
    const HALF: f32 = 20.0;
    let bar = Vec3::Y * HEIGHT;
    parts.rod(bar - Vec3::X * (HALF + 1.0), bar + Vec3::X * (HALF + 1.0), 0.75, 8, paints.red);
    for x in [-HALF, HALF] {
        for z in [-8.0, 8.0] {
            parts.rod(Vec3::new(x * 1.1, 0.0, z), Vec3::new(x, HEIGHT, 0.0), 0.7, 8, paints.blue);
        }
        parts.rod(Vec3::new(x * 1.065, 9.0, -5.1), Vec3::new(x * 1.065, 9.0, 5.1), 0.45, 6, paints.blue);
    }
    for (x, turns, paint) in [(-12.0, 0.06, paints.yellow), (0.0, 0.0, paints.red), (12.0, -0.085, paints.yellow)] {
        swing(parts, Vec3::new(x, HEIGHT, 0.0), turns, paint, paints);
    }
}

/// A board on two chains that hang from `pivot`, swung out by `turns` of a circle.
fn swing(parts: &mut Parts, pivot: Vec3, turns: f32, paint: Paint, paints: &Paints) {
    const CHAIN: f32 = 20.0;
    let circle = around(turns);
    let down = Vec3::new(0.0, -circle.x, circle.y);
    let side = Vec3::X * 2.5;
    for side in [side, -side] {
        parts.rod(pivot + side, pivot + side + down * CHAIN, 0.16, 4, paints.steel);
    }
    let seat = pivot + down * (CHAIN + 0.2);
    parts.beam(seat - 1.3 * side, seat + 1.3 * side, 2.4, 0.6, paint);
}

/// A dome of pipes.
pub(super) fn climbing_frame(parts: &mut Parts, paints: &Paints) {
    const RADIUS: f32 = 15.0;
    const MERIDIANS: u32 = 10;
    const RINGS: u32 = 4;
    let node = |ring: u32, meridian: u32| {
        let rise = around(0.25 * ring as f32 / RINGS as f32);
        let circle = around((meridian as f32 + 0.5 * (ring % 2) as f32) / MERIDIANS as f32) * rise.x;
        Vec3::new(circle.x, rise.y, circle.y) * RADIUS
    };
    let apex = Vec3::Y * RADIUS;
    for meridian in 0..MERIDIANS {
        for ring in 0..RINGS {
            let here = node(ring, meridian);
            if ring > 0 {
                parts.rod(here, node(ring, meridian + 1), 0.36, 5, paints.yellow);
                parts.ball(here, 0.75, 3, paints.blue);
            }
            if ring + 1 == RINGS {
                parts.rod(here, apex, 0.36, 5, paints.red);
                continue;
            }
            let left = meridian + MERIDIANS - 1 + ring % 2;
            parts.rod(here, node(ring + 1, left), 0.36, 5, paints.red);
            parts.rod(here, node(ring + 1, left + 1), 0.36, 5, paints.red);
        }
    }
    parts.ball(apex, 1.0, 5, paints.blue);
}

/// A round platform of coloured wedges with hoops to hold on to.
pub(super) fn carousel(parts: &mut Parts, paints: &Paints) {
    const WEDGES: u32 = 12;
    const RADIUS: f32 = 11.5;
    const FLOOR: f32 = 2.6;
    let rim = |step: u32| {
        let circle = around(step as f32 / WEDGES as f32) * RADIUS;
        Vec3::new(circle.x, FLOOR, circle.y)
    };
    let colours = [paints.red, paints.white, paints.blue, paints.yellow];
    for wedge in 0..WEDGES {
        let [right, left] = [rim(wedge), rim(wedge + 1)];
        let bow = (0.5 * (right + left) - Vec3::Y * FLOOR).normalize() * RADIUS + Vec3::Y * FLOOR;
        parts.polygon(&[Vec3::Y * FLOOR, left, bow, right], colours[wedge as usize % 4]);
    }
    parts.put(Place::at(0.0, 0.0, 0.0).turned(-7.5), |parts| {
        let edge = [Vec2::new(RADIUS - 1.5, 0.9), Vec2::new(RADIUS, 1.4), Vec2::new(RADIUS, FLOOR)];
        parts.lathe(&edge, 2 * WEDGES, false, paints.steel);
    });
    parts.lathe(&[Vec2::new(3.0, 0.0), Vec2::new(2.6, 1.6)], 10, false, paints.steel);
    parts.rod(Vec3::Y * FLOOR, Vec3::Y * 10.6, 0.8, 10, paints.white);
    parts.ball(Vec3::Y * 11.0, 1.5, 6, paints.red);
    for hoop in 0..6 {
        let circle = around((hoop as f32 + 0.5) / 6.0);
        let outward = Vec3::new(circle.x, 0.0, circle.y);
        let at = |distance: f32, height: f32| outward * distance + Vec3::Y * height;
        let path = bezier([at(0.6, 9.4), at(7.0, 9.6), at(10.4, 8.6), at(10.2, FLOOR)], 8);
        parts.tube(&path, |_| 0.4, 6, paints.yellow);
    }
}

/// A plank on a block, one end down.
pub(super) fn seesaw(parts: &mut Parts, paints: &Paints) {
    let tilt = Vec3::new(14.0, 3.2, 0.0);
    let pivot = Vec3::Y * 5.2;
    parts.cuboid(Vec3::new(-1.3, 0.0, -1.6), Vec3::new(1.3, 4.6, 1.6), Open::Bottom, paints.steel);
    parts.beam(pivot - tilt, pivot + tilt, 2.6, 0.9, paints.red);
    for end in [-1.0, 1.0] {
        let seat = pivot + tilt * (0.86 * end) + Vec3::Y * 0.45;
        let grip = pivot + tilt * (0.66 * end) + Vec3::Y * 0.3;
        parts.lathe_at(seat, &[Vec2::new(1.9, 0.0), Vec2::new(1.9, 0.8), Vec2::new(0.0, 1.0)], 10, paints.yellow);
        parts.rod(grip, grip + Vec3::Y * 3.6, 0.3, 6, paints.steel);
        parts.rod(grip + Vec3::new(0.0, 3.6, -1.6), grip + Vec3::new(0.0, 3.6, 1.6), 0.34, 6, paints.blue);
    }
}

/// A square of sand in a timber frame, with two sand castles, a bucket and a ball.
pub(super) fn sandpit(parts: &mut Parts, paints: &Paints) {
    const HALF: f32 = 13.0;
    let lawn_to_rim = |x0: f32, z0: f32, x1: f32, z1: f32| (Vec3::new(x0, 0.0, z0), Vec3::new(x1, 2.0, z1));
    for (min, max) in [
        lawn_to_rim(-HALF, -HALF, HALF, -HALF + 1.8),
        lawn_to_rim(-HALF, HALF - 1.8, HALF, HALF),
        lawn_to_rim(-HALF, -HALF + 1.8, -HALF + 1.8, HALF - 1.8),
        lawn_to_rim(HALF - 1.8, -HALF + 1.8, HALF, HALF - 1.8),
    ] {
        parts.cuboid(min, max, Open::Bottom, paints.timber);
    }
    let inner = Vec2::splat(HALF - 1.7);
    let dune = |x: f32, z: f32| 1.0 + 0.35 * around(x * 0.045 + 0.1).y * around(z * 0.06).x;
    parts.terrain(-inner, inner, [8, 8], dune, |_, _| paints.sand);
    for (x, z, height) in [(-4.0, -3.0, 4.6), (-0.6, -5.4, 3.4)] {
        let castle = [(2.2, 0.5), (1.5, height - 0.8), (1.9, height - 0.8), (1.9, height), (0.0, height)];
        let profile = castle.map(|(radius, height)| Vec2::new(radius, height));
        parts.lathe_at(Vec3::new(x, 0.0, z), &profile, 12, paints.castle);
    }
    let bucket = [Vec2::new(1.0, 0.6), Vec2::new(1.4, 3.2), Vec2::new(1.1, 3.2), Vec2::new(0.0, 2.6)];
    parts.lathe_at(Vec3::new(5.4, 0.0, 4.0), &bucket, 12, paints.blue);
    parts.ball(Vec3::new(2.0, 3.2, 5.6), 2.1, 9, paints.red);
}
