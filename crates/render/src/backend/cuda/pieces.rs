//! Launches in pieces: short enough for a desktop's watchdog, with a chance to stop in between.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Mutex;

use super::{Cuda, locked};
use crate::RenderError;
use crate::cuda::{Kernel, Pool, Runtime};
use crate::job::Job;

/// How long one launch should take, seconds. A watchdog ends a context after about two seconds; parts of a picture differ in cost
/// by less than the factor between.
const LAUNCH_SECONDS: f64 = 0.05;
/// A piece is at most this many times larger than the largest that was measured.
const GROWTH: f64 = 8.0;

/// How fast each kernel was when it ran last.
pub(crate) struct Rates<R: Runtime> {
    measured: Mutex<HashMap<Kernel, Measured>>,
    /// Launches whose time is not read yet.
    pending: Mutex<Vec<Timing<R>>>,
}

#[derive(Clone, Copy, Debug)]
struct Measured {
    units: u64,
    seconds: f64,
}

struct Timing<R: Runtime> {
    kernel: Kernel,
    units: u64,
    from: R::Mark,
    to: R::Mark,
}

impl<R: Runtime> Default for Rates<R> {
    fn default() -> Rates<R> {
        Rates { measured: Mutex::default(), pending: Mutex::default() }
    }
}

impl<R: Runtime> Rates<R> {
    /// Units of work that `kernel` may be given at once; `first` where nothing is known.
    fn piece(&self, kernel: Kernel, first: u64) -> u64 {
        locked(&self.measured).get(&kernel).map_or(first, |measured| {
            let factor = (LAUNCH_SECONDS / measured.seconds.max(1e-9)).min(GROWTH);
            ((measured.units as f64 * factor) as u64).max(1)
        })
    }

    fn remember(&self, timing: Timing<R>) {
        locked(&self.pending).push(timing);
    }

    pub(super) fn forget_pending(&self) {
        locked(&self.pending).clear();
    }

    /// Reads the clocks of all launches so far; waits for them. Of several of one kernel the slowest counts.
    pub(super) fn settle(&self, pool: &Pool<R>) -> Result<(), RenderError> {
        let pending: Vec<Timing<R>> = locked(&self.pending).drain(..).collect();
        let mut slowest: HashMap<Kernel, Measured> = HashMap::new();
        for Timing { kernel, units, from, to } in pending {
            let seconds = pool.runtime().seconds(&from, &to).map_err(|fault| pool.fault(fault))?;
            let new = Measured { units, seconds };
            let slow = slowest.entry(kernel).or_insert(new);
            if new.units > 8 * slow.units || new.seconds * slow.units as f64 > slow.seconds * new.units as f64 {
                *slow = new;
            }
        }
        locked(&self.measured).extend(slowest);
        Ok(())
    }
}

impl<R: Runtime> Cuda<R> {
    /// Calls `launch` with consecutive ranges of `units` units of work, each to be queued as one launch of `kernel`. The first one
    /// ever has `first` units; later ones as many as the kernel's speed allows. Tells the observer about `pieces` pieces of work
    /// in all, and fails where it asks to stop.
    pub(crate) fn in_pieces(
        &self,
        job: &Job,
        kernel: Kernel,
        units: u64,
        first: u64,
        pieces: u64,
        mut launch: impl FnMut(Range<u64>) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let mut done = 0;
        while done < units {
            job.check()?;
            let piece = self.rates.piece(kernel, first).min(units - done);
            let from = self.mark()?;
            launch(done..done + piece)?;
            let timing = Timing { kernel, units: piece, from, to: self.mark()? };
            self.rates.remember(timing);
            done += piece;
            if done < units {
                self.rates.settle(&self.pool)?;
            }
            job.observer.advance(pieces * done / units - pieces * (done - piece) / units);
        }
        Ok(())
    }
}
