//! *Garden*: a walled garden with a path, a fountain, flower beds, bushes, trees and a lawn of single blades. 234 000 triangles.

mod plan;
mod planting;
mod stonework;

use glam::Vec3;

use self::plan::{BEDS, FOUNTAIN, HALF, paints};
use super::composition::Composition;
use super::lights::{self, Lamp};
use super::math::{Random, srgb};
use super::options::BuiltinOptions;
use super::parts::{Palette, Parts, Place};
use crate::{Light, Scene};

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

fn lights(options: &BuiltinOptions) -> Vec<Light> {
    let lamps = [
        Lamp { position: Vec3::new(-8.0, 13.0, -1.5), share: 0.62, tint: Vec3::new(1.0, 0.96, 0.87) },
        Lamp { position: Vec3::new(8.0, 10.0, -2.0), share: 0.22, tint: Vec3::new(0.9, 0.95, 1.0) },
        Lamp { position: Vec3::new(1.0, 12.0, 6.0), share: 0.16, tint: Vec3::ONE },
    ];
    lights::place(&lamps, Vec3::new(0.0, 0.0, -8.5), 1.05, options.lights_or(1), options.spread_or(0.5))
}
