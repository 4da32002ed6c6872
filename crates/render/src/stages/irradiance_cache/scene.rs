//! What all gathering needs.

use crate::prepared::PreparedScene;
use crate::render_context::RenderContext;

/// A scene, and the image that is rendered.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) context: &'a RenderContext<'a>,
    pub(super) scene: &'a PreparedScene,
    /// How many rays are cast at once, about.
    pub(super) rays_at_once: usize,
}
