//! *Garden*: a walled garden with a path, a fountain, flower beds, bushes, trees and a lawn of single blades. 234 000 triangles.

use glam::{Vec2, Vec3};

use super::foliage::{Leaves, blade, blossom};
use super::lights::{self, Lamp};
use super::math::{Random, around, srgb};
use super::parts::{Open, Paint, Palette, Parts, Place, bezier};
use super::plants::{Tree, bush};
use super::{BuiltinOptions, Composition};
use crate::Scene;

/// What the lawn's blades fill up to.
const TRIANGLES: usize = 234_000;

/// Half the size of the garden in x and z.
const HALF: Vec2 = Vec2::new(10.0, 14.0);

struct Paints {
    earth: Paint,
    soil: Paint,
    flags: [Paint; 3],
    stones: [Paint; 4],
    coping: Paint,
    marble: Paint,
    water: Paint,
    bark: Paint,
    shade: Paint,
    foliage: [Paint; 3],
    box_tree: [Paint; 3],
    silver: [Paint; 3],
    ivy: [Paint; 3],
    grass: [Paint; 4],
    flowers: [Paint; 5],
}

/// A flower bed: an ellipse of soil with its middle and half-axes in x and z.
struct Bed {
    center: Vec2,
    radii: Vec2,
}

const fn bed(x: f32, z: f32, rx: f32, rz: f32) -> Bed {
    Bed { center: Vec2::new(x, z), radii: Vec2::new(rx, rz) }
}

/// The first four lie in the picture.
const BEDS: [Bed; 8] = [
    bed(-2.0, -7.4, 1.1, 1.5),
    bed(2.5, -7.8, 1.1, 1.9),
    bed(-2.9, -12.0, 2.3, 1.3),
    bed(3.2, -12.2, 2.1, 1.2),
    bed(-6.4, -3.0, 1.6, 2.6),
    bed(6.2, 1.5, 1.7, 3.0),
    bed(-5.6, 7.6, 2.0, 2.4),
    bed(3.6, 10.4, 3.0, 1.6),
];

/// Where the fountain stands.
const FOUNTAIN: Vec2 = Vec2::new(0.1, -10.4);

/// The scene *Garden*: 234 000 triangles, 1 light, 20 × 6 × 28 units. The thesis steps its light mesh by h = 0.1; its
/// appendix lights the scene with 3 lights.
pub fn garden(options: &BuiltinOptions) -> Scene {
    let mut palette = Palette::default();
    let paints = paints(&mut palette);
    let mut parts = Parts::default();
    let mut random = Random::new(234_000);
    let cells = [20, 28];
    parts.terrain(-HALF, HALF, cells, |_, _| 0.0, |_, _| paints.earth);
    walls(&mut parts, &mut random, &paints);
    ivy(&mut parts, &mut random, &paints);
    path(&mut parts, &mut random, &paints);
    parts.put(Place::at(FOUNTAIN.x, 0.0, FOUNTAIN.y), |parts| fountain(parts, &paints));
    for (index, bed) in BEDS.iter().enumerate() {
        plant_bed(&mut parts, &mut random, bed, index, &paints);
    }
    trees(&mut parts, &mut random, &paints);
    bushes(&mut parts, &mut random, &paints);
    lawn(&mut parts, &mut random, &paints);
    Composition {
        name: "garden",
        mesh: parts.finish(),
        palette,
        lights: lights(options),
        eye: Vec3::new(0.75, 2.15, -1.7),
        target: Vec3::new(0.0, 0.45, -8.0),
        vfov: 40.0,
        ambient: Vec3::new(0.16, 0.17, 0.2),
        sky: srgb(0xb4d6ee),
    }
    .finish()
}

fn lights(options: &BuiltinOptions) -> Vec<crate::Light> {
    let lamps = [
        Lamp { position: Vec3::new(-8.0, 13.0, -1.5), share: 0.62, tint: Vec3::new(1.0, 0.96, 0.87) },
        Lamp { position: Vec3::new(8.0, 10.0, -2.0), share: 0.22, tint: Vec3::new(0.9, 0.95, 1.0) },
        Lamp { position: Vec3::new(1.0, 12.0, 6.0), share: 0.16, tint: Vec3::ONE },
    ];
    lights::place(&lamps, Vec3::new(0.0, 0.0, -8.5), 1.05, options.lights_or(1), options.spread_or(0.5))
}

