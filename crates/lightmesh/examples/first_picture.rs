//! The first image: renders a scene file, or a built-in scene, to an image file, as the command line does. A scene without camera or lights gets default
//! ones.
//!
//! `cargo run --release -p lightmesh-examples --bin first_picture [SCENE [IMAGE]]`
#![allow(clippy::print_stdout, reason = "an example says what it did")]

use std::error::Error;

use lightmesh::Request;
use lightmesh::request::value::Size;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "builtin:garden".to_owned());
    let file = arguments.next().unwrap_or_else(|| "first.png".to_owned());

    // ANCHOR: render
    let request = Request { size: Size([768, 512]), ..Request::default() };
    let picture = lightmesh::render(&scene, &request)?;
    picture.save(&file)?;
    let (stats, [width, height]) = (&picture.stats, picture.size());
    println!("{file}: {width}x{height} in {:.2} s on {}", stats.seconds.render, stats.device.name);
    // ANCHOR_END: render
    Ok(())
}
