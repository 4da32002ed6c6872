//! Step 1: what does each ray see?
//!
//! In: rays. Out: the closest hit of each, in the order of the rays. Rays from mirrors take the same way as rays from the
//! camera.

pub(crate) mod cpu;
pub(crate) mod cuda;

use glam::Vec3;

use crate::accel::{Hit, Ray};
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;

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

/// The object point that ray number `ray` sees; the ray must have hit something.
#[inline(always)]
pub(crate) fn object_point(scene: &PreparedScene, list: &RayList, hits: &[Hit], ray: usize) -> SurfacePoint {
    SurfacePoint::new(&list.rays[ray], &hits[ray], &scene.triangles[hits[ray].triangle as usize])
}