fn paints(palette: &mut Palette) -> Paints {
    Paints {
        earth: palette.matt("earth", srgb(0x748c48)),
        soil: palette.matt("soil", srgb(0x6e5138)),
        flags: [0xcdc4b2, 0xbdb3a1, 0xd8cfbd].map(|hex| palette.matt("flagstone", srgb(hex))),
        stones: [0xc4a98a, 0xb3967a, 0xcdb79b, 0xa98e77].map(|hex| palette.matt("stone", srgb(hex))),
        coping: palette.matt("coping", srgb(0xd6cbb8)),
        marble: palette.glossy("marble", srgb(0xe9e4d8), 0.12, 30.0),
        water: palette.glossy("water", srgb(0x5fa7b8), 0.4, 60.0),
        bark: palette.matt("bark", srgb(0x80644c)),
        shade: palette.matt("crown shade", srgb(0x3f6630)),
        foliage: [0x6ea043, 0x82b550, 0x5c8c3c].map(|hex| palette.matt("leaf", srgb(hex))),
        box_tree: [0x4e8546, 0x5f9950, 0x41743f].map(|hex| palette.matt("box leaf", srgb(hex))),
        silver: [0x9db592, 0x87a583, 0xb1c5a4].map(|hex| palette.matt("silver leaf", srgb(hex))),
        ivy: [0x3f7a3c, 0x4f8d45, 0x6aa351].map(|hex| palette.matt("ivy", srgb(hex))),
        grass: [0x86b24a, 0x97c256, 0x75a244, 0xa8cc66].map(|hex| palette.matt("grass", srgb(hex))),
        flowers: [0xe2557c, 0xf4c534, 0x8a66c8, 0xf6f0e4, 0xe8743b].map(|hex| palette.matt("petal", srgb(hex))),
    }
}

