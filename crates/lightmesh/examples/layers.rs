//! Layers: what each pixel sees, as one OpenEXR file for compositing, and depth and the visibility of each light as images.
//!
//! `cargo run --release -p lightmesh-examples --bin layers [SCENE [FOLDER]]`
#![allow(clippy::print_stdout, reason = "an example says what it wrote")]

use std::error::Error;
use std::path::PathBuf;

use lightmesh::scene::Up;
use lightmesh::{Device, Renderer, Scene, Settings, Transfer, image};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_else(|| "builtin:gazebo".to_owned());
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));

    let mut scene = Scene::open(&path)?;
    scene.complete(Up::of_file(path.as_ref()));
    // ANCHOR: layers
    let settings = Settings::default().with_size([512, 384]).with_layers(true);
    let frame = Renderer::new(Device::Auto)?.render(&scene, &settings)?;
    frame.save(folder.join("picture.png"))?;
    frame.image.save_layers(folder.join("layers.exr"))?;
    // ANCHOR_END: layers

    let [width, height] = frame.size();
    let Some(layers) = frame.layers() else { return Err("layers were asked for".into()) };
    let save = |name: &str, values: Vec<f32>| -> Result<(), Box<dyn Error>> {
        let color = values.into_iter().map(|value| [value; 3]).collect();
        let path = folder.join(name);
        // As numbers, not as light: 8-bit codes proportional to the value.
        image::Frame::new(width, height, color)?.save_with(&path, Transfer::Linear)?;
        println!("{}", path.display());
        Ok(())
    };
    let farthest = layers.depth.iter().copied().filter(|depth| depth.is_finite()).fold(f32::MIN_POSITIVE, f32::max);
    save("depth.png", layers.depth.iter().map(|depth| 1.0 - (depth / farthest).min(1.0)).collect())?;
    for (light, plane) in layers.visibility.iter().enumerate() {
        save(&format!("visibility-{light}.png"), plane.clone())?;
    }
    Ok(())
}
