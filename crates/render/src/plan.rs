//! The image to render, and the memory limits.

use crate::data::lights::LightGroups;

/// Bytes that a technique needs per ray at its peak, on the host and on a device, with the shares of lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Footprint {
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
    /// Depth of mirror recursion.
    pub bounces: u32,
    /// Number of lights whose layers are kept; `None`: no layers.
    pub layers: Option<usize>,
    /// Groups of lights whose visibility is held at the same time.
    pub lights: LightGroups,
    /// Memory limit in bytes; `None`: what is free, less a reserve.
    pub memory_limit: Option<u64>,
    /// Bytes that the caller keeps from image to image, in the backend's memory.
    pub kept: u64,
    /// The additional bytes that the technique needs per ray.
    pub footprint: Footprint,
}

impl Plan {
    /// Pixels of the image.
    pub fn pixels(&self) -> u64 {
        self.size.map(u64::from).iter().product()
    }

    /// Bytes of an image per pixel.
    pub(crate) fn film_bytes(&self) -> u64 {
        12 + self.layers.map_or(0, |lights| 32 + 4 * lights as u64)
    }
}
