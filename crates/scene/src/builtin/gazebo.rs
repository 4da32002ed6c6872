//! *Gazebo*: a wooden pavilion on a lawn between clipped hedges. 300 triangles.

use glam::{Vec2, Vec3};

use super::composition::Composition;
use super::lights::{self, Lamp};
use super::math::{around, srgb};
use super::options::BuiltinOptions;
use super::parts::{Open, Paint, Palette, Parts, Place};
use crate::{Light, Scene};

struct Paints {
    lawn: Paint,
    hedge: Paint,
    shrub: Paint,
    path: Paint,
    stone: Paint,
    floor: Paint,
    timber: Paint,
    roof: Paint,
    gilt: Paint,
}

/// The pavilion has this many sides; one is the entrance.
const SIDES: u32 = 6;

/// Height of the floor above the lawn.
const FLOOR: f32 = 1.8;

/// Distance of the posts from the centre.
const POSTS: f32 = 7.2;

/// The scene *Gazebo*: 300 triangles, 3 lights, 30 × 20 × 40 units. The thesis uses the light-mesh step h = 2.
pub fn gazebo(options: &BuiltinOptions) -> Scene {
    let mut palette = Palette::default();
    let paints = paints(&mut palette);
    let mut parts = Parts::default();
    grounds(&mut parts, &paints);
    parts.object("pavilion");
    parts.put(Place::at(-0.3, 0.0, -3.0).turned(-74.0).scaled(0.9), |parts| pavilion(parts, &paints));
    Composition {
        name: "gazebo",
        mesh: parts.finish(),
        palette,
        lights: lights(options),
        eye: Vec3::new(4.0, 21.5, 46.5),
        target: Vec3::new(-0.2, 7.0, -3.0),
        vfov: 29.0,
        ambient: Vec3::new(0.15, 0.16, 0.18),
        sky: srgb(0xbcd9ee),
    }
    .finish()
}

fn lights(options: &BuiltinOptions) -> Vec<Light> {
    let lamps = [
        Lamp { position: Vec3::new(-15.0, 38.0, 34.0), share: 0.6, tint: Vec3::new(1.0, 0.96, 0.88) },
        Lamp { position: Vec3::new(17.0, 33.0, 40.0), share: 0.22, tint: Vec3::new(0.9, 0.95, 1.0) },
        Lamp { position: Vec3::new(5.0, 48.0, -6.0), share: 0.18, tint: Vec3::ONE },
    ];
    lights::place(&lamps, Vec3::ZERO, 1.25, options.lights_or(3), options.spread_or(1.6))
}

fn paints(palette: &mut Palette) -> Paints {
    Paints {
        lawn: palette.matt("lawn", srgb(0xa3c25c)),
        hedge: palette.matt("hedge", srgb(0x5f9150)),
        shrub: palette.matt("shrub", srgb(0x3f7a4a)),
        path: palette.matt("path", srgb(0xe0cfa6)),
        stone: palette.matt("stone", srgb(0xcfc7b8)),
        floor: palette.matt("floor", srgb(0xc79a68)),
        timber: palette.glossy("timber", srgb(0xf3ede1), 0.05, 30.0),
        roof: palette.matt("roof", srgb(0xbf5b40)),
        gilt: palette.glossy("gilt", srgb(0xe0b040), 0.4, 30.0),
    }
}

/// Lawn, path, hedges and two shrubs next to the entrance.
fn grounds(parts: &mut Parts, paints: &Paints) {
    let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z);
    parts.object("lawn");
    parts.polygon(&[corner(-15.0, 20.0), corner(15.0, 20.0), corner(15.0, -20.0), corner(-15.0, -20.0)], paints.lawn);
    parts.object("path");
    parts.put(Place::at(2.3, 0.0, 7.6).turned(16.0), |parts| {
        parts.cuboid(Vec3::new(-2.2, 0.0, -2.2), Vec3::new(2.2, 0.12, 12.3), Open::Bottom, paints.path);
    });
    parts.object("hedge");
    hedge(parts, paints.hedge);
    parts.object("shrubs");
    for (x, z) in [(-5.6, 8.0), (9.2, 4.4)] {
        let cone = [Vec2::new(1.5, 0.0), Vec2::new(0.0, 5.2)];
        parts.put(Place::at(x, 0.0, z), |parts| parts.lathe(&cone, 5, false, paints.shrub));
    }
}

