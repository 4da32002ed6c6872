//! Rays, and the surface points that they see.

use glam::Vec3;

use crate::accel::{Hit, Ray, Triangle};
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;
use crate::view::View;

/// Rays with the pixels that they contribute to. Each pixel has at most one ray in a list.
#[derive(Clone, Debug, Default)]
pub struct RayList {
    /// The rays; directions have unit length.
    pub rays: Vec<Ray>,
    /// The pixel of each ray, y · width + x.
    pub pixels: Vec<u32>,
    /// The share of a ray's radiance that reaches its pixel. Empty for camera rays, which contribute all of it.
    pub weights: Vec<Vec3>,
    /// The distance between the surface points of neighbouring pixels that face the camera: a constant, and a multiple of the distance from
    /// the camera. Zero if the rays are not a camera's.
    pub spacing: [f32; 2],
    /// The camera and its image, all pixels of some rows; `None` if the rays are not a camera's.
    pub view: Option<View>,
    /// The triangles that the rays hit in place of the scene's, if they come from given points; else empty.
    pub probes: Vec<Triangle>,
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

    /// The key that distinguishes the random patterns of two surface points: the pixel, and whether it is seen in a mirror.
    pub(crate) fn key(&self, ray: usize) -> u64 {
        u64::from(self.pixels[ray]) << 1 | u64::from(!self.from_camera())
    }
}

/// The surface point that ray number `ray` sees; the ray must have hit something.
#[inline(always)]
pub(crate) fn surface_point_of(scene: &PreparedScene, list: &RayList, hits: &[Hit], ray: usize) -> SurfacePoint {
    let triangles = if list.probes.is_empty() { &scene.geometry.triangles } else { &list.probes };
    SurfacePoint::new(&list.rays[ray], &hits[ray], &triangles[hits[ray].triangle as usize])
}
