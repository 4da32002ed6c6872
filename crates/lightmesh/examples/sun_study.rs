//! A sun study: one scene at several hours of the day. The scene is prepared once; moving the sun rebuilds nothing.
//!
//! `cargo run --release -p lightmesh-examples --bin sun_study [SCENE [FOLDER [HOURS]]]`, where HOURS is the number of images (5).
#![allow(clippy::print_stdout, reason = "an example reports what it wrote")]

use std::error::Error;
use std::path::PathBuf;

use lightmesh::glam::Vec3;
use lightmesh::render::Unobserved;
use lightmesh::scene::{Light, LightError};
use lightmesh::{Device, Renderer, Scene, Settings};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "builtin:gazebo".to_owned());
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));
    let pictures: u16 = arguments.next().map_or(Ok(5), |number| number.parse())?;

    let scene = Scene::open(scene)?;
    let renderer = Renderer::new(Device::Auto)?;
    let settings = Settings::default().with_size([512, 512]);
    // ANCHOR: images
    let prepared = renderer.prepare(&scene, &settings, &Unobserved)?;
    for picture in 0..pictures {
        let hour = 8.0 + 8.0 * f32::from(picture) / f32::from(pictures.max(2) - 1);
        let lights = scene.lights.clone().with_list(vec![sun(hour)?]);
        let frame = renderer.render_prepared(&prepared.with_lights(lights), &settings, &Unobserved)?;
        let path = folder.join(format!("sun-{hour:05.2}.png"));
        frame.save(&path)?;
        let (counts, seconds) = (&frame.stats.counts, &frame.stats.seconds);
        let (points, build, upload) = (counts.light_points, seconds.build, seconds.upload);
        println!("{}: {points} light points, {build:.3} s building, {upload:.3} s uploading", path.display());
    }
    // ANCHOR_END: images
    Ok(())
}

// ANCHOR: sun
/// A sun that rises at 6 in the east (+X), is in the south (+Z) at noon and sets at 18 in the west.
fn sun(hour: f32) -> Result<Light, LightError> {
    let angle = (hour - 6.0) / 12.0 * std::f32::consts::PI;
    let to_sun = Vec3::new(angle.cos(), angle.sin(), 0.6);
    Ok(Light::directional(-to_sun)?.with_intensity([0.9, 0.87, 0.8]).named(format!("sun at {hour}")))
}
// ANCHOR_END: sun
