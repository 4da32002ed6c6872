//! The scene around lamps.

use glam::DVec3;

use crate::Bounds;

/// How far lights lie in front of their surface, relative to its size and to the scene's.
pub(super) const RAISED: [f64; 2] = [1e-5, 1e-5];

/// The scene around.
pub(super) struct Extent {
    pub(super) bounds: Bounds,
    pub(super) middle: DVec3,
    pub(super) diagonal: f64,
}
