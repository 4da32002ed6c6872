//! A flight through a scene: what light points see is cached from image to image, and only new ones are tested.
//!
//! `cargo run --release -p lightmesh-examples --bin fly_through [SCENE [STEPS [SIZE [STEP]]]]`: the built-in Childpark, 30 images of 512 by
//! 512 pixels, a light-mesh step of 1. Every tenth image is rendered again without the cache, and must be byte-identical.
#![allow(clippy::print_stdout, reason = "an example says what it did")]

use std::error::Error;

use lightmesh::render::{Step, Unobserved};
use lightmesh::scene::Camera;
use lightmesh::{Device, Frame, MeshCache, Renderer, Scene, Settings};

/// Number of images from one check to the next.
const CHECK: u16 = 10;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "builtin:childpark".to_owned());
    let pictures: u16 = arguments.next().map_or(Ok(30), |number| number.parse())?;
    let size: u32 = arguments.next().map_or(Ok(512), |number| number.parse())?;
    let step: f32 = arguments.next().map_or(Ok(1.0), |number| number.parse())?;

    let scene = Scene::open(scene)?;
    let renderer = Renderer::new(Device::Auto)?;
    let settings = Settings::default().with_size([size; 2]).with_step(Step::Fixed(step));
    let prepared = renderer.prepare(&scene, &settings, &Unobserved)?;
    let way = 0.1 * prepared.geometry.bounds.diagonal();
    let mut cache = MeshCache::new();
    for picture in 0..pictures {
        let camera = on_the_way(&scene, way * f32::from(picture) / f32::from(pictures.max(2) - 1));
        let settings = settings.clone().with_camera(camera);
        let frame = renderer.render_with(&mut cache, &prepared, &settings, &Unobserved)?;
        let (counts, seconds) = (&frame.stats.counts, &frame.stats.seconds);
        println!(
            "image {picture:2}: {:8} long tests, {:8} saved, {:.3} s; {:.1} MB cached",
            counts.long_tests,
            counts.long_tests_saved,
            seconds.render,
            1e-6 * cache.memory() as f64
        );
        if picture % CHECK == 0 {
            let fresh = renderer.render_prepared(&prepared, &settings, &Unobserved)?;
            if bytes(&fresh) != bytes(&frame) {
                return Err(format!("image {picture} differs without the cache").into());
            }
            println!("image {picture:2}: identical without the cache, in {:.3} s", fresh.stats.seconds.render);
        }
    }
    Ok(())
}

/// The scene's camera, moved forward at constant height.
fn on_the_way(scene: &Scene, way: f32) -> Camera {
    let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.default_camera(Default::default()));
    let ahead = camera.direction - camera.direction.dot(camera.up) * camera.up;
    let position = camera.position + way * ahead.normalize_or_zero();
    camera.with_position(position)
}

fn bytes(frame: &Frame) -> Vec<u8> {
    frame.image.color().iter().flatten().flat_map(|value| value.to_ne_bytes()).collect()
}
