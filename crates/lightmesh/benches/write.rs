//! How long images take to encode, and how large they are, next to the encoders of the `png` and `exr` crates.
//!
//! `cargo bench -p lightmesh --bench write [-- SCENE…]`: renders the built-in scenes (or those whose name contains an argument) with 2048x2048
//! pixels at draft quality, encodes each several times, and prints the fastest run. The other encoders get what ours store: 8-bit codes in
//! the sRGB curve, and the channels of a layered file.
#![allow(clippy::print_stdout, reason = "a benchmark prints its result")]

use std::error::Error;
use std::io::Cursor;
use std::time::Instant;

use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage};
use lightmesh::image::{Frame, Layers};
use lightmesh::render::Quality;
use lightmesh::{Device, Renderer, Scene, Settings, Transfer};

const SCENES: [&str; 3] = ["builtin:gazebo", "builtin:childpark", "builtin:garden"];
const SIZE: u32 = 2048;
const REPETITIONS: usize = 5;

type Encoded = Result<Vec<u8>, Box<dyn Error>>;

/// Milliseconds of the fastest run, and the bytes.
fn timed(encode: impl Fn() -> Encoded) -> Result<(f64, Vec<u8>), Box<dyn Error>> {
    let (mut best, mut bytes) = (f64::INFINITY, Vec::new());
    for _ in 0..REPETITIONS {
        let start = Instant::now();
        bytes = encode()?;
        best = best.min(start.elapsed().as_secs_f64() * 1000.0);
    }
    Ok((best, bytes))
}

fn compare(what: &str, ours: impl Fn() -> Encoded, theirs: impl Fn() -> Encoded) -> Result<(), Box<dyn Error>> {
    let ((ours, our_bytes), (theirs, their_bytes)) = (timed(ours)?, timed(theirs)?);
    let growth = our_bytes.len() as f64 / their_bytes.len() as f64;
    println!(
        "  {what:7} {ours:8.1} ms {:10} bytes   crate {theirs:8.1} ms {:10} bytes   {:4.1} times as fast, {growth:.2} times as long",
        our_bytes.len(),
        their_bytes.len(),
        theirs / ours
    );
    Ok(())
}

/// As the `png` crate writes by default, on one thread.
fn crate_png(frame: &Frame) -> Encoded {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, frame.width(), frame.height());
    encoder.set_color(png::ColorType::Rgb);
    let codes: Vec<u8> = frame.color().as_flattened().iter().map(|&value| Transfer::Srgb.encode(value)).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&codes)?;
    writer.finish()?;
    Ok(bytes)
}

/// As the `exr` crate writes lossless files by default: ZIP, on all threads.
fn crate_exr(frame: &Frame, layers: &Layers) -> Encoded {
    let component = |vectors: &[[f32; 3]], axis: usize| vectors.iter().map(|vector| vector[axis]).collect::<Vec<f32>>();
    let mut channels: Vec<(String, Vec<f32>)> = vec![("Z".to_owned(), layers.depth.clone())];
    for (name, vectors) in [("C", frame.color()), ("N", &layers.normal[..]), ("P", &layers.position)] {
        channels.extend((0..3).map(|axis| (format!("{name}.{axis}"), component(vectors, axis))));
    }
    channels.extend(layers.visibility.iter().enumerate().map(|(light, plane)| (format!("V.{light}"), plane.clone())));
    channels.push(("M".to_owned(), layers.used.iter().map(|&count| count as f32).collect()));
    let list = channels.into_iter().map(|(name, plane)| AnyChannel::new(&*name, FlatSamples::F32(plane)));
    let channels = AnyChannels::sort(list.collect());
    let size = (frame.width() as usize, frame.height() as usize);
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

fn main() -> Result<(), Box<dyn Error>> {
    let filters: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let renderer = Renderer::new(Device::Auto)?;
    let settings = Settings::default().with_quality(Quality::Draft).with_size([SIZE, SIZE]).with_layers(true);
    for name in SCENES.iter().filter(|name| filters.is_empty() || filters.iter().any(|filter| name.contains(filter))) {
        let frame = renderer.render(&Scene::open(name)?, &settings)?.image;
        let layers = frame.layers().ok_or("the frame has no layers")?;
        println!("{name} {SIZE}x{SIZE}");
        compare("png", || Ok(frame.to_png()?), || crate_png(&frame))?;
        compare("layers", || Ok(frame.encode_layers()?), || crate_exr(&frame, layers))?;
    }
    Ok(())
}
