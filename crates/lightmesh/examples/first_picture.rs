//! The first image: renders a scene file, or a built-in scene, to an image file. A scene without camera or lights gets default
//! ones.
//!
//! `cargo run --release -p lightmesh-examples --bin first_picture [SCENE [IMAGE]]`
#![allow(clippy::print_stdout, reason = "an example says what it did")]

use std::error::Error;

use lightmesh::scene::Up;
use lightmesh::{Device, Renderer, Scene, Settings};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_else(|| "builtin:garden".to_owned());
    let picture = arguments.next().unwrap_or_else(|| "first.png".to_owned());

    // ANCHOR: open
    let mut scene = Scene::open(&path)?;
    scene.warnings.iter().for_each(|warning| println!("warning: {warning}"));
    let added = scene.complete(Up::of_file(path.as_ref()));
    // ANCHOR_END: open
    if added.camera || added.lights {
        println!("{} came without camera or lights: some were added", scene.name);
    }

    // ANCHOR: render
    let renderer = Renderer::new(Device::Auto)?;
    let frame = renderer.render(&scene, &Settings::default().with_size([768, 512]))?;
    frame.save(&picture)?;
    let (stats, [width, height]) = (&frame.stats, frame.size());
    println!("{picture}: {width}x{height} in {:.2} s on {}", stats.seconds.render, stats.device.name);
    // ANCHOR_END: render
    Ok(())
}
