//! Rays, and the surface points that they see.

use std::sync::Arc;

use glam::Vec3;
use lightmesh_layout::constants::{
    DIRECTION_SHIFT, FADE_SHIFT, MAX_DIRECTIONS, PARTS_OF_FADE, THROUGHS_MASK, THROUGHS_SHIFT,
};
use lightmesh_trace::accel::{Hit, Ray, Triangle};

use crate::antialiasing::Antialiasing;
use crate::data::clip::{Clip, Limits};
use crate::footprint::Cone;
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;
use crate::view::{View, Window};

/// What the samples of some pixels see.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// Their hits: pixel by pixel, then by sample.
    pub hits: Arc<Vec<Hit>>,
    /// The first pixel.
    pub first: u32,
    /// Samples of a pixel.
    pub count: usize,
}

impl Sampled {
    /// What those samples of a pixel see whose bits are set in `shared`.
    pub(crate) fn hits_of(&self, pixel: u32, shared: u32) -> impl Iterator<Item = &Hit> {
        let hits = self.hits[(pixel - self.first) as usize * self.count..][..self.count].iter();
        hits.enumerate().filter(move |(sample, hit)| shared >> sample & 1 != 0 && hit.is_some()).map(|(_, hit)| hit)
    }
}

/// Rays with the pixels that they contribute to. The rays of a pixel follow each other.
#[derive(Clone, Debug, Default)]
pub struct RayList {
    /// The rays; directions have unit length.
    pub rays: Vec<Ray>,
    /// The pixel of each ray, y · width + x of the window.
    pub pixels: Vec<u32>,
    /// The number of the pixel's sample that each ray goes through, and one; from bit [`DIRECTION_SHIFT`] on, which of a rough mirror's rays of this
    /// sample it is; from bit [`THROUGHS_SHIFT`] on, through how many surfaces it
    /// went; from bit [`FADE_SHIFT`] on, how much of lights it does not show. Empty for camera rays.
    pub samples: Vec<u32>,
    /// How often the rays went on at surfaces: through them or mirrored.
    pub depth: u32,
    /// How often rays are mirrored at most.
    pub bounces: u32,
    /// The samples of its pixel that are shaded with each ray, a bit each; 0 if none are. Empty for camera rays, with which all
    /// are.
    pub shared: Vec<u32>,
    /// What the pixels' samples see, if they have several.
    pub sampled: Option<Sampled>,
    /// The share of a ray's radiance that reaches its pixel. Empty for camera rays, which contribute all of it.
    pub weights: Vec<Vec3>,
    /// The distance between the surface points of neighbouring pixels that face the camera: a constant, and a multiple of the
    /// distance from the camera. Zero if the rays do not come from a camera.
    pub spacing: [f32; 2],
    /// Where the camera is.
    pub eye: Vec3,
    /// The depths that are seen by rays that no mirror reflected.
    pub clip: Clip,
    /// The cone around each ray, if they have none of their own.
    pub cone: Cone,
    /// The cone around each ray that a mirror reflected, where textures need them; else empty.
    pub cones: Vec<Cone>,
    /// The camera and its image, all pixels of some rows; `None` if the rays are not a camera's.
    pub view: Option<View>,
    /// The pixels among those of the image.
    pub window: Window,
    /// The triangles that the rays hit in place of the scene's, if they come from given points; else empty.
    pub probes: Vec<Triangle>,
}

impl RayList {
    /// The share of the radiance of ray `index` that reaches its pixel.
    #[inline(always)]
    pub fn weight(&self, index: usize) -> Vec3 {
        self.weights.get(index).copied().unwrap_or(Vec3::ONE)
    }

    /// The cone around a ray.
    #[inline(always)]
    pub(crate) fn cone_of(&self, ray: usize) -> Cone {
        self.cones.get(ray).copied().unwrap_or(self.cone)
    }

    /// Through how many surfaces a ray went.
    pub(crate) fn throughs(&self, ray: usize) -> u32 {
        self.sample(ray) >> THROUGHS_SHIFT & THROUGHS_MASK
    }

    /// The number of a ray among those of its pixel: by the pixel's sample that it goes through, then by its direction from a rough mirror.
    pub(crate) fn number_in_pixel(&self, ray: usize) -> u32 {
        let sample = (self.sample(ray) & ((1 << DIRECTION_SHIFT) - 1)).saturating_sub(1);
        let direction = self.sample(ray) >> DIRECTION_SHIFT & (MAX_DIRECTIONS - 1);
        if self.is_mirrored(ray) { sample * MAX_DIRECTIONS + direction } else { sample }
    }

    /// The same as [`sample`](RayList::sample), of a ray that shows all of lights.
    pub(crate) fn unfaded(&self, ray: usize) -> u32 {
        self.sample(ray) & ((1 << FADE_SHIFT) - 1)
    }

    /// The share of lights that a ray shows: [highlights](crate::shading::facets) on the rough mirror that it comes from show the rest.
    #[inline(always)]
    pub(crate) fn lights_share(&self, ray: usize) -> f32 {
        1.0 - (self.sample(ray) >> FADE_SHIFT) as f32 / PARTS_OF_FADE as f32
    }

