//! Launches in pieces: short enough for a desktop's watchdog, with an opportunity to cancel in between.

use std::ops::Range;

use super::device::Cuda;
use super::rates::{Timing, Work};
use crate::cuda::{Kernel, Runtime};
use crate::error::RenderError;
use crate::job::Job;

impl<R: Runtime> Cuda<R> {
    /// Calls `launch` with consecutive ranges of the units of work, each to be queued as one launch of `kernel` and as large as the
    /// kernel's speed allows. Informs the observer, and fails if it requests cancellation.
    ///
    /// A unit must not take long: pieces of fewer units than run concurrently are no faster, however small they are.
    pub(crate) fn in_pieces(
        &self,
        job: &Job,
        kernel: Kernel,
        work: Work,
        mut launch: impl FnMut(Range<u64>) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let Work { units, cost, progress, .. } = work;
        let mut done = 0;
        while done < units {
            job.check()?;
            let piece = self.rates.piece(kernel, &work).min(units - done);
            let from = self.mark()?;
            launch(done..done + piece)?;
            let timing = Timing { kernel, cost: piece * cost, from, to: self.mark()? };
            self.rates.remember(timing);
            done += piece;
            if done < units {
                self.rates.settle(&self.pool)?;
            }
            job.advance(progress * done / units - progress * (done - piece) / units);
        }
        Ok(())
    }
}
