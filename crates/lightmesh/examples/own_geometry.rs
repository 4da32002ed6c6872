//! Custom geometry: arrays of vertices, normals, colours and triangles become a scene. Here they are a hill with boxes on it.
//!
//! `cargo run --release -p lightmesh-examples --bin own_geometry [IMAGE]`
#![allow(clippy::print_stdout, reason = "an example says what it wrote")]

use std::error::Error;

use lightmesh::glam::{DMat4, DVec3, Vec3};
use lightmesh::scene::{Camera, Light, Lights, Material, MeshPart, SceneBuilder};
use lightmesh::{Device, Renderer, Settings};

/// Vertices of the hill along one side.
const SIDE: u32 = 128;

fn main() -> Result<(), Box<dyn Error>> {
    let picture = std::env::args().nth(1).unwrap_or_else(|| "hill.png".to_owned());

    // ANCHOR: builder
    let mut builder = SceneBuilder::new();
    let grass = builder.add_material(Material::matt([0.8; 3]).named("grass"));
    let clay = builder.add_material(Material::matt([0.7, 0.35, 0.2]).with_ks([0.2; 3]).named("clay"));
    let hill = Hill::new();
    let part =
        MeshPart { positions: &hill.positions, normals: &hill.normals, colors: &hill.colors, ..Default::default() };
    builder.add(MeshPart { triangles: &hill.triangles, ..part }, &DMat4::IDENTITY, |_| grass)?;
    // A mesh may be added any number of times, each time with another transform.
    for turn in 0..12 {
        let place = DVec3::new(2.6, 0.0, 0.0);
        let around = DMat4::from_rotation_y(f64::from(turn) * std::f64::consts::TAU / 12.0);
        let at = around * DMat4::from_translation(place + DVec3::Y * f64::from(height(2.6, 0.0)));
        builder.add(cube(), &(at * DMat4::from_scale(DVec3::new(0.15, 0.8, 0.5))), |_| clay)?;
    }

    let camera = Camera::look_at(Vec3::new(0.0, 5.0, 9.0), Vec3::Y * 0.5, Vec3::Y, 40.0)?;
    let sun = Light::directional(Vec3::new(-0.8, -0.5, -0.4))?.with_intensity([0.8; 3]);
    let lights = Lights::from(vec![sun]).with_ambient([0.25; 3]).with_background([0.5, 0.65, 0.9]);
    let scene = builder.finish_scene("hill").with_lights(lights).with_cameras(vec![camera]);
    // ANCHOR_END: builder

    let frame = Renderer::new(Device::Auto)?.render(&scene, &Settings::default().with_size([768, 512]))?;
    frame.save(&picture)?;
    println!("{picture}: {} triangles", scene.geometry.mesh.triangles.len());
    Ok(())
}

/// A mesh as many programs store it.
struct Hill {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    colors: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

/// The height of the hill; it depends only on the distance from its top.
fn height(x: f32, z: f32) -> f32 {
    1.5 * (-0.15 * (x * x + z * z)).exp()
}

impl Hill {
    fn new() -> Hill {
        let place = |i: u32| 10.0 * (i as f32 / (SIDE - 1) as f32 - 0.5);
        let points = || (0..SIDE * SIDE).map(|i| (place(i % SIDE), place(i / SIDE)));
        let normal = |(x, z)| Vec3::new(0.3 * x * height(x, z), 1.0, 0.3 * z * height(x, z)).normalize();
        let color = |(x, z)| Vec3::new(0.25, 0.5, 0.15).lerp(Vec3::new(0.9, 0.85, 0.6), height(x, z) / 1.5);
        let cells = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| row * SIDE + column));
        Hill {
            positions: points().map(|(x, z)| Vec3::new(x, height(x, z), z)).collect(),
            normals: points().map(normal).collect(),
            colors: points().map(color).collect(),
            // Counter-clockwise seen from above.
            triangles: cells.flat_map(|i| [[i, i + SIDE, i + 1], [i + 1, i + SIDE, i + SIDE + 1]]).collect(),
        }
    }
}

/// A cube of edge 1 on the ground. Without normals it is shaded flat.
fn cube() -> MeshPart<'static, Vec3> {
    const CORNERS: [Vec3; 8] = [
        Vec3::new(-0.5, 0.0, -0.5),
        Vec3::new(0.5, 0.0, -0.5),
        Vec3::new(-0.5, 1.0, -0.5),
        Vec3::new(0.5, 1.0, -0.5),
        Vec3::new(-0.5, 0.0, 0.5),
        Vec3::new(0.5, 0.0, 0.5),
        Vec3::new(-0.5, 1.0, 0.5),
        Vec3::new(0.5, 1.0, 0.5),
    ];
    const TRIANGLES: [[u32; 3]; 12] = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 4, 2],
        [4, 6, 2],
        [1, 3, 5],
        [5, 3, 7],
        [2, 6, 3],
        [3, 6, 7],
        [0, 1, 4],
        [1, 5, 4],
    ];
    MeshPart { positions: &CORNERS, triangles: &TRIANGLES, ..MeshPart::default() }
}
