//! Draws the figures of `docs/method/`, from data computed by the renderer itself: `cargo xtask drawings`.
//!
//! `cargo run -p lightmesh-render-examples --bin drawings -- DIR [--check]` writes each figure to DIR, or only compares it with the
//! existing file.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

mod canvas;
mod half_ball;
mod occluders;
mod rows;
mod segments;
mod template;
mod world;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

type Draw = fn() -> Result<String, Box<dyn Error>>;

const DRAWINGS: [(&str, Draw); 5] = [
    ("half-ball.svg", half_ball::draw),
    ("template.svg", template::draw),
    ("tests.svg", segments::draw),
    ("occluders.svg", occluders::draw),
    ("rows.svg", rows::draw),
];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let (flags, folders): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|word| word == "--check");
    let [folder] = &folders[..] else { return Err("usage: drawings DIR [--check]".into()) };
    let mut code = ExitCode::SUCCESS;
    for (name, draw) in DRAWINGS {
        let file = Path::new(folder).join(name);
        let svg = draw()?;
        if flags.is_empty() {
            fs::write(&file, &svg)?;
        } else if fs::read_to_string(&file).ok().as_ref() != Some(&svg) {
            eprintln!("error: {} is out of date; run `cargo xtask drawings`", file.display());
            code = ExitCode::FAILURE;
        }
    }
    println!("{} drawings in {folder}", DRAWINGS.len());
    Ok(code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_are_what_the_renderer_computes() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/drawings");
        for (name, draw) in DRAWINGS {
            let committed = fs::read_to_string(folder.join(name)).unwrap();
            assert!(committed == draw().unwrap(), "{name} is out of date: run `cargo xtask drawings`");
        }
    }
}
