//! A sun study: one scene under the sun of several hours.
//!
//! `cargo run --release -p lightmesh --example sun_study [SCENE [FOLDER]]`
#![allow(clippy::print_stdout, reason = "an example says what it wrote")]

use std::error::Error;
use std::path::PathBuf;

use lightmesh::render::Unobserved;
use lightmesh::scene::{Falloff, Light, LightKind};
use lightmesh::{Device, Renderer, Scene, Settings};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "builtin:gazebo".to_owned());
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));

    let mut scene = Scene::open(scene)?;
    let renderer = Renderer::new(Device::Auto)?;
    let settings = Settings { size: [512, 512], ..Settings::default() };
    for hour in [8.0f32, 10.0, 12.0, 14.0, 16.0] {
        scene.lights = vec![sun(hour)];
        let prepared = renderer.prepare(&scene, &settings, &Unobserved)?;
        let frame = renderer.render_prepared(&prepared, &settings, &Unobserved)?;
        let path = folder.join(format!("sun-{hour:02}.png"));
        frame.save(&path)?;
        println!("{}: {} light points", path.display(), frame.stats.counts.light_points);
    }
    Ok(())
}

/// A sun that rises at 6 in the east (+X), stands in the south (+Z) at noon and sets at 18 in the west.
fn sun(hour: f32) -> Light {
    let angle = (hour - 6.0) / 12.0 * std::f32::consts::PI;
    let to_sun = [angle.cos(), angle.sin(), 0.6];
    let length = to_sun.iter().map(|x| x * x).sum::<f32>().sqrt();
    let direction = to_sun.map(|x| -x / length).into();
    Light {
        name: format!("sun at {hour}"),
        kind: LightKind::Directional { direction },
        intensity: [0.9, 0.87, 0.8].into(),
        falloff: Falloff::None,
    }
}
