//! *Garden*: a walled garden with a path, a fountain, flower beds, bushes, trees and a lawn of single blades. 234 000 triangles.

mod planting;
mod stonework;

use glam::{Vec2, Vec3};

use super::lights::{self, Lamp};
use super::math::{Random, srgb};
use super::parts::{Paint, Palette, Parts, Place};
use super::{BuiltinOptions, Composition};
use crate::Scene;

/// Number of triangles up to which the lawn is filled with blades of grass.
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

/// A flower bed: an ellipse of soil with its centre and half-axes in x and z.
struct Bed {
    center: Vec2,
    radii: Vec2,
}

const fn bed(x: f32, z: f32, rx: f32, rz: f32) -> Bed {
    Bed { center: Vec2::new(x, z), radii: Vec2::new(rx, rz) }
}

/// The first four are visible in the image.
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

/// Position of the fountain.
const FOUNTAIN: Vec2 = Vec2::new(0.1, -10.4);

/// The scene *Garden*: 234 000 triangles, 1 light, 20 × 6 × 28 units. The thesis uses the light-mesh step h = 0.1; its appendix
/// lights the scene with 3 lights.
pub fn garden(options: &BuiltinOptions) -> Scene {
    let mut palette = Palette::default();
    let paints = paints(&mut palette);
    let mut parts = Parts::default();
    let mut random = Random::new(234_000);
    let cells = [20, 28];
    parts.object("ground");
    parts.terrain(-HALF, HALF, cells, |_, _| 0.0, |_, _| paints.earth);
    parts.object("walls");
    stonework::walls(&mut parts, &mut random, &paints);
    parts.object("ivy");
    planting::ivy(&mut parts, &mut random, &paints);
    parts.object("path");
    stonework::path(&mut parts, &mut random, &paints);
    parts.object("fountain");
    parts.put(Place::at(FOUNTAIN.x, 0.0, FOUNTAIN.y), |parts| stonework::fountain(parts, &paints));
    for (index, bed) in BEDS.iter().enumerate() {
        parts.object(&format!("bed {}", index + 1));
        planting::plant_bed(&mut parts, &mut random, bed, index, &paints);
    }
    parts.object("trees");
    planting::trees(&mut parts, &mut random, &paints);
    parts.object("bushes");
    planting::bushes(&mut parts, &mut random, &paints);
    parts.object("lawn");
    planting::lawn(&mut parts, &mut random, &paints);
    Composition {
        name: "garden",
        mesh: parts.finish(),
        palette,
        lights: lights(options),
        eye: Vec3::new(0.75, 2.15, -1.7),
        target: Vec3::new(0.0, 0.38, -8.0),
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