/// A folding screen of 14 panels around three sides of the lawn.
fn hedge(parts: &mut Parts, paint: Paint) {
    const PLAN: [[f32; 2]; 15] = [
        [-15.0, 20.0],
        [-13.8, 12.0],
        [-15.0, 4.0],
        [-13.6, -4.0],
        [-15.0, -12.0],
        [-13.0, -18.4],
        [-7.5, -20.0],
        [0.0, -18.2],
        [7.5, -20.0],
        [13.0, -18.4],
        [15.0, -12.0],
        [13.6, -4.0],
        [15.0, 4.0],
        [13.8, 12.0],
        [15.0, 20.0],
    ];
    for pair in PLAN.windows(2) {
        let [a, b] = [0, 1].map(|end| Vec3::new(pair[end][0], 0.0, pair[end][1]));
        let up = Vec3::Y * 20.0;
        parts.polygon(&[a, b, b + up, a + up], paint);
    }
}

/// The pavilion around its own centre, with the entrance towards +Z.
fn pavilion(parts: &mut Parts, paints: &Paints) {
    let prism = |radius: f32, low: f32, high: f32| [Vec2::new(radius, low), Vec2::new(radius, high)];
    parts.lathe(&prism(10.0, 0.0, 0.9), SIDES, false, paints.stone);
    parts.disk(Vec3::Y * 0.9, 10.0, SIDES, true, paints.stone);
    parts.lathe(&prism(8.6, 0.9, FLOOR), SIDES, false, paints.stone);
    parts.disk(Vec3::Y * FLOOR, 8.6, SIDES, true, paints.floor);
    steps(parts, paints.path);
    for side in 0..SIDES {
        post(parts, corner(side, POSTS), paints.timber);
    }
    for side in 1..SIDES {
        railing(parts, corner(side - 1, POSTS), corner(side, POSTS), paints.timber);
    }
    roof(parts, paints);
}

/// Corner `side` at `radius`; the entrance is between the last corner and the first.
fn corner(side: u32, radius: f32) -> Vec3 {
    let circle = around((side as f32 + 0.5) / SIDES as f32) * radius;
    Vec3::new(circle.x, 0.0, circle.y)
}

/// Two steps from the lawn to the lower and the upper plinth.
fn steps(parts: &mut Parts, paint: Paint) {
    parts.cuboid(Vec3::new(8.5, 0.0, -2.6), Vec3::new(10.0, 0.45, 2.6), Open::Bottom, paint);
    parts.cuboid(Vec3::new(7.3, 0.9, -2.6), Vec3::new(8.3, 1.35, 2.6), Open::Bottom, paint);
}

fn post(parts: &mut Parts, foot: Vec3, paint: Paint) {
    let half = Vec3::new(0.45, 0.0, 0.45);
    let [low, high] = [FLOOR, 10.7].map(|height| foot + Vec3::Y * height);
    parts.cuboid(low - half, high + half, Open::TopAndBottom, paint);
}

/// A handrail on six slats.
fn railing(parts: &mut Parts, from: Vec3, to: Vec3, paint: Paint) {
    const SLATS: u32 = 6;
    let rail = Vec3::Y * (FLOOR + 2.7);
    parts.bar(from + rail, to + rail, 0.55, 0.4, paint);
    let along = (to - from).normalize() * 0.2;
    for slat in 0..SLATS {
        let middle = from + (to - from) * ((slat as f32 + 0.5) / SLATS as f32);
        let [low, high] = [FLOOR, FLOOR + 2.6].map(|height| middle + Vec3::Y * height);
        parts.polygon(&[low + along, low - along, high - along, high + along], paint);
    }
}

/// Lower roof with a fascia, lantern, upper roof, finial.
fn roof(parts: &mut Parts, paints: &Paints) {
    let fascia = [Vec2::new(9.4, 9.9), Vec2::new(9.4, 10.5)];
    parts.lathe(&fascia, SIDES, false, paints.timber);
    parts.lathe(&[Vec2::new(9.4, 10.5), Vec2::new(2.6, 14.4)], SIDES, false, paints.roof);
    parts.lathe(&[Vec2::new(2.4, 14.0), Vec2::new(2.4, 15.9)], SIDES, false, paints.timber);
    parts.lathe(&[Vec2::new(3.5, 15.7), Vec2::new(0.0, 18.4)], SIDES, false, paints.roof);
    let finial = [Vec2::new(0.0, 18.2), Vec2::new(0.45, 19.2), Vec2::new(0.0, 20.2)];
    parts.lathe(&finial, 4, false, paints.gilt);
}
