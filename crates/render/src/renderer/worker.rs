//! What several devices that work together have in common.

use std::sync::Arc;

use super::frame::Frame;
use crate::cache::MeshCache;
use crate::error::RenderError;
use crate::observer::Observer;
use crate::prepared::PreparedScene;
use crate::settings::Settings;

/// A device that renders with others.
pub trait Worker: Send + Sync {
    /// What it is called.
    fn name(&self) -> String;

    /// The id of its device; `None`: the host.
    fn id(&self) -> Option<u64>;

    /// Renders an image, or a part of one.
    ///
    /// # Errors
    /// As [`Renderer::render_with`](crate::Renderer::render_with).
    fn render(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError>;

    /// Renders a part of an image to be put together with others. The frame may have pixels around that part, which are not exact.
    ///
    /// # Errors
    /// As [`Worker::render`].
    fn render_around(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        self.render(cache, scene, settings, observer)
    }

    /// Waits until it can render, or it `is_over`, which is asked again after each [`Worker::nudge`]. `false`: it takes no part.
    ///
    /// # Errors
    /// Why it never can render. That is said once; then it takes no part.
    fn wake(&self, is_over: &dyn Fn() -> bool) -> Result<bool, RenderError> {
        let _ = is_over;
        Ok(true)
    }

    /// Lets those who wait for it ask again.
    fn nudge(&self) {}
}

impl<W: Worker + ?Sized> Worker for Arc<W> {
    fn name(&self) -> String {
        (**self).name()
    }

    fn id(&self) -> Option<u64> {
        (**self).id()
    }

    fn render(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        (**self).render(cache, scene, settings, observer)
    }

    fn render_around(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        (**self).render_around(cache, scene, settings, observer)
    }

    fn wake(&self, is_over: &dyn Fn() -> bool) -> Result<bool, RenderError> {
        (**self).wake(is_over)
    }

    fn nudge(&self) {
        (**self).nudge();
    }
}
