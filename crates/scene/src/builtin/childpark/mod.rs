//! *Childpark*: a playground in a clearing below a wooded hill. 27 000 triangles.

mod equipment;
mod furniture;
mod paints;

use glam::{Vec2, Vec3};

use self::paints::{Paints, paints};
use super::composition::Composition;
use super::foliage::{Leaves, blade, blossom};
use super::lights::{self, Lamp};
use super::math::{Random, around, ease, srgb};
use super::options::BuiltinOptions;
use super::parts::{Paint, Palette, Parts, Place};
use super::plants::{Tree, bush};
use super::surfaces::bezier;
use crate::{Light, Scene};

/// Number of triangles up to which the meadow is filled with blades of grass.
const TRIANGLES: usize = 27_000;

/// The scene *Childpark*: 27 000 triangles, 2 lights, 160 × 120 × 140 units. The thesis uses the light-mesh step h = 1.
pub fn childpark(options: &BuiltinOptions) -> Scene {
    let mut palette = Palette::default();
    let paints = paints(&mut palette);
    let mut parts = Parts::default();
    let mut random = Random::new(27_000);
    grounds(&mut parts, &paints);
    playground(&mut parts, &paints);
    parts.object("surroundings");
    surroundings(&mut parts, &paints);
    parts.object("wood");
    wood(&mut parts, &mut random, &paints);
    parts.object("bushes");
    bushes(&mut parts, &mut random, &paints);
    parts.object("meadow");
    meadow(&mut parts, &mut random, &paints);
    Composition {
        name: "childpark",
        mesh: parts.finish(),
        palette,
        lights: lights(options),
        eye: Vec3::new(13.0, 68.0, 114.0),
        target: Vec3::new(0.0, 11.0, 0.0),
        vfov: 50.0,
        ambient: Vec3::new(0.15, 0.16, 0.19),
        sky: srgb(0xaed4f0),
    }
    .finish()
}

fn lights(options: &BuiltinOptions) -> Vec<Light> {
    let lamps = [
        Lamp { position: Vec3::new(-70.0, 150.0, 78.0), share: 0.74, tint: Vec3::new(1.0, 0.95, 0.85) },
        Lamp { position: Vec3::new(85.0, 110.0, 90.0), share: 0.26, tint: Vec3::new(0.88, 0.94, 1.0) },
    ];
    lights::place(&lamps, Vec3::ZERO, 1.15, options.lights_or(2), options.spread_or(6.0))
}

/// The lawn is level where children play and rises to a hill behind.
fn ground_height(x: f32, z: f32) -> f32 {
    let hill = ease(-28.0, -74.0, z) * (36.0 + 3.0 * around(0.011 * x + 0.2).y);
    hill + ease(60.0, 84.0, x.abs()) * ease(40.0, 0.0, z) * 14.0
}

fn grounds(parts: &mut Parts, paints: &Paints) {
    parts.object("lawn");
    parts.terrain(Vec2::new(-80.0, -70.0), Vec2::new(80.0, 70.0), [24, 20], ground_height, |_, _| paints.lawn);
    parts.object("mats");
    for (x, z, radius) in [(10.0, 26.0, 17.0), (-27.0, 28.0, 19.0)] {
        parts.put(Place::at(x, 0.0, z), |parts| mat(parts, radius, paints.rubber));
    }
    parts.object("path");
    path(parts, paints.path);
}

/// A round mat, 0.25 above the lawn.
fn mat(parts: &mut Parts, radius: f32, paint: Paint) {
    let edge = [Vec2::new(radius + 0.3, -0.1), Vec2::new(radius, 0.25)];
    parts.lathe(&edge, 40, false, paint);
    parts.disk(Vec3::Y * 0.25, radius, 40, true, paint);
}

/// A winding path of gravel across the foreground, 0.15 above the lawn.
fn path(parts: &mut Parts, paint: Paint) {
    let control = [[-80.0, 44.0], [-30.0, 70.0], [30.0, 58.0], [80.0, 50.0]].map(|[x, z]| Vec3::new(x, 0.15, z));
    let line = bezier(control, 25);
    let row = |index: usize| {
        let along = line[(index + 1).min(24)] - line[index.saturating_sub(1)];
        let side = Vec3::Y.cross(along).normalize() * 4.5;
        let down = Vec3::new(0.0, 0.3, 0.0);
        let edge = side * 1.06 - down;
        [line[index] + edge, line[index] + side, line[index] - side, line[index] - edge - 2.0 * down]
            .map(|point| (point, Vec3::ZERO))
            .to_vec()
    };
    let rows: Vec<_> = (0..25).map(row).collect();
    parts.sheet(&rows, paint);
}

fn playground(parts: &mut Parts, paints: &Paints) {
    parts.object("slide");
    parts.put(Place::at(-33.0, 0.0, -13.0).turned(40.0), |parts| equipment::slide(parts, paints));
    parts.object("swings");
    parts.put(Place::at(32.0, 0.0, -12.0).turned(-18.0), |parts| equipment::swings(parts, paints));
    parts.object("climbing frame");
    parts.put(Place::at(-27.0, 0.25, 28.0).turned(9.0), |parts| equipment::climbing_frame(parts, paints));
    parts.object("carousel");
    parts.put(Place::at(10.0, 0.25, 26.0), |parts| equipment::carousel(parts, paints));
    parts.object("seesaw");
    parts.put(Place::at(2.0, 0.0, -8.0).turned(68.0), |parts| equipment::seesaw(parts, paints));
    parts.object("sandpit");
    parts.put(Place::at(44.0, 0.0, 31.0).turned(-16.0), |parts| equipment::sandpit(parts, paints));
}

