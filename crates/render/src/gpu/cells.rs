//! Surface points grouped by cell, on a device.

use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::mesh::Item;

/// The surface points of a wave grouped by cell and split into items: up to 32 surface points of one cell, the work of one
/// warp.
pub struct DeviceCells<R: Runtime> {
    /// Ray numbers by slot.
    pub(crate) members: Buffer<R, u32>,
    pub(crate) items: Buffer<R, Item>,
    /// Number of items.
    pub(crate) count: usize,
}
