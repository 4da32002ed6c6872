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

    /// Lets it ask again whether it is still needed, if it waits until it can work.
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

    fn nudge(&self) {
        (**self).nudge();
    }
}
