//! Progress over all stages of an image: one total, counted in pieces.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use crate::observer::{Observer, Progress};
use crate::stage::Stage;

/// Minimum time between two progress reports on the whole image, seconds.
const INTERVAL: f64 = 0.05;

/// The work of an image: done, and in total.
///
/// A wave of n rays counts as n pieces in each of its stages. The number of camera rays is known from the beginning, the number of
/// mirror rays only once they are traced.
#[derive(Debug)]
pub struct Work {
    start: Instant,
    total: AtomicU64,
    done: AtomicU64,
    /// The stage in progress.
    current: Mutex<Option<Current>>,
    /// The part in progress of an image whose total is known part by part.
    part: Mutex<Option<Part>>,
    /// Milliseconds between the start and the latest progress report on the whole image.
    reported: AtomicU64,
}

/// A part of an image, such as a band, whose total is not known before it begins.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// The share of the image that was done before it, and after it.
    before: f64,
    after: f64,
    /// Pieces done and expected when it began.
    done: u64,
    total: u64,
}

/// A stage in progress.
#[derive(Clone, Copy, Debug)]
struct Current {
    stage: Stage,
    total: u64,
    done: u64,
    /// Pieces of the whole image that the stage counts as.
    share: u64,
}

impl Default for Work {
    fn default() -> Work {
        Work::new()
    }
}

impl Work {
    /// Nothing is expected yet.
    pub fn new() -> Work {
        Work {
            start: Instant::now(),
            total: AtomicU64::new(0),
            done: AtomicU64::new(0),
            current: Mutex::new(None),
            part: Mutex::new(None),
            reported: AtomicU64::new(0),
        }
    }

    /// Adds pieces to the image's total.
    pub fn expect(&self, pieces: u64) {
        self.total.fetch_add(pieces, Ordering::Relaxed);
    }

    /// A part begins that is the share of the image from `before` to `after`: what is expected from now on is its own.
    pub fn begin_part(&self, [before, after]: [f64; 2]) {
        *self.part() = Some(Part { before, after, done: self.done(), total: self.total() });
    }

    /// Pieces of the image that are done, for [`rewind`](Work::rewind).
    pub fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// Work done since then will be repeated; `added` pieces were expected since.
    pub(crate) fn rewind(&self, done: u64, total: u64) {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
    }

    /// Total pieces of the image, as far as known.
    pub fn total(&self) -> u64 {
        self.total.load(Ordering::Relaxed)
    }

    /// A stage begins that has `total` pieces of its own and counts as `share` pieces of the image.
    pub fn begin(&self, observer: &dyn Observer, stage: Stage, total: u64, share: u64) {
        *self.current() = Some(Current { stage, total, done: 0, share });
        observer.begin(stage, total);
    }

    /// Some pieces of the current stage are done.
    pub(crate) fn advance(&self, observer: &dyn Observer, pieces: u64) {
        if let Some(current) = self.current().as_mut() {
            let before = current.of_picture();
            current.done += pieces;
            debug_assert!(current.done <= current.total, "{:?}: {} of {}", current.stage, current.done, current.total);
            self.done.fetch_add(current.of_picture() - before, Ordering::Relaxed);
        }
        observer.advance(pieces);
        self.report(observer, false);
    }

    /// The stage has ended. Pieces that it did not report are done as well.
    pub fn end(&self, observer: &dyn Observer, stage: Stage) {
        let rest = self.current().map_or(0, |current| current.total - current.done);
        if rest > 0 {
            self.advance(observer, rest);
        }
        if let Some(current) = self.current().take() {
            // A stage without pieces of its own is done as well.
            self.done.fetch_add(current.share - current.of_picture(), Ordering::Relaxed);
        }
        self.report(observer, true);
        observer.end(stage);
    }

    fn report(&self, observer: &dyn Observer, always: bool) {
        let seconds = self.start.elapsed().as_secs_f64();
        let (now, last) = ((1e3 * seconds) as u64, self.reported.load(Ordering::Relaxed));
        if !always && ((now - last.min(now)) as f64) < 1e3 * INTERVAL {
            return;
        }
        self.reported.store(now, Ordering::Relaxed);
        if self.total() > 0 {
            let done = self.share();
            let left = (done > 0.0).then(|| seconds * (1.0 - done) / done);
            observer.progress(Progress { done, seconds, left });
        }
    }

    /// The share of the image that is done.
    fn share(&self) -> f64 {
        let whole = Part { before: 0.0, after: 1.0, done: 0, total: 0 };
        let Part { before, after, done, total } = self.part().unwrap_or(whole);
        let (done, total) = (self.done().saturating_sub(done), self.total().saturating_sub(total));
        before + (after - before) * done as f64 / total.max(1) as f64
    }

    fn part(&self) -> std::sync::MutexGuard<'_, Option<Part>> {
        self.part.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn current(&self) -> std::sync::MutexGuard<'_, Option<Current>> {
        self.current.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl Current {
    /// Pieces of the image that this stage has completed.
    fn of_picture(&self) -> u64 {
        let share = u128::from(self.share) * u128::from(self.done) / u128::from(self.total.max(1));
        share as u64
    }
}
