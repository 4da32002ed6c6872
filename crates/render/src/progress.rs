//! How far a picture is, over all of its stages: one total, counted in pieces.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use crate::observer::{Observer, Progress};
use crate::stage::Stage;

/// Least time between two reports on the whole picture, seconds.
const INTERVAL: f64 = 0.05;

/// The work of a picture: done, and in all.
///
/// A wave of n rays has n pieces in each of its stages. How many rays the camera sends is known from the beginning, how many mirrors add
/// when they do.
#[derive(Debug)]
pub(crate) struct Work {
    start: Instant,
    total: AtomicU64,
    done: AtomicU64,
    /// The stage that is worked on.
    current: Mutex<Option<Current>>,
    /// Milliseconds after the start when the whole picture was reported on last.
    reported: AtomicU64,
}

/// A stage in progress.
#[derive(Clone, Copy, Debug)]
struct Current {
    stage: Stage,
    total: u64,
    done: u64,
    /// Pieces of the whole picture that the stage stands for.
    share: u64,
}

impl Work {
    pub(crate) fn new() -> Work {
        Work {
            start: Instant::now(),
            total: AtomicU64::new(0),
            done: AtomicU64::new(0),
            current: Mutex::new(None),
            reported: AtomicU64::new(0),
        }
    }

    /// More pieces are to be done for the picture.
    pub(crate) fn expect(&self, pieces: u64) {
        self.total.fetch_add(pieces, Ordering::Relaxed);
    }

    /// Pieces of the picture that are done: to go back to by [`rewind`](Work::rewind).
    pub(crate) fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// What was done since is to be done again; `added` pieces were expected since.
    pub(crate) fn rewind(&self, done: u64, total: u64) {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
    }

    /// Pieces of the picture in all, as far as is known.
    pub(crate) fn total(&self) -> u64 {
        self.total.load(Ordering::Relaxed)
    }

    /// A stage begins that has `total` pieces of its own and stands for `share` pieces of the picture.
    pub(crate) fn begin(&self, observer: &dyn Observer, stage: Stage, total: u64, share: u64) {
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

    /// The stage is over. What it had no occasion to tell of is done as well.
    pub(crate) fn end(&self, observer: &dyn Observer, stage: Stage) {
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
        let total = self.total();
        if total > 0 {
            let done = self.done() as f64 / total as f64;
            let left = (done > 0.0).then(|| seconds * (1.0 - done) / done);
            observer.progress(Progress { done, seconds, left });
        }
    }

    fn current(&self) -> std::sync::MutexGuard<'_, Option<Current>> {
        self.current.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl Current {
    /// Pieces of the picture that are done with this stage's.
    fn of_picture(&self) -> u64 {
        let share = u128::from(self.share) * u128::from(self.done) / u128::from(self.total.max(1));
        share as u64
    }
}
