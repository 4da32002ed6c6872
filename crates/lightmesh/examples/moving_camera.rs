//! A camera that moves around a scene with many lights. The scene is prepared once; each image costs only its own render time.
//!
//! `cargo run --release -p lightmesh-examples --bin moving_camera [LIGHTS [IMAGES [FOLDER]]]`, by default 24 lights and 6 images.
#![allow(clippy::print_stdout, reason = "an example says what it wrote")]

use std::error::Error;
use std::path::PathBuf;

use lightmesh::glam::{Quat, Vec3};
use lightmesh::render::Unobserved;
use lightmesh::scene::{Camera, CameraError, Scene};
use lightmesh::{Device, Renderer, Settings};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let lights: u32 = arguments.next().map_or(Ok(24), |number| number.parse())?;
    let pictures: u16 = arguments.next().map_or(Ok(6), |number| number.parse())?;
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));

    let scene = Scene::open(format!("builtin:gazebo?lights={lights}"))?;
    let renderer = Renderer::new(Device::Auto)?;
    let settings = Settings::default().with_size([480, 320]);
    let prepared = renderer.prepare(&scene, &settings, &Unobserved)?;
    for picture in 0..pictures {
        let turn = f32::from(picture) / f32::from(pictures);
        let seen = prepared.with_cameras(vec![orbit(&scene, turn)?]);
        let frame = renderer.render_prepared(&seen, &settings, &Unobserved)?;
        let path = folder.join(format!("orbit-{picture:03}.png"));
        frame.save(&path)?;
        let seconds = &frame.stats.seconds;
        let (build, render) = (1e3 * seconds.build, 1e3 * seconds.render);
        println!("{}: {render:.0} ms, {build:.0} ms of building", path.display());
    }
    Ok(())
}

/// The scene's first camera, moved by `turn` full turns around the centre of the scene.
fn orbit(scene: &Scene, turn: f32) -> Result<Camera, CameraError> {
    let center = scene.geometry.mesh.bounds().center();
    let start = scene.cameras.first().map_or(Vec3::new(0.0, 5.0, 15.0), |camera| camera.position);
    let arm = Quat::from_rotation_y(turn * std::f32::consts::TAU) * (start - center);
    Camera::look_at(center + arm, center, Vec3::Y, 45.0)
}
