//! The pictures of `bench/pictures/pictures.py --face rust`: a scene by the library alone, as PNG and EXR, with layers and statistics.
//!
//! `cargo run --release -p lightmesh-examples --bin pictures CASE SCENE FOLDER DEVICE`, where CASE is `default`, `ground`, `sky` or `turntable`.
#![allow(clippy::print_stderr, reason = "a program says what went wrong")]

use std::error::Error;
use std::f32::consts::TAU;
use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

use lightmesh::scene::{Camera, Lighting, Sky, Up};
use lightmesh::{Frame, Renderer, Scene, Settings};

const SIZE: [u32; 2] = [48, 36];
const FRAMES: u16 = 3;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [case, path, folder, device] = &arguments[..] else {
        eprintln!("pictures CASE SCENE FOLDER DEVICE");
        return ExitCode::FAILURE;
    };
    match pictures(case, path, folder.as_ref(), device) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn pictures(case: &str, path: &str, folder: &Path, device: &str) -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::open(path)?;
    scene.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    let mut settings = Settings::default().with_size(SIZE).with_layers(true);
    stage(case, &mut scene, Up::of_file(path.as_ref()))?;
    if case == "sky" {
        settings = settings.with_quality("draft".parse()?);
    }
    let renderer = Renderer::with_threads(device.parse()?, Some(1))?;
    for (number, camera) in cameras(case, &scene).into_iter().enumerate() {
        scene.cameras = vec![camera];
        save(&renderer.render(&scene, &settings)?, folder, number + 1)?;
    }
    Ok(())
}

/// Adds what a case is about, and what the scene lacks.
fn stage(case: &str, scene: &mut Scene, up: Up) -> Result<(), Box<dyn Error>> {
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    match case {
        "ground" => {
            scene.complete(up);
            scene.add_ground(up);
        }
        "sky" => {
            scene.lights.surround(Sky::clear(Sky::SUN).surroundings(up)?);
            scene.complete_outdoors(up, aspect);
        }
        _ => drop(scene.complete_with(Lighting::Studio, up, aspect)),
    }
    Ok(())
}

/// The scene's first camera, or what it is at each frame of a turntable.
fn cameras(case: &str, scene: &Scene) -> Vec<Camera> {
    let (first, middle) = (scene.cameras[0].clone(), scene.geometry.mesh.bounds().center());
    let frames = if case == "turntable" { FRAMES } else { 1 };
    let angle = |frame: u16| TAU * f32::from(frame) / f32::from(frames);
    (0..frames).map(|frame| first.clone().turned_about(middle, angle(frame))).collect()
}

fn save(frame: &Frame, folder: &Path, number: usize) -> Result<(), Box<dyn Error>> {
    frame.save(folder.join(format!("p.{number}.png")))?;
    frame.save(folder.join(format!("e.{number}.exr")))?;
    frame.image.save_layers(folder.join(format!("l.{number}.exr")))?;
    Ok(fs::write(folder.join(format!("p.{number}.json")), serde_json::to_string(&frame.stats)?)?)
}
