//! What picture is to be made, and within what memory.

/// Bytes that a technique needs for each ray when it holds most, on the host and on a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Footprint {
    /// Where the host computes.
    pub host: u64,
    /// On a device.
    pub device: u64,
}

/// What picture is to be made, and within what memory.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Depth of mirror recursion.
    pub bounces: u32,
    /// Number of lights whose layers are kept; `None`: no layers.
    pub layers: Option<usize>,
    /// Bytes to stay under; `None`: what is free, less a reserve.
    pub memory_limit: Option<u64>,
    /// Bytes that the caller keeps from picture to picture, where the backend computes.
    pub kept: u64,
    /// What the technique adds for each ray.
    pub footprint: Footprint,
}

impl Plan {
    /// Pixels of the picture.
    pub fn pixels(&self) -> u64 {
        self.size.map(u64::from).iter().product()
    }

    /// Bytes of a picture per pixel.
    pub(crate) fn film_bytes(&self) -> u64 {
        12 + self.layers.map_or(0, |lights| 32 + 4 * lights as u64)
    }
}
