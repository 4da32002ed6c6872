//! Baking: soft light and shadows become vertex colours, for viewers without shadows.
//!
//! `cargo run --release -p lightmesh-examples --bin bake [SCENE [MODEL]]`
#![allow(clippy::print_stdout, reason = "an example says what it wrote")]

use std::error::Error;

use lightmesh::glam::{DMat4, Vec3};
use lightmesh::render::Unobserved;
use lightmesh::scene::{Falloff, Geometry, Light, LightKind, MeshPart, SceneBuilder, Up};
use lightmesh::{Device, Mode, Renderer, Scene, Settings};

/// The longest edge of a triangle, as a share of the scene's diagonal: this limits how sharp shadows are.
const LONGEST_EDGE: f32 = 0.004;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_else(|| "builtin:gazebo".to_owned());
    let model = arguments.next().unwrap_or_else(|| "baked.glb".to_owned());

    let mut scene = Scene::open(&path)?;
    scene.complete(Up::of_file(path.as_ref()));
    let fine = Fine::new(&scene.geometry);

    // ANCHOR: visibility
    // 1. What does each vertex see of each light?
    let renderer = Renderer::new(Device::Auto)?;
    let settings = Settings::default().with_mode(Mode::Area).with_samples(64);
    let prepared = renderer.prepare(&scene, &settings, &Unobserved)?;
    let seen = renderer.visibility(&prepared, &fine.positions, &fine.normals, &settings, &Unobserved)?;
    // ANCHOR_END: visibility
    println!("{} vertices, {} lights: {:.2} s", seen.points(), seen.lights(), seen.stats.seconds.render);

    // 2. The light that arrives there multiplies the materials' colours.
    let ambient = scene.lights.ambient.unwrap_or(Vec3::splat(0.1));
    let arriving = |vertex: usize| -> Vec3 {
        let (position, normal) = (fine.positions[vertex], fine.normals[vertex]);
        let lights = scene.lights.iter().enumerate();
        lights.map(|(number, light)| seen.of(number, vertex) * arriving(light, position, normal)).sum()
    };
    let colors: Vec<Vec3> = (0..seen.points()).map(|vertex| ambient + arriving(vertex)).collect();

    // 3. The same model with these colours.
    let mut builder = SceneBuilder::new();
    for material in &scene.geometry.materials {
        builder.add_material(material.clone());
    }
    let (positions, normals, triangles) = (&*fine.positions, &*fine.normals, &*fine.triangles);
    let part = MeshPart { positions, normals, colors: &colors, triangles, ..MeshPart::default() };
    builder.add(part, &DMat4::from_translation(scene.geometry.origin), |triangle| fine.materials[triangle])?;
    builder.finish_scene(&scene.name).with_cameras(scene.cameras).export(&model)?;
    println!("{model}: {} triangles", fine.triangles.len());
    Ok(())
}

/// The light that would arrive at a surface if nothing were in between.
fn arriving(light: &Light, position: Vec3, normal: Vec3) -> Vec3 {
    let way = match light.kind {
        LightKind::Directional { direction, .. } => -direction,
        _ => light.position().unwrap_or_default() - position,
    };
    let falloff = if light.falloff == Falloff::InverseSquare { 1.0 / way.length_squared() } else { 1.0 };
    light.intensity * falloff * normal.dot(way.normalize_or_zero()).max(0.0)
}

/// Triangles cut into small ones, each with separate vertices that have its normal.
#[derive(Default)]
struct Fine {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    materials: Vec<u32>,
}

impl Fine {
    fn new(geometry: &Geometry) -> Fine {
        let mut fine = Fine::default();
        let longest = LONGEST_EDGE * geometry.mesh.bounds().diagonal();
        for (index, &material) in geometry.mesh.materials.iter().enumerate() {
            fine.cut(geometry.mesh.corners(index), longest, material);
        }
        fine
    }

    /// Cuts a triangle into n² similar ones.
    fn cut(&mut self, [a, b, c]: [Vec3; 3], longest: f32, material: u32) {
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { return };
        let edges = [b - a, c - b, a - c].map(Vec3::length);
        let n = (edges.into_iter().fold(0.0, f32::max) / longest).ceil().clamp(1.0, 256.0) as u32;
        let first = self.positions.len() as u32;
        // Row r has r + 1 vertices.
        let vertex = |row: u32, column: u32| first + row * (row + 1) / 2 + column;
        for row in 0..=n {
            for column in 0..=row {
                let (u, v) = ((row - column) as f32 / n as f32, column as f32 / n as f32);
                self.positions.push(a + u * (b - a) + v * (c - a));
                self.normals.push(normal);
            }
        }
        for row in 0..n {
            for column in 0..=row {
                self.add([vertex(row, column), vertex(row + 1, column), vertex(row + 1, column + 1)], material);
                if column < row {
                    self.add([vertex(row, column), vertex(row + 1, column + 1), vertex(row, column + 1)], material);
                }
            }
        }
    }

    fn add(&mut self, triangle: [u32; 3], material: u32) {
        self.triangles.push(triangle);
        self.materials.push(material);
    }
}
