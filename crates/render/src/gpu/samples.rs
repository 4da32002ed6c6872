//! The samples of pixels on a device.

use std::sync::Arc;

use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::geometry::Hit;
use lightmesh_layout::stages::PixelSamples;

/// What some samples of each pixel of some rows see.
pub struct DeviceSamples<R: Runtime> {
    /// Sample by sample, then by pixel.
    pub(crate) hits: Arc<Buffer<R, Hit>>,
    /// The state of each pixel, to which the arguments point.
    pub(crate) _state: Buffer<R, u32>,
    /// The owner of each sample, to which they point, too.
    pub(crate) _owners: Buffer<R, u8>,
    /// The arguments of kernels.
    pub(crate) record: PixelSamples,
}

/// The same, as far as shading needs it.
pub(crate) struct DeviceSampled<R: Runtime> {
    pub(crate) hits: Arc<Buffer<R, Hit>>,
    /// The first pixel.
    pub(crate) first: u32,
    /// Number of pixels.
    pub(crate) pixels: u64,
    /// Samples of a pixel.
    pub(crate) count: u32,
}
