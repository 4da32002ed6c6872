//! How fast kernels are, and how much work one launch may have.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Mutex;

use lightmesh_layout::constants::BLOCK;

use crate::cuda::{Kernel, Pool, Runtime};
use crate::error::RenderError;
use crate::sync::locked;

/// How long one launch should take, seconds. A watchdog ends a context after about two seconds; parts of a picture differ in cost
/// by less than the factor between.
const LAUNCH_SECONDS: f64 = 0.05;
/// A piece is at most this many times larger than the largest that was measured.
const GROWTH: f64 = 8.0;

/// Work of a kernel that can be cut into launches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    /// What is cut: blocks, or items.
    pub(crate) units: u64,
    /// What a unit costs, in whatever makes launches of this kernel comparable: rays or lights of each thread.
    pub(crate) cost: u64,
    /// Units of the kernel's first launch ever, whose speed is not known.
    pub(crate) first: u64,
    /// How much the observer is told about in all.
    pub(crate) progress: u64,
}

/// Rays of the first launch ever of a kernel that casts many for each thread.
const FIRST_RAYS: u64 = 1 << 18;
/// Most rays of a thread in one launch: a launch is never shorter than what one thread does.
const RAYS_OF_THREAD: u64 = 256;

/// Cuts the rays of a thread, which are all that there are for it, into what it casts in each launch. Without any there is one launch.
pub(crate) fn slices_of_rays(rays: u64) -> Vec<Range<u64>> {
    let slices = rays.div_ceil(RAYS_OF_THREAD).max(1);
    (0..slices).map(|slice| slice * RAYS_OF_THREAD..rays.min((slice + 1) * RAYS_OF_THREAD)).collect()
}

impl Work {
    /// Blocks of which each thread casts the rays of `slice`.
    pub(crate) fn of_rays(blocks: u64, slice: &Range<u64>, progress: u64) -> Work {
        let cost = (slice.end - slice.start).max(1);
        Work { units: blocks, cost, first: FIRST_RAYS / (u64::from(BLOCK) * cost), progress }
    }
}

/// How fast each kernel was when it ran last.
pub(crate) struct Rates<R: Runtime> {
    measured: Mutex<HashMap<Kernel, Measured>>,
    /// Launches whose time is not read yet.
    pending: Mutex<Vec<Timing<R>>>,
}

#[derive(Clone, Copy, Debug)]
struct Measured {
    cost: u64,
    seconds: f64,
}

/// A launch, and the moments of the queue between which it ran.
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
    /// Units of work that `kernel` may be given at once.
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

    /// Reads the clocks of all launches so far; waits for them. Of several of one kernel the slowest counts.
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
