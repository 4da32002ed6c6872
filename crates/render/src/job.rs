//! What all stages of one picture share: choices, counts, clocks, progress and the observer.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use lightmesh_scene::Lights;

use crate::counters::Tally;
use crate::error::RenderError;
use crate::observer::Observer;
use crate::progress::Work;
use crate::settings::ShortTests;
use crate::stage::{Seconds, Stage};

/// How lights with a size are sampled.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Shadow rays per light with a size.
    pub samples: u32,
    /// Random pattern.
    pub seed: u64,
    /// Point lights are distributed over their spread (area mode).
    pub spread: bool,
}

impl Sampling {
    /// The same where light points, or surface points in their stead, look at the lights: point lights are points there.
    pub(crate) fn of_light_points(self) -> Sampling {
        Sampling { spread: false, ..self }
    }

    /// Long tests from one light point to all lights.
    pub(crate) fn rays_to(&self, lights: &Lights) -> usize {
        lights.iter().map(|light| if light.has_size() { self.samples as usize } else { 1 }).sum()
    }
}

/// One picture in the making.
pub struct Job<'a> {
    /// Who watches.
    pub observer: &'a dyn Observer,
    /// How lights with a size are sampled.
    pub sampling: Sampling,
    /// How short tests are evaluated.
    pub short_tests: ShortTests,
    /// What has been counted.
    pub tally: Tally,
    pub(crate) work: Work,
    seconds: Mutex<Seconds>,
    /// Some work was left out, since the observer had asked to stop.
    stopped: AtomicBool,
}

impl<'a> Job<'a> {
    /// A job that has done nothing yet.
    pub fn new(observer: &'a dyn Observer, sampling: Sampling) -> Job<'a> {
        let short_tests = ShortTests::default();
        let (tally, work) = (Tally::default(), Work::new());
        Job { observer, sampling, short_tests, tally, work, seconds: Mutex::default(), stopped: AtomicBool::new(false) }
    }

    /// The same with short tests evaluated in another way.
    pub fn with_short_tests(self, short_tests: ShortTests) -> Job<'a> {
        Job { short_tests, ..self }
    }

    /// Does a piece of the current stage's work, and tells that `pieces` more are done. Does nothing where the observer has asked to stop.
    #[inline(always)]
    pub(crate) fn piece<T: Default>(&self, pieces: usize, work: impl FnOnce() -> T) -> T {
        if self.observer.cancelled() {
            self.stopped.store(true, Ordering::Relaxed);
            return T::default();
        }
        let result = work();
        self.advance(pieces as u64);
        result
    }

    /// Tells that `pieces` more pieces of the current stage's work are done.
    pub(crate) fn advance(&self, pieces: u64) {
        self.work.advance(self.observer, pieces);
    }

    /// Takes the wall time of `work` for `stage`.
    pub(crate) fn wall_time<T>(&self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.add_seconds(stage, start.elapsed().as_secs_f64());
        result
    }

    /// Adds to the seconds spent in `stage`.
    pub(crate) fn add_seconds(&self, stage: Stage, seconds: f64) {
        *self.locked().of_mut(stage) += seconds;
    }

    /// Seconds spent in each stage so far.
    pub fn seconds(&self) -> Seconds {
        self.locked().clone()
    }

    /// Fails if the observer has asked to stop.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let stopped = self.stopped.load(Ordering::Relaxed) || self.observer.cancelled();
        if stopped { Err(RenderError::Cancelled) } else { Ok(()) }
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, Seconds> {
        self.seconds.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
