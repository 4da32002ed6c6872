//! The speed of kernels, and how much work one launch may contain.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Mutex;

use lightmesh_kernels::{Kernel, Pool, Runtime};
use lightmesh_layout::constants::BLOCK;

use crate::error::RenderError;
use crate::sync::locked;

/// Target duration of a launch, seconds. A watchdog kills a context after about two seconds; parts of an image differ in cost by less
/// than the factor between the two.
const LAUNCH_SECONDS: f64 = 0.05;
/// A piece is at most this many times larger than the largest measured so far.
const GROWTH: f64 = 8.0;

/// Work of a kernel that can be split into launches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    /// What is split: blocks, or bundles.
    pub(crate) units: u64,
    /// Cost of a unit, in any measure that makes launches of this kernel comparable: rays or lights per thread.
    pub(crate) cost: u64,
    /// Units of the kernel's first launch, whose speed is unknown.
    pub(crate) first: u64,
    /// Total progress to report to the observer.
    pub(crate) progress: u64,
}

/// Rays in the first launch of a kernel that casts many per thread.
const FIRST_RAYS: u64 = 1 << 18;
/// Most rays per thread in one launch: a launch is never shorter than the work of one thread.
const RAYS_OF_THREAD: u64 = 256;

/// Splits the rays of a thread into the slices that it casts in each launch. Without any rays there is one launch.
pub(crate) fn slices_of_rays(rays: u64) -> Vec<Range<u64>> {
    let slices = rays.div_ceil(RAYS_OF_THREAD).max(1);
    (0..slices).map(|slice| slice * RAYS_OF_THREAD..rays.min((slice + 1) * RAYS_OF_THREAD)).collect()
}

impl Work {
    /// Blocks whose threads each cast the rays of `slice`.
    pub(crate) fn of_rays(blocks: u64, slice: &Range<u64>, progress: u64) -> Work {
        let cost = (slice.end - slice.start).max(1);
        Work { units: blocks, cost, first: FIRST_RAYS / (u64::from(BLOCK) * cost), progress }
    }
}

/// The speed of each kernel in its latest launch.
pub(crate) struct Rates<R: Runtime> {
    measured: Mutex<HashMap<Kernel, Measured>>,
    /// Launches whose time has not been read yet.
    pending: Mutex<Vec<Timing<R>>>,
}

#[derive(Clone, Copy, Debug)]
struct Measured {
    cost: u64,
    seconds: f64,
}

/// A launch, and the points in the queue between which it ran.
pub(super) struct Timing<R: Runtime> {
    pub(super) kernel: Kernel,
    pub(super) cost: u64,
    pub(super) from: R::Mark,
    pub(super) to: R::Mark,
}

impl<R: Runtime> Default for Rates<R> {
    fn default() -> Rates<R> {
        Rates { measured: Mutex::default(), pending: Mutex::default() }
    }
}

impl<R: Runtime> Rates<R> {
    /// Number of units that one launch of `kernel` may contain.
    pub(super) fn piece(&self, kernel: Kernel, work: &Work) -> u64 {
        let units = locked(&self.measured).get(&kernel).map_or(work.first, |measured| {
            let factor = (LAUNCH_SECONDS / measured.seconds.max(1e-9)).min(GROWTH);
            (measured.cost as f64 * factor) as u64 / work.cost.max(1)
        });
        units.max(1)
    }

    pub(super) fn remember(&self, timing: Timing<R>) {
        locked(&self.pending).push(timing);
    }

    pub(super) fn forget_pending(&self) {
        locked(&self.pending).clear();
    }

    /// Reads the clocks of all launches so far, and waits for them. Of several launches of one kernel the slowest counts.
    pub(super) fn settle(&self, pool: &Pool<R>) -> Result<(), RenderError> {
        let pending: Vec<Timing<R>> = locked(&self.pending).drain(..).collect();
        let mut slowest: HashMap<Kernel, Measured> = HashMap::new();
        for Timing { kernel, cost, from, to } in pending {
            let seconds = pool.runtime().seconds(&from, &to).map_err(|fault| pool.fault(fault))?;
            let new = Measured { cost, seconds };
            let slow = slowest.entry(kernel).or_insert(new);
            if new.cost > 8 * slow.cost || new.seconds * slow.cost as f64 > slow.seconds * new.cost as f64 {
                *slow = new;
            }
        }
        locked(&self.measured).extend(slowest);
        Ok(())
    }
}
