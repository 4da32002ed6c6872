//! Runs stages, all in this one place: timing, progress and cancellation are handled here for all of them.

use std::cell::{Cell, RefCell};

use super::Backend;
use crate::cache::Cache;
use crate::error::RenderError;
use crate::prepared::PreparedScene;
use crate::render_context::RenderContext;
use crate::stage::Stage;
use crate::stages::irradiance_cache::Sources;

/// An image being rendered on a backend.
pub(crate) struct StageRunner<'a, B: Backend> {
    pub(crate) backend: &'a B,
    pub(crate) context: &'a RenderContext<'a>,
    /// What the caller keeps from image to image.
    cache: Option<RefCell<&'a mut Cache<B::Table>>>,
    /// Memory ran short: the rest of the image is rendered without it.
    is_short: Cell<bool>,
    /// What the image gathers.
    gathered: RefCell<B::SurfaceLight>,
}

impl<'a, B: Backend> StageRunner<'a, B> {
    /// A runner that has not started.
    pub(crate) fn new(
        backend: &'a B,
        context: &'a RenderContext<'a>,
        cache: Option<&'a mut Cache<B::Table>>,
    ) -> StageRunner<'a, B> {
        StageRunner {
            backend,
            context,
            cache: cache.map(RefCell::new),
            is_short: Cell::new(false),
            gathered: RefCell::default(),
        }
    }

    /// Runs one stage over a wave of `rays` rays, which counts as `pieces` pieces of work: informs the observer, lets the backend
    /// measure the time, and fails if the observer has requested cancellation.
    pub(crate) fn stage<T>(
        &self,
        stage: Stage,
        [rays, pieces]: [usize; 2],
        work: impl FnOnce(&'a B) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        self.counted_stage(stage, (rays as f64, pieces), work)
    }

    /// The same, where its part of the image's work is not that of its rays.
    pub(crate) fn counted_stage<T>(
        &self,
        stage: Stage,
        (counted, pieces): (f64, usize),
        work: impl FnOnce(&'a B) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        let StageRunner { backend, context, .. } = *self;
        context.check()?;
        context.work.begin(context.observer, stage, pieces as u64, counted);
        let result = backend.timed(context, stage, || work(backend));
        context.work.end(context.observer, stage);
        let result = result?;
        context.check()?;
        Ok(result)
    }

    /// Runs `work` on what the caller keeps.
    pub(crate) fn with_cache<T>(&self, work: impl FnOnce(Option<&mut Cache<B::Table>>) -> T) -> T {
        match &self.cache {
            Some(cache) if !self.is_short.get() => work(Some(&mut cache.borrow_mut())),
            _ => work(None),
        }
    }

    /// Runs `work` on what the image gathers.
    pub(crate) fn with_gathered<T>(&self, work: impl FnOnce(&mut B::SurfaceLight) -> T) -> T {
        work(&mut self.gathered.borrow_mut())
    }

    /// Lets what the caller keeps of light points take its part of `left` bytes. Returns by how much it may grow.
    pub(crate) fn reserve(&self, left: Option<u64>) -> u64 {
        self.with_cache(|cache| cache.map_or(0, |cache| cache.reserve(left)))
    }

    /// Begins with what surfaces gathered for earlier images.
    pub(crate) fn lookup_gathered(&self, scene: &PreparedScene, sources: &Sources) {
        let known = self.with_cache(|cache| cache.map(|cache| cache.take_gathered(scene, sources)));
        self.gathered.replace(known.unwrap_or_default());
    }

    /// Keeps what surfaces gathered, if the caller keeps anything.
    pub(crate) fn insert_gathered(&self, scene: &PreparedScene, sources: Sources) {
        let light = self.gathered.take();
        self.with_cache(|cache| cache.map(|cache| cache.insert_gathered(scene, sources, light)));
    }

    /// Whether the caller keeps anything.
    pub(crate) fn has_cache(&self) -> bool {
        self.with_cache(|cache| cache.is_some())
    }

    /// Frees what the caller keeps and reports it: the rest of the image is rendered without it. Returns `false` if it already is.
    pub(crate) fn evict(&self) -> bool {
        let had_cache = self.has_cache();
        if had_cache {
            self.with_cache(|cache| cache.map(Cache::clear));
            self.is_short.set(true);
            self.context.observer.note("device memory is short: cached light points are dropped");
        }
        had_cache
    }

    /// Runs work that may fail because kept data occupies the device's memory.
    pub(crate) fn or_evict<T>(&self, work: impl Fn(&'a B) -> Result<T, RenderError>) -> Result<T, RenderError> {
        match work(self.backend) {
            Err(RenderError::DeviceMemory { .. }) if self.evict() => work(self.backend),
            result => result,
        }
    }

    /// Runs a stage that takes time on the host only, such as a copy.
    pub(crate) fn on_host<T>(
        &self,
        stage: Stage,
        work: impl FnOnce(&'a B) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        let StageRunner { backend, context, .. } = *self;
        context.work.begin(context.observer, stage, 1, 0.0);
        let result = context.wall_time(stage, || work(backend));
        context.work.end(context.observer, stage);
        result
    }
}
