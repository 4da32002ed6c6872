//! Progress and cancellation: an observer reports progress and stops the work after a deadline.
//!
//! `cargo run --release -p lightmesh-examples --bin progress [SECONDS [IMAGE]]`, 3 seconds by default.
#![allow(clippy::print_stdout, reason = "an example says what it does")]

use std::error::Error;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use lightmesh::render::Progress;
use lightmesh::{Device, Mode, Observer, RenderError, Renderer, Scene, Settings, Stage};

/// Prints each tenth of the work, and stops it at the deadline. Called from many threads.
struct Watcher {
    deadline: Instant,
    tenths: AtomicU32,
}

// ANCHOR: observer
impl Observer for Watcher {
    fn begin(&self, stage: Stage, total: u64) {
        println!("{}: {total} pieces", stage.name());
    }

    fn progress(&self, progress: Progress) {
        let tenths = (10.0 * progress.done) as u32;
        if self.tenths.fetch_max(tenths, Ordering::Relaxed) < tenths {
            let left = progress.left.map_or_else(String::new, |left| format!(", {left:.1} s to go"));
            println!("{}0 % after {:.1} s{left}", tenths, progress.seconds);
        }
    }

    fn note(&self, text: &str) {
        println!("note: {text}");
    }

    fn cancelled(&self) -> bool {
        Instant::now() > self.deadline
    }
}
// ANCHOR_END: observer

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let seconds: f64 = arguments.next().map_or(Ok(3.0), |number| number.parse())?;
    let picture = arguments.next().unwrap_or_else(|| "progress.png".to_owned());

    let scene = Scene::open("builtin:childpark")?;
    let settings = Settings::default().with_size([512, 512]).with_mode(Mode::Area).with_samples(64);
    let renderer = Renderer::new(Device::Auto)?;
    let time = Duration::try_from_secs_f64(seconds)?;
    let watcher = Watcher { deadline: Instant::now() + time, tenths: AtomicU32::new(0) };
    let prepared = renderer.prepare(&scene, &settings, &watcher)?;
    match renderer.render_prepared(&prepared, &settings, &watcher) {
        Ok(frame) => {
            frame.save(&picture)?;
            println!("{picture} is done");
        }
        Err(RenderError::Cancelled) => println!("cancelled after {seconds} s: no image was written"),
        Err(error) => return Err(error.into()),
    }
    Ok(())
}
