//! Step 1: what does each ray see?
//!
//! In: rays. Out: the closest hit of each, in the order of the rays. Rays from mirrors take the same way as rays from the
//! camera.

pub(crate) mod cpu;

use glam::Vec3;

use crate::accel::Ray;

/// Rays with the pixels that they bring light to. Each pixel has at most one ray in a list.
#[derive(Clone, Debug, Default)]
pub struct RayList {
    /// The rays; directions have unit length.
    pub rays: Vec<Ray>,
    /// The pixel of each ray, y · width + x.
    pub pixels: Vec<u32>,
    /// The share of a ray's radiance that reaches its pixel. Empty: all of it, the rays come from the camera.
    pub weights: Vec<Vec3>,
}

impl RayList {
    /// The share of the radiance of ray `index` that reaches its pixel.
    #[inline(always)]
    pub fn weight(&self, index: usize) -> Vec3 {
        self.weights.get(index).copied().unwrap_or(Vec3::ONE)
    }

    /// Whether the rays come from the camera.
    pub fn from_camera(&self) -> bool {
        self.weights.is_empty()
    }
}
