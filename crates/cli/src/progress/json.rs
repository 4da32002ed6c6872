//! Progress for programs: one JSON object per line.
//!
//! ```text
//! {"event":"begin","stage":"short_tests","done":0,"total":4096,"seconds":0.0}
//! {"event":"progress","stage":"short_tests","done":1024,"total":4096,"seconds":0.21}
//! {"event":"end","stage":"short_tests","done":4096,"total":4096,"seconds":0.84}
//! {"event":"image","done":0.41,"seconds":2.1,"left":3.0}
//! {"event":"frame","number":7,"index":3,"count":120,"kept":4,"seconds":0.8,"left":93.2,"files":["film.0007.png"]}
//! {"event":"note","text":"…"}
//! ```
//!
//! `image` refers to all that is rendered, be it an image, a film, or hours of sun: the part that is done, which never falls, seconds since it was
//! started, and about how many remain (null at the very beginning). In the other events, seconds count from the start of the stage. A stage repeats
//! for each band of an image that is split to fit into memory, and for each bounce.
//!
//! `frame` says that a frame of a film is finished, and all of its files are there: its number in the film; which of the `count` frames of this
//! run it is, from 1 on; how many frames were there before and are kept; seconds that it took to render, and about how many the others of the run
//! will take; and its files, of which a movie is none. The texts of `note`, `warning` and `summary` are for humans.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use lightmesh::Stage;
use serde::Serialize;

use crate::output;
use lightmesh::request::FrameDone;

/// Time between two progress events.
const INTERVAL: Duration = Duration::from_millis(200);

/// Prints events.
pub(super) struct Json {
    done: AtomicU64,
    current: Mutex<Option<Current>>,
}

/// The current stage.
struct Current {
    stage: Stage,
    total: u64,
    start: Instant,
    last: Instant,
}

#[derive(Serialize)]
struct Progress {
    event: &'static str,
    stage: &'static str,
    done: u64,
    total: u64,
    seconds: f64,
}

#[derive(Serialize)]
struct Whole {
    event: &'static str,
    done: f64,
    seconds: f64,
    left: Option<f64>,
}

#[derive(Serialize)]
struct Frame<'a> {
    event: &'static str,
    number: u32,
    index: usize,
    count: usize,
    kept: usize,
    seconds: f64,
    left: f64,
    files: &'a [String],
}

#[derive(Serialize)]
struct Text<'a> {
    event: &'static str,
    text: &'a str,
}

impl Json {
    pub(super) fn new() -> Json {
        Json { done: AtomicU64::new(0), current: Mutex::new(None) }
    }

    pub(super) fn begin(&self, stage: Stage, total: u64) {
        let now = Instant::now();
        let current = Current { stage, total, start: now, last: now };
        self.done.store(0, Ordering::Relaxed);
        current.print("begin", 0);
        *self.current() = Some(current);
    }

    /// Cheap: counts, and leaves printing to the thread that acquires the lock.
    pub(super) fn advance(&self, pieces: u64) {
        let done = self.done.fetch_add(pieces, Ordering::Relaxed) + pieces;
        let Ok(mut current) = self.current.try_lock() else { return };
        let Some(current) = current.as_mut().filter(|current| current.last.elapsed() >= INTERVAL) else { return };
        current.last = Instant::now();
        current.print("progress", done);
    }

    pub(super) fn end(&self, stage: Stage) {
        let mut current = self.current();
        if let Some(current) = current.take_if(|current| current.stage == stage) {
            current.print("end", self.done.load(Ordering::Relaxed));
        }
    }

    pub(super) fn whole(&self, progress: lightmesh::render::Progress) {
        let lightmesh::render::Progress { done, seconds, left } = progress;
        output::complain_json(&Whole { event: "image", done, seconds, left });
    }

    pub(super) fn frame(&self, frame: &FrameDone) {
        let &FrameDone { number, index, count, kept, seconds, left, ref files, .. } = frame;
        let left = left.as_secs_f64();
        output::complain_json(&Frame { event: "frame", number, index, count, kept, seconds, left, files });
    }

    pub(super) fn text(&self, event: &'static str, text: &str) {
        output::complain_json(&Text { event, text });
    }

    fn current(&self) -> MutexGuard<'_, Option<Current>> {
        self.current.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Current {
    fn print(&self, event: &'static str, done: u64) {
        let (stage, total) = (self.stage.name(), self.total);
        output::complain_json(&Progress { event, stage, done, total, seconds: self.start.elapsed().as_secs_f64() });
    }
}
