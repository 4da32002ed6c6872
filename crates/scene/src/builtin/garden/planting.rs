//! Everything that grows: ivy, flower beds, trees, bushes and the lawn.

use glam::{Vec2, Vec3};

use super::plan::{BEDS, Bed, FOUNTAIN, HALF, Paints, TRIANGLES};
use super::stonework::path_points;
use crate::builtin::foliage::{Leaves, blade, blossom};
use crate::builtin::math::{Random, around};
use crate::builtin::parts::{Paint, Parts, Place};
use crate::builtin::plants::{Tree, bush};

/// Ivy that climbs the rear wall in four fans.
pub(super) fn ivy(parts: &mut Parts, random: &mut Random, paints: &Paints) {
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

/// A mound of soil, its stone edging, and its flowers.
pub(super) fn plant_bed(parts: &mut Parts, random: &mut Random, bed: &Bed, index: usize, paints: &Paints) {
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

pub(super) fn trees(parts: &mut Parts, random: &mut Random, paints: &Paints) {
    const TREES: [(f32, f32, f32, usize); 7] = [
        (-3.1, -12.0, 5.4, 10_000),
        (3.3, -12.3, 5.0, 10_000),
        (-4.4, -3.6, 5.9, 7_000),
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

pub(super) fn bushes(parts: &mut Parts, random: &mut Random, paints: &Paints) {
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

/// Blades of grass, most of them in front of the camera, until the number of triangles is reached.
pub(super) fn lawn(parts: &mut Parts, random: &mut Random, paints: &Paints) {
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