    /// Whether a mirror reflected a ray.
    pub(crate) fn is_mirrored(&self, ray: usize) -> bool {
        self.depth > self.throughs(ray)
    }

    /// The part of a ray on which surfaces are seen: mirrors show all of it.
    #[inline(always)]
    pub(crate) fn limits(&self, ray: usize) -> Limits {
        if !self.clip.cuts() || self.is_mirrored(ray) { Limits::NONE } else { self.clip.limits(&self.rays[ray]) }
    }

    /// Whether the mirror ray of what a ray sees is followed.
    pub(crate) fn mirrors(&self, ray: usize) -> bool {
        self.depth - self.throughs(ray) < self.bounces
    }

    /// The angle of the cone around a ray; of those of all samples that are shaded with it, if there are several.
    #[inline(always)]
    pub(crate) fn spread_of(&self, ray: usize) -> f32 {
        self.cone_of(ray).spread.abs() * self.samples_of(ray).sqrt()
    }

    /// How many samples are shaded with a ray.
    #[inline(always)]
    pub(crate) fn samples_of(&self, ray: usize) -> f32 {
        match (&self.sampled, self.shared.get(ray)) {
            (Some(sampled), None) if self.from_camera() => sampled.count as f32,
            (_, Some(shared)) => shared.count_ones().max(1) as f32,
            _ => 1.0,
        }
    }

    /// What the samples of its pixel see that are shaded with a ray, if any are.
    pub(crate) fn shared_hits(&self, ray: usize) -> Option<impl Iterator<Item = &Hit>> {
        let shared = self.shared.get(ray).copied().unwrap_or(u32::MAX);
        let sampled = self.sampled.as_ref().filter(|_| shared != 0)?;
        Some(sampled.hits_of(self.pixels[ray], shared))
    }

    /// Whether textures are filtered.
    pub(crate) fn has_cones(&self) -> bool {
        !self.cones.is_empty() || !self.cone.is_point()
    }

    /// An empty list of rays from the same camera.
    pub(crate) fn empty(&self) -> RayList {
        RayList { cone: self.cone, ..self.beyond() }
    }

    /// An empty list of rays that go on from these, as often as these.
    pub(crate) fn beyond(&self) -> RayList {
        RayList {
            window: self.window,
            depth: self.depth,
            bounces: self.bounces,
            spacing: self.spacing,
            eye: self.eye,
            clip: self.clip,
            ..RayList::default()
        }
    }

    /// About how wide a pixel is at a surface point.
    #[inline(always)]
    pub(crate) fn width_at(&self, position: Vec3) -> f32 {
        let [constant, factor] = self.spacing;
        constant + factor * (position - self.eye).length()
    }

    /// The ray through a sample of a pixel. The rays must be a camera's.
    #[inline(always)]
    pub(crate) fn through(&self, all: &Antialiasing, pixel: u32, sample: u32) -> Ray {
        all.ray(self.view.as_ref().expect("the rays are a camera's"), pixel, sample)
    }

    /// Makes room for `count` rays that go through samples of pixels.
    pub(crate) fn reserve(&mut self, count: usize) {
        self.rays.reserve_exact(count);
        self.pixels.reserve_exact(count);
        self.samples.reserve_exact(count);
        self.shared.reserve_exact(count);
        self.weights.reserve_exact(count);
    }

    /// Adds the rays of another list, which has the same data of each.
    pub(crate) fn append(&mut self, mut other: RayList) {
        self.rays.append(&mut other.rays);
        self.pixels.append(&mut other.pixels);
        self.samples.append(&mut other.samples);
        self.shared.append(&mut other.shared);
        self.weights.append(&mut other.weights);
        self.cones.append(&mut other.cones);
    }

    /// Whether the rays go through the centres of a camera's pixels.
    pub fn from_camera(&self) -> bool {
        self.weights.is_empty()
    }

    /// The number of the pixel's sample that a ray goes through, and one, with the rest of [`samples`](RayList::samples).
    pub(crate) fn sample(&self, ray: usize) -> u32 {
        self.samples.get(ray).copied().unwrap_or(0)
    }

    /// The key that distinguishes the random patterns of two surface points: the pixel, its sample, the surfaces on the way that let it
    /// through, and whether it is in a list, such as that of mirror rays.
    pub(crate) fn key(&self, ray: usize) -> u64 {
        let pixel = self.window.number(self.pixels[ray]);
        u64::from(self.sample(ray)) << 33 | u64::from(pixel) << 1 | u64::from(!self.from_camera())
    }
}

/// The surface point that ray number `ray` sees; the ray must have hit something.
#[inline(always)]
pub(crate) fn surface_point_of(scene: &PreparedScene, list: &RayList, hits: &[Hit], ray: usize) -> SurfacePoint {
    let index = hits[ray].triangle;
    let triangle = match list.probes.get(index as usize) {
        Some(probe) => *probe,
        None => scene.geometry.triangles.at(index),
    };
    SurfacePoint::new(&list.rays[ray], &hits[ray], &triangle)
}
