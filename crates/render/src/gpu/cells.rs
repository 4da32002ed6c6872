//! Surface points grouped by cell, on a device.

use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::mesh::Bundle;

/// The surface points of a wave grouped by cell and split into bundles: up to 32 surface points of one cell, the work of one
/// warp.
pub struct DeviceCells<R: Runtime> {
    /// Ray numbers by slot.
    pub(crate) members: Buffer<R, u32>,
    pub(crate) bundles: Buffer<R, Bundle>,
    /// Number of bundles.
    pub(crate) count: usize,
}