fn surroundings(parts: &mut Parts, paints: &Paints) {
    for (x, z, degrees) in [(-6.0, -24.0, 4.0), (15.0, -24.5, -4.0), (58.0, 8.0, -70.0), (-58.0, 2.0, 80.0)] {
        parts.put(Place::at(x, 0.0, z).turned(degrees), |parts| furniture::bench(parts, paints));
    }
    for (x, z) in [(4.5, -25.0), (58.0, 21.0), (-60.0, 40.0)] {
        parts.put(Place::at(x, 0.0, z), |parts| furniture::lamp(parts, paints));
    }
    parts.put(Place::at(28.0, 0.0, -24.0), |parts| furniture::bin(parts, paints));
    let corner = |x: f32, z: f32| Vec3::new(x, -0.2, z);
    let corners = [corner(-66.0, 60.0), corner(-66.0, -29.0), corner(66.0, -29.0), corner(66.0, 60.0)];
    for pair in corners.windows(2) {
        furniture::fence(parts, pair[0], pair[1], paints);
    }
}

/// Trees on the hill that close the view, and a few next to the playground.
fn wood(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    const TREES: [[f32; 3]; 16] = [
        [-60.0, -50.0, 90.0],
        [-39.0, -50.0, 92.0],
        [-20.0, -49.0, 88.0],
        [0.0, -49.5, 98.0],
        [20.0, -49.0, 90.0],
        [40.0, -50.0, 93.0],
        [58.0, -50.0, 84.0],
        [-61.0, -38.0, 62.0],
        [-33.0, -41.0, 56.0],
        [-11.0, -40.0, 60.0],
        [11.0, -41.0, 54.0],
        [32.0, -40.0, 62.0],
        [60.0, -36.0, 60.0],
        [-63.0, 10.0, 60.0],
        [-66.0, -16.0, 54.0],
        [65.0, -12.0, 58.0],
    ];
    for (index, [x, z, height]) in TREES.into_iter().enumerate() {
        let leaves =
            Leaves { length: 5.8, width: 3.8, paints: if index % 5 == 3 { &paints.autumn } else { &paints.foliage } };
        let tree = Tree {
            height,
            crown_from: if z > 0.0 { 0.42 } else { 0.2 },
            crown_radius: 0.26,
            lumps: 5,
            leaf_count: 232,
            leaves: &leaves,
            bark: paints.bark,
            shade: if index % 5 == 3 { paints.autumn[2] } else { paints.shade },
        };
        let place = Place::at(x, ground_height(x, z), z).turned(360.0 * random.unit());
        parts.put(place, |parts| tree.grow(parts, random));
    }
}

fn bushes(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    let leaves = Leaves { length: 2.6, width: 1.8, paints: &paints.foliage };
    for index in 0..13 {
        let x = -61.0 + 10.1 * index as f32 + random.within(-2.5, 2.5);
        let z = -34.0 + random.within(-1.5, 1.0);
        let size = random.within(5.0, 7.5);
        let place = Place::at(x, ground_height(x, z) - 0.5, z);
        parts.put(place, |parts| bush(parts, random, Vec3::new(size, 0.95 * size, size), &leaves, 75, paints.shade));
    }
}

/// Tufts of grass and flowers where nobody walks.
fn meadow(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    let flowers = [paints.white, paints.yellow, paints.red];
    for index in 0.. {
        let left = TRIANGLES.saturating_sub(parts.count());
        if left < 25 {
            break;
        }
        let (x, z) = (random.within(-64.0, 64.0), random.within(-27.0, 60.0));
        if !is_wild(x, z) {
            continue;
        }
        let foot = Vec3::new(x, ground_height(x, z), z);
        for _ in 0..5 {
            let spread = random.disk();
            let root = foot + 1.1 * Vec3::new(spread.x, 0.0, spread.y);
            let turn = around(random.unit());
            let paint = random.pick(&paints.grass);
            blade(parts, root, random.within(1.6, 3.2), 0.55, 0.9 * random.disk(), turn, paint);
        }
        if index % 4 == 0 {
            let head = foot + Vec3::Y * random.within(1.8, 2.8);
            blossom(parts, head, Vec3::new(0.2, 1.0, 0.4), 0.9, 6, random.pick(&flowers));
        }
    }
}

/// Whether (x, z) is away from the places where children run.
fn is_wild(x: f32, z: f32) -> bool {
    let spot = Vec2::new(x, z);
    let clear = |center: [f32; 2], radius: f32| spot.distance(Vec2::from(center)) > radius;
    let trodden = [([10.0, 26.0], 19.0), ([-27.0, 28.0], 21.0), ([44.0, 31.0], 19.0), ([-28.0, -4.0], 24.0)];
    let at_the_edge = z < 38.0 && (x.abs() > 48.0 || z < -18.0);
    at_the_edge && trodden.iter().all(|&(center, radius)| clear(center, radius))
}
