//! Launches in pieces: short enough for a desktop's watchdog, with an opportunity to cancel in between.
//!
//! A desktop's watchdog kills launches that take too long, and a launch cannot be cancelled. Every kernel that traces, tests, groups, marks or
//! shades therefore goes through `in_pieces`, and each launch covers a range of blocks or bundles. The first launch is small; further pieces are as
//! large as the kernel's measured speed allows for 50 ms, but at most eight times the largest piece measured. Speed is measured per ray or light
//! where their number varies between images. A launch cannot be shorter than the work of one thread, so a thread casts at most 256 shadow rays or
//! long tests per launch, and later launches continue where it stopped. Kernels that only count, list or sum use a single launch.

use std::ops::Range;

use lightmesh_kernels::{Kernel, Runtime};

use super::device::Cuda;
use super::rates::{Timing, Work};
use crate::error::RenderError;
use crate::render_context::RenderContext;

impl<R: Runtime> Cuda<R> {
    /// Calls `launch` with consecutive ranges of the units of work, each to be queued as one launch of `kernel` and as large as the
    /// kernel's speed allows. Informs the observer, and fails if it requests cancellation.
    ///
    /// A unit must not take long: pieces of fewer units than run concurrently are no faster, however small they are.
    pub(crate) fn in_pieces(
        &self,
        context: &RenderContext,
        kernel: Kernel,
        work: Work,
        mut launch: impl FnMut(Range<u64>) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let Work { units, cost, progress, .. } = work;
        let mut done = 0;
        while done < units {
            context.check()?;
            let piece = self.rates.piece(kernel, &work).min(units - done);
            let from = self.mark()?;
            launch(done..done + piece)?;
            let timing = Timing { kernel, cost: piece * cost, from, to: self.mark()? };
            self.rates.remember(timing);
            done += piece;
            if done < units {
                self.rates.settle(&self.pool)?;
            }
            context.advance(progress * done / units - progress * (done - piece) / units);
        }
        Ok(())
    }
}
