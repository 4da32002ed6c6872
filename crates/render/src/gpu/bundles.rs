//! Surface points in small groups, on a device.

use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::stages::TileBox;

/// The surface points of a wave in bundles of up to 32 that lie close together, the work of one warp.
pub struct DeviceBundles<R: Runtime> {
    /// Ray numbers by slot, 1024 slots for each tile.
    pub(crate) members: Buffer<R, u32>,
    /// The first slot of each bundle, and how many follow: slot · 64 + number.
    pub(crate) bundles: Buffer<R, u64>,
    /// Number of bundles.
    pub(crate) count: usize,
    /// The boxes around the surface points of each tile.
    pub(crate) tiles: Buffer<R, TileBox>,
}
