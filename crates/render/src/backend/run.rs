//! The one place where stages are run: clocks, progress and cancelling wrap each of them here.

use std::cell::{Cell, RefCell};

use super::Backend;
use crate::cache::Kept;
use crate::error::RenderError;
use crate::job::Job;
use crate::stage::Stage;

/// A picture in the making on a backend.
pub(crate) struct Run<'a, B: Backend> {
    pub(crate) backend: &'a B,
    pub(crate) job: &'a Job<'a>,
    /// What the caller keeps from picture to picture.
    kept: Option<RefCell<&'a mut Kept<B::Table>>>,
    /// Memory was short: the rest of the picture does without.
    is_short: Cell<bool>,
}

impl<'a, B: Backend> Run<'a, B> {
    /// Nothing is done yet.
    pub(crate) fn new(backend: &'a B, job: &'a Job<'a>, kept: Option<&'a mut Kept<B::Table>>) -> Run<'a, B> {
        Run { backend, job, kept: kept.map(RefCell::new), is_short: Cell::new(false) }
    }

    /// Runs one stage over a wave of `rays` rays, which has `pieces` pieces of work: tells the observer, lets the backend take the time,
    /// and fails if the observer has asked to stop.
    pub(crate) fn stage<T>(
        &self,
        stage: Stage,
        [rays, pieces]: [usize; 2],
        work: impl FnOnce(&'a B) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        let Run { backend, job, .. } = *self;
        job.check()?;
        job.work.begin(job.observer, stage, pieces as u64, rays as u64);
        let result = backend.timed(job, stage, || work(backend));
        job.work.end(job.observer, stage);
        let result = result?;
        job.check()?;
        Ok(result)
    }

    /// Does something with what the caller keeps.
    pub(crate) fn with_kept<T>(&self, work: impl FnOnce(Option<&mut Kept<B::Table>>) -> T) -> T {
        match &self.kept {
            Some(kept) if !self.is_short.get() => work(Some(&mut kept.borrow_mut())),
            _ => work(None),
        }
    }

    /// Whether the caller keeps anything.
    pub(crate) fn keeps(&self) -> bool {
        self.with_kept(|kept| kept.is_some())
    }

    /// Frees what the caller keeps, and says so: the rest of the picture does without. `false` where it does already.
    pub(crate) fn forget(&self) -> bool {
        let kept = self.keeps();
        if kept {
            self.with_kept(|kept| kept.map(Kept::clear));
            self.is_short.set(true);
            self.job.observer.note("device memory is short: what was known of light points is forgotten");
        }
        kept
    }

    /// Does something that may find the device's memory taken by what is kept.
    pub(crate) fn or_forget<T>(&self, work: impl Fn(&'a B) -> Result<T, RenderError>) -> Result<T, RenderError> {
        match work(self.backend) {
            Err(RenderError::DeviceMemory { .. }) if self.forget() => work(self.backend),
            result => result,
        }
    }

    /// Runs a stage that takes time on the host alone, such as a copy.
    pub(crate) fn on_host<T>(
        &self,
        stage: Stage,
        work: impl FnOnce(&'a B) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        let Run { backend, job, .. } = *self;
        job.work.begin(job.observer, stage, 1, 0);
        let result = job.wall_time(stage, || work(backend));
        job.work.end(job.observer, stage);
        result
    }
}