/// Four walls of rough blocks about a core of mortar.
fn walls(parts: &mut Parts, random: &mut Random, paints: &Paints) {
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

/// Ivy that climbs the rear wall in four fans.
fn ivy(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    const FANS: [[f32; 3]; 4] = [[-3.6, 1.7, 2.9], [1.0, 1.1, 2.5], [3.9, 1.3, 3.0], [-8.0, 1.4, 2.8]];
    let leaves = Leaves { length: 0.13, width: 0.11, paints: &paints.ivy };
    for [middle, reach, height] in FANS {
        for _ in 0..1500 {
            let rise = random.unit();
            let spread = random.within(-1.0, 1.0) * reach * (0.35 + 0.65 * around(0.42 * rise).y);
            let ragged = height * rise * random.within(0.8, 1.0);
            let stalk = Vec3::new(middle + spread * random.unit(), ragged, -HALF.y + random.within(0.36, 0.46));
            let along = Vec3::new(random.within(-0.8, 0.8), random.within(-1.0, 0.2), random.within(0.25, 0.9));
            leaves.grow(parts, random, stalk, along);
        }
    }
}

/// Points along the middle of the path, a flagstone apart, from behind the camera to the fountain.
fn path_points() -> Vec<Vec2> {
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

/// Irregular flagstones, two abreast, and a ring of them about the fountain.
fn path(parts: &mut Parts, random: &mut Random, paints: &Paints) {
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
fn fountain(parts: &mut Parts, paints: &Paints) {
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

/// A mound of soil, its stone edging, and its flowers.
fn plant_bed(parts: &mut Parts, random: &mut Random, bed: &Bed, index: usize, paints: &Paints) {
    let center = Vec3::new(bed.center.x, -0.02, bed.center.y);
    parts.lump(center, Vec3::new(bed.radii.x, 0.16, bed.radii.y), 12, || random.within(0.96, 1.0), paints.soil);
    let stones = (21.0 * (bed.radii.x + bed.radii.y)) as usize / 2 * 2;
    for stone in 0..stones {
        let spot = bed.center + bed.radii * around(stone as f32 / stones as f32);
        let radii = Vec3::new(random.within(0.1, 0.15), random.within(0.07, 0.11), random.within(0.1, 0.15));
        let paint = random.pick(&paints.stones);
        parts.lump(Vec3::new(spot.x, 0.03, spot.y), radii, 3, || random.within(0.85, 1.1), paint);
    }
    let count = (if index < 4 { 62.0 } else { 22.0 } * bed.radii.x * bed.radii.y) as usize;
    for _ in 0..count {
        let spot = bed.center + bed.radii * random.disk() * 0.86;
        let patch = around(0.11 * spot.x + 0.13 * index as f32) + around(0.17 * spot.y);
        let kind = (index + (2.0 + patch.x + patch.y) as usize) % 5;
        flower(parts, random, Vec3::new(spot.x, 0.08, spot.y), paints.flowers[kind], paints);
    }
}

/// A stem with leaves and a double blossom.
fn flower(parts: &mut Parts, random: &mut Random, foot: Vec3, petals: Paint, paints: &Paints) {
    let height = random.within(0.22, 0.46);
    let lean = 0.12 * random.disk();
    blade(parts, foot, height, 0.018, lean, around(random.unit()), paints.box_tree[1]);
    let leaves = Leaves { length: 0.17, width: 0.055, paints: &paints.foliage };
    for _ in 0..6 {
        let along = random.direction() + 0.5 * Vec3::Y;
        let stalk = foot + Vec3::Y * (height * random.within(0.05, 0.6));
        leaves.grow(parts, random, stalk, along);
    }
    let head = foot + Vec3::new(lean.x, height, lean.y);
    let up = Vec3::new(random.within(-0.5, 0.5), 1.0, random.within(0.0, 0.9));
    let radius = random.within(0.05, 0.075);
    blossom(parts, head, up, radius, 7, petals);
    blossom(parts, head + 0.012 * up.normalize(), up, 0.5 * radius, 5, paints.flowers[1]);
}

fn trees(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    const TREES: [(f32, f32, f32, usize); 7] = [
        (-3.1, -12.0, 5.4, 10_000),
        (3.3, -12.3, 5.0, 10_000),
        (-4.6, -5.6, 5.9, 7_000),
        (6.8, -8.0, 5.2, 3_000),
        (-7.0, 3.0, 5.6, 3_000),
        (6.4, 6.5, 5.4, 3_000),
        (-2.0, 10.5, 5.0, 3_000),
    ];
    for (x, z, height, leaf_count) in TREES {
        let leaves = Leaves { length: 0.14, width: 0.085, paints: &paints.foliage };
        let tree = Tree {
            height,
            crown_from: 0.3,
            crown_radius: 0.27,
            lumps: 9,
            leaf_count,
            leaves: &leaves,
            bark: paints.bark,
            shade: paints.shade,
        };
        parts.put(Place::at(x, 0.0, z).turned(360.0 * random.unit()), |parts| tree.grow(parts, random));
    }
}

fn bushes(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    const BUSHES: [(f32, f32, f32, usize); 14] = [
        (-1.75, -8.9, 0.42, 1_300),
        (1.95, -9.6, 0.46, 1_400),
        (-1.5, -12.4, 0.62, 1_900),
        (1.7, -12.7, 0.6, 1_900),
        (-4.4, -12.3, 0.7, 1_900),
        (4.6, -12.5, 0.66, 1_900),
        (-2.75, -6.9, 0.38, 1_100),
        (3.15, -7.1, 0.44, 1_200),
        (0.2, -13.1, 0.5, 1_400),
        (-6.6, -2.6, 0.8, 900),
        (6.3, 1.0, 0.8, 900),
        (-5.8, 7.4, 0.8, 900),
        (3.2, 10.6, 0.8, 900),
        (4.8, 10.2, 0.7, 800),
    ];
    for (index, (x, z, radius, count)) in BUSHES.into_iter().enumerate() {
        let paints_of = if index % 3 == 1 { &paints.silver } else { &paints.box_tree };
        let leaves = Leaves { length: 0.085, width: 0.05, paints: paints_of };
        let radii = Vec3::new(radius, 0.92 * radius, radius);
        let shade = if index % 3 == 1 { paints.silver[1] } else { paints.shade };
        parts.put(Place::at(x, 0.02, z), |parts| bush(parts, random, radii, &leaves, count, shade));
    }
}

/// Blades of grass, most of them before the camera, until the count of triangles is reached.
fn lawn(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    let steps = path_points();
    while parts.count() + 3 <= TRIANGLES {
        let spot = if random.unit() < 0.86 {
            Vec2::new(random.within(-4.6, 4.6), -4.3 - 9.1 * random.unit() * random.within(0.4, 1.0))
        } else {
            HALF * Vec2::new(random.within(-0.96, 0.96), random.within(-0.97, 0.97))
        };
        if !grows_grass(spot, &steps) {
            continue;
        }
        let height = random.within(0.05, 0.12);
        let root = Vec3::new(spot.x, -0.005, spot.y);
        let paint = random.pick(&paints.grass);
        blade(parts, root, height, random.within(0.012, 0.02), 0.06 * random.disk(), around(random.unit()), paint);
    }
}

fn grows_grass(spot: Vec2, path: &[Vec2]) -> bool {
    let on_bed = BEDS.iter().any(|bed| ((spot - bed.center) / (bed.radii + 0.06)).length() < 1.0);
    let on_path = path.iter().any(|step| ((spot - *step) * Vec2::new(1.0, 1.4)).length() < 0.52);
    !on_bed && !on_path && spot.distance(FOUNTAIN) > 1.3
}
