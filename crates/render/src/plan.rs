//! The image to render, and the memory limits.

use lightmesh_trace::accel::Hit;

use crate::antialiasing::Antialiasing;
use crate::data::lights::LightGroups;
use crate::data::mattes::{ranks_of, slots_of};
use crate::settings::Glass;
use crate::stages::irradiance_cache::Gathering;

/// Bytes that a technique needs per ray at its peak, on the host and on a device, with the shares of lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BytesPerRay {
    /// If the host computes.
    pub host: u64,
    /// On a device.
    pub device: u64,
}

/// The image to render, and the memory limits.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The samples of pixels; `None`: their centres.
    pub antialiasing: Option<Antialiasing>,
    /// Depth of mirror recursion.
    pub bounces: u32,
    /// Whether rays may go through surfaces.
    pub is_transmissive: bool,
    /// What these do to shadows.
    pub glass: Glass,
    /// In how many directions mirrors reflect a ray, at most.
    pub directions: u32,
    /// Whether the share of a pixel's samples that see anything is kept.
    pub coverage: bool,
    /// Whether the light that shadow catchers get is kept.
    pub caught: bool,
    /// Number of lights whose layers are kept; `None`: no layers.
    pub layers: Option<usize>,
    /// Whether these have what compositors need, too: the radiance of each light by itself, numbers and mattes of objects and materials.
    pub compositing: bool,
    /// How light is gathered; `None`: ambient light is constant.
    pub gathering: Option<Gathering>,
    /// Groups of lights whose visibility is held at the same time.
    pub lights: LightGroups,
    /// Most rows to render at once; `None`: as many as fit into memory.
    pub most_rows: Option<u32>,
    /// Memory limit in bytes; `None`: what is free, less a reserve.
    pub memory_limit: Option<u64>,
    /// Bytes that the host could still allocate before the image was; `None`: unknown.
    pub left: Option<u64>,
    /// Bytes that the caller keeps from image to image, in the backend's memory.
    pub kept: u64,
    /// Bytes that may be added to these.
    pub reserved: u64,
    /// The additional bytes that the technique needs per ray.
    pub bytes_per_ray: BytesPerRay,
}

impl Plan {
    /// Pixels of the image.
    pub fn pixels(&self) -> u64 {
        self.size.map(u64::from).iter().product()
    }

    /// Whether light is asked for what surfaces leave of it.
    pub(crate) fn transmits(&self) -> bool {
        self.is_transmissive && self.glass == Glass::Tinted
    }

    /// The rays of a pixel in a wave, at most unless surfaces both mirror and let rays through several times.
    pub(crate) fn rays_per_pixel(&self) -> u64 {
        let samples = self.antialiasing.as_ref().map_or(1, |all| u64::from(all.at_once()));
        samples * (u64::from(self.directions) + u64::from(self.is_transmissive))
    }

    /// Bytes of the samples of a pixel: a hit and an owner each, the hit of its centre once more, and its state.
    pub(crate) fn sample_bytes(&self) -> u64 {
        self.antialiasing
            .as_ref()
            .map_or(0, |all| (size_of::<Hit>() as u64 + 1) * u64::from(all.at_once()) + size_of::<Hit>() as u64 + 8)
    }

    /// Rows above and below a band that are rendered with it, together.
    pub(crate) fn margin_rows(&self) -> u64 {
        let margin = self.antialiasing.as_ref().map_or(0, Antialiasing::margin);
        2 * u64::from(margin)
    }

    /// Bytes of the image with its layers.
    pub(crate) fn image_bytes(&self) -> u64 {
        self.pixels() * self.film_bytes()
    }

    /// Bytes of an image per pixel.
    #[doc(hidden)]
    pub fn film_bytes(&self) -> u64 {
        12 + 4 * (u64::from(self.coverage) + u64::from(self.caught))
            + self.layers.map_or(0, |lights| 32 + 4 * lights as u64 + self.compositing_bytes(lights as u64))
    }

    /// Samples of a pixel.
    pub(crate) fn pixel_samples(&self) -> u32 {
        self.antialiasing.as_ref().map_or(1, |all| all.samples)
    }

    /// What compositors need of `lights` lights: colours of each, and of the rest; of objects and of materials a number, and the numbers and
    /// shares of ranks, and of slots while samples are counted.
    fn compositing_bytes(&self, lights: u64) -> u64 {
        if !self.compositing {
            return 0;
        }
        let samples = self.pixel_samples();
        let slots = if samples > 1 { slots_of(samples) } else { 0 };
        12 * (lights + 1) + 2 * (4 + 8 * (ranks_of(samples) + slots) as u64)
    }
}
