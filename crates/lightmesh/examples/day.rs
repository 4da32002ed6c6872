//! A day: the frames of a sun study, and the hours of direct sun on what they show.
//!
//! `cargo run --release -p lightmesh-examples --bin day [SCENE [FOLDER]]`
#![allow(clippy::print_stdout, reason = "an example reports what it wrote")]

use std::error::Error;
use std::path::PathBuf;

use lightmesh::Request;
use lightmesh::render::Unobserved;
use lightmesh::request::files::Files;
use lightmesh::request::value::Size;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "builtin:gazebo".to_owned());
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));

    // ANCHOR: day
    let day = "54.98,82.9,2026-06-21+07:00,09:00-18:00/3h".parse()?;
    let request = Request { sun: Some(day), size: Size([256, 192]), ..Request::default() };
    let files = Files { output: Some(folder.join("day.#.png")), ..Files::default() };
    for frame in lightmesh::film(&scene, &request, files, &Unobserved)? {
        let frame = frame?;
        println!("frame {}, {}: {:.2} s", frame.number, frame.when, frame.frame.stats.seconds.render);
    }
    let hours = lightmesh::sun_hours(&scene, &request)?;
    hours.save(&folder.join("hours.png"))?;
    // ANCHOR_END: day
    let most = hours.hours().iter().copied().fold(0.0, f32::max);
    println!("at most {most:.1} hours of direct sun");
    Ok(())
}
