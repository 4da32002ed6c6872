//! What all stages of one picture share: choices, counts, clocks and the observer.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use crate::backend::Backend;
use crate::settings::ShortTests;
use crate::{Observer, RenderError, Stage};

/// How lights with a size are sampled.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Shadow rays per light with a size.
    pub samples: u32,
    /// Random pattern.
    pub seed: u64,
    /// Point lights are strewn over their spread (area mode).
    pub spread: bool,
}

/// Everything that is counted, summed over all tiles and bounces.
#[derive(Debug, Default)]
pub struct Tally {
    /// Rays cast for pixels and mirrors.
    pub rays: AtomicU64,
    /// Camera rays that hit something.
    pub hits: AtomicU64,
    /// Object points, those in mirrors included.
    pub object_points: AtomicU64,
    /// Light points in all half-balls, before visibility.
    pub half_ball: AtomicU64,
    /// Light points used by all object points.
    pub used: AtomicU64,
    /// Object points that found no light point.
    pub fallbacks: AtomicU64,
    /// Distinct light points, S_total.
    pub light_points: AtomicU64,
    /// Short tests that asked triangles.
    pub short_tests: AtomicU64,
    /// Short tests that were decided without asking.
    pub short_tests_culled: AtomicU64,
    /// Long tests from light points.
    pub long_tests: AtomicU64,
    /// Shadow rays from object points.
    pub shadow_rays: AtomicU64,
}

impl Tally {
    /// Adds `amount` to a count.
    pub fn add(count: &AtomicU64, amount: u64) {
        count.fetch_add(amount, Ordering::Relaxed);
    }

    /// Reads a count.
    pub fn get(count: &AtomicU64) -> u64 {
        count.load(Ordering::Relaxed)
    }

    /// What has been counted so far.
    pub(crate) fn snapshot(&self) -> [u64; 11] {
        self.all().map(Tally::get)
    }

    /// Goes back to an earlier state: what was counted since belongs to work that is done again.
    pub(crate) fn restore(&self, snapshot: &[u64; 11]) {
        for (count, &value) in self.all().into_iter().zip(snapshot) {
            count.store(value, Ordering::Relaxed);
        }
    }

    fn all(&self) -> [&AtomicU64; 11] {
        let Tally { rays, hits, object_points, half_ball, used, fallbacks, light_points, .. } = self;
        let Tally { short_tests, short_tests_culled, long_tests, shadow_rays, .. } = self;
        let mesh = [half_ball, used, fallbacks, light_points, short_tests, short_tests_culled];
        let [a, b, c, d, e, f] = mesh;
        [rays, hits, object_points, a, b, c, d, e, f, long_tests, shadow_rays]
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
    seconds: Mutex<HashMap<Stage, f64>>,
}

impl<'a> Job<'a> {
    /// A job that has done nothing yet.
    pub fn new(observer: &'a dyn Observer, sampling: Sampling) -> Job<'a> {
        let short_tests = ShortTests::default();
        Job { observer, sampling, short_tests, tally: Tally::default(), seconds: Mutex::default() }
    }

    /// The same with short tests evaluated in another way.
    pub fn with_short_tests(self, short_tests: ShortTests) -> Job<'a> {
        Job { short_tests, ..self }
    }

    /// Runs one stage: tells the observer, lets the backend take the time, and fails if the observer has asked to stop.
    pub fn stage<B: Backend, T>(
        &self,
        backend: &B,
        stage: Stage,
        pieces: u64,
        work: impl FnOnce() -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        self.check()?;
        self.observer.begin(stage, pieces);
        let result = backend.timed(self, stage, work);
        self.observer.end(stage);
        let result = result?;
        self.check()?;
        Ok(result)
    }

    /// Takes the wall time of `work` for `stage`.
    pub fn wall_time<T>(&self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.add_seconds(stage, start.elapsed().as_secs_f64());
        result
    }

    /// Adds to the seconds spent in `stage`.
    pub fn add_seconds(&self, stage: Stage, seconds: f64) {
        *self.seconds.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).entry(stage).or_default() += seconds;
    }

    /// Seconds spent in `stage`.
    pub fn seconds(&self, stage: Stage) -> f64 {
        self.seconds.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).get(&stage).copied().unwrap_or(0.0)
    }

    /// Fails if the observer has asked to stop.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        if self.observer.cancelled() { Err(RenderError::Cancelled) } else { Ok(()) }
    }
}
