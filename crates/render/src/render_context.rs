//! What all stages of one image share: settings, counts, clocks, progress and the observer.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use lightmesh_scene::Lights;

use crate::counters::Tally;
use crate::error::RenderError;
use crate::observer::Observer;
use crate::progress::Work;
use crate::settings::{ShadowTests, ShortTests};
use crate::shadow::rows::KnownRows;
use crate::stage::{Seconds, Stage};

/// How area lights are sampled.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Shadow rays per area light.
    pub samples: u32,
    /// Random pattern.
    pub seed: u64,
    /// Whether point lights are distributed over their spread (area mode).
    pub spread: bool,
}

impl Sampling {
    /// The same for rays from light points, or from surface points in their place: point lights are treated as points.
    pub(crate) fn of_light_points(self) -> Sampling {
        Sampling { spread: false, ..self }
    }

    /// Number of long tests from one light point to all lights.
    pub(crate) fn rays_to(&self, lights: &Lights) -> usize {
        lights.iter().map(|light| if light.has_size() { self.samples as usize } else { 1 }).sum()
    }
}

/// One image being rendered.
pub struct RenderContext<'a> {
    /// The observer of this render.
    pub observer: &'a dyn Observer,
    /// How area lights are sampled.
    pub sampling: Sampling,
    /// How short tests are evaluated.
    pub short_tests: ShortTests,
    /// How the samples of lights are tested.
    pub shadow_tests: ShadowTests,
    /// Samples of a pixel, at most.
    pub pixel_samples: u32,
    /// The counts so far.
    pub tally: Tally,
    /// How much is done.
    #[doc(hidden)]
    pub work: Work,
    /// Where the samples of lights lie.
    pub(crate) rows: Arc<KnownRows>,
    seconds: Mutex<Seconds>,
    /// Set when some work was skipped because the observer requested cancellation.
    stopped: AtomicBool,
}

impl<'a> RenderContext<'a> {
    /// The context of an image of which nothing is done yet.
    pub fn new(observer: &'a dyn Observer, sampling: Sampling) -> RenderContext<'a> {
        let (short_tests, shadow_tests) = (ShortTests::default(), ShadowTests::default());
        let (tally, work) = (Tally::default(), Work::new());
        RenderContext {
            observer,
            sampling,
            short_tests,
            shadow_tests,
            pixel_samples: 1,
            tally,
            work,
            rows: Arc::default(),
            seconds: Mutex::default(),
            stopped: AtomicBool::new(false),
        }
    }

    /// The same with another evaluation of short tests.
    pub fn with_short_tests(self, short_tests: ShortTests) -> RenderContext<'a> {
        RenderContext { short_tests, ..self }
    }

    /// The same with another test of the samples of lights.
    pub fn with_shadow_tests(self, shadow_tests: ShadowTests) -> RenderContext<'a> {
        RenderContext { shadow_tests, ..self }
    }

    /// The same with so many samples of a pixel.
    pub fn with_pixel_samples(self, pixel_samples: u32) -> RenderContext<'a> {
        RenderContext { pixel_samples, ..self }
    }

    /// The same with rows of samples that images share.
    pub(crate) fn with_rows(self, rows: &Arc<KnownRows>) -> RenderContext<'a> {
        RenderContext { rows: Arc::clone(rows), ..self }
    }

    /// Does a piece of the current stage's work, and reports that `pieces` more are done. Does nothing if the observer has requested
    /// cancellation.
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

    /// Reports that `pieces` more pieces of the current stage's work are done.
    pub(crate) fn advance(&self, pieces: u64) {
        self.work.advance(self.observer, pieces);
    }

    /// Reports this, and that a share of the stage's time has passed.
    pub(crate) fn advance_in_time(&self, pieces: u64, share: f64) {
        self.work.advance_in_time(self.observer, pieces, share);
    }

    /// Adds the wall time of `work` to `stage`.
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

    /// Fails if the observer has requested cancellation.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let stopped = self.stopped.load(Ordering::Relaxed) || self.observer.cancelled();
        if stopped { Err(RenderError::Cancelled) } else { Ok(()) }
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, Seconds> {
        self.seconds.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
