//! What all gathering needs.

use crate::job::Job;
use crate::prepared::PreparedScene;

/// A scene, and the image that is rendered.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) job: &'a Job<'a>,
    pub(super) scene: &'a PreparedScene,
    /// How many rays are cast at once, about.
    pub(super) rays_at_once: usize,
}
