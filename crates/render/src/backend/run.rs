//! The one place where stages run: timing, progress and cancellation are handled here for all of them.

use std::cell::{Cell, RefCell};

use super::Backend;
use crate::cache::Kept;
use crate::error::RenderError;
use crate::gathered::Sources;
use crate::job::Job;
use crate::prepared::PreparedScene;
use crate::stage::Stage;

/// An image being rendered on a backend.
pub(crate) struct Run<'a, B: Backend> {
    pub(crate) backend: &'a B,
    pub(crate) job: &'a Job<'a>,
    /// What the caller keeps from image to image.
    kept: Option<RefCell<&'a mut Kept<B::Table>>>,
    /// Memory ran short: the rest of the image is rendered without it.
    is_short: Cell<bool>,
    /// What the image gathers.
    gathered: RefCell<B::SurfaceLight>,
}

impl<'a, B: Backend> Run<'a, B> {
    /// A run that has not started.
    pub(crate) fn new(backend: &'a B, job: &'a Job<'a>, kept: Option<&'a mut Kept<B::Table>>) -> Run<'a, B> {
        Run { backend, job, kept: kept.map(RefCell::new), is_short: Cell::new(false), gathered: RefCell::default() }
    }

    /// Runs one stage over a wave of `rays` rays, which counts as `pieces` pieces of work: informs the observer, lets the backend
    /// measure the time, and fails if the observer has requested cancellation.
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

    /// Runs `work` on what the caller keeps.
    pub(crate) fn with_kept<T>(&self, work: impl FnOnce(Option<&mut Kept<B::Table>>) -> T) -> T {
        match &self.kept {
            Some(kept) if !self.is_short.get() => work(Some(&mut kept.borrow_mut())),
            _ => work(None),
        }
    }

    /// Runs `work` on what the image gathers.
    pub(crate) fn with_gathered<T>(&self, work: impl FnOnce(&mut B::SurfaceLight) -> T) -> T {
        work(&mut self.gathered.borrow_mut())
    }

    /// Lets what the caller keeps of light points take its part of `left` bytes. Returns by how much it may grow.
    pub(crate) fn begin_kept(&self, left: Option<u64>) -> u64 {
        self.with_kept(|kept| kept.map_or(0, |kept| kept.begin(left)))
    }

    /// Begins with what surfaces gathered for earlier images.
    pub(crate) fn recall_gathered(&self, scene: &PreparedScene, sources: &Sources) {
        let known = self.with_kept(|kept| kept.map(|kept| kept.take_gathered(scene, sources)));
        self.gathered.replace(known.unwrap_or_default());
    }

    /// Keeps what surfaces gathered, if the caller keeps anything.
    pub(crate) fn keep_gathered(&self, scene: &PreparedScene, sources: Sources) {
        let light = self.gathered.take();
        self.with_kept(|kept| kept.map(|kept| kept.keep_gathered(scene, sources, light)));
    }

    /// Whether the caller keeps anything.
    pub(crate) fn keeps(&self) -> bool {
        self.with_kept(|kept| kept.is_some())
    }

    /// Frees what the caller keeps and reports it: the rest of the image is rendered without it. Returns `false` if it already is.
    pub(crate) fn forget(&self) -> bool {
        let kept = self.keeps();
        if kept {
            self.with_kept(|kept| kept.map(Kept::clear));
            self.is_short.set(true);
            self.job.observer.note("device memory is short: cached light points are dropped");
        }
        kept
    }

    /// Runs work that may fail because kept data occupies the device's memory.
    pub(crate) fn or_forget<T>(&self, work: impl Fn(&'a B) -> Result<T, RenderError>) -> Result<T, RenderError> {
        match work(self.backend) {
            Err(RenderError::DeviceMemory { .. }) if self.forget() => work(self.backend),
            result => result,
        }
    }

    /// Runs a stage that takes time on the host only, such as a copy.
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
