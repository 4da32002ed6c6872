//! What the launches of gathered light share.

use bytemuck::Pod;
use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::constants::{BLOCK, FOUND_TRIANGLES, WARP};

use crate::error::RenderError;
use crate::gpu::rays::DeviceWave;
use crate::gpu::{Cuda, PerStructure, blocks_for, warps_for};
use crate::stages::irradiance_cache::hemisphere_rays::HemisphereRays;

/// What all launches need.
pub(super) struct Device<'a, R: Runtime> {
    pub(super) cuda: &'a Cuda<R>,
    pub(super) wave: &'a DeviceWave<'a, R>,
    /// Rays that are cast at once.
    pub(super) rays: usize,
}

impl<R: Runtime> Device<'_, R> {
    /// How many records cast rays at once.
    pub(super) fn at_once(&self, hemisphere: HemisphereRays) -> usize {
        (self.rays / hemisphere.len()).max(1)
    }

    /// Launches a kernel with a thread for each of `count` units.
    pub(super) fn threads<A: Pod>(&self, name: &'static str, count: usize, arguments: &A) -> Result<(), RenderError> {
        self.launch(Kernel { module: "irradiance_cache", name }, count.div_ceil(BLOCK as usize), arguments)
    }

    /// Launches a kernel with a warp for each.
    pub(super) fn warps<A: Pod>(&self, name: &'static str, count: usize, arguments: &A) -> Result<(), RenderError> {
        self.launch(Kernel { module: "irradiance_cache", name }, count.div_ceil((BLOCK / WARP) as usize), arguments)
    }

    /// Launches a kernel that asks the acceleration structure, with a thread for each.
    pub(super) fn tracing<A: Pod>(&self, kernel: PerStructure, count: usize, arguments: &A) -> Result<(), RenderError> {
        self.launch(kernel.of(self.wave.scene), count.div_ceil(BLOCK as usize), arguments)
    }

    fn launch<A: Pod>(&self, kernel: Kernel, blocks: usize, arguments: &A) -> Result<(), RenderError> {
        if blocks == 0 {
            return Ok(());
        }
        self.cuda.launch(kernel, blocks_for(&(0..blocks as u64), BLOCK), arguments)
    }

    /// Launches a kernel that searches the acceleration structure, with a warp for each.
    pub(super) fn searching<A: Pod>(
        &self,
        kernel: PerStructure,
        count: usize,
        arguments: &A,
    ) -> Result<(), RenderError> {
        if count == 0 {
            return Ok(());
        }
        let words = FOUND_TRIANGLES + self.wave.scene.search_words();
        self.cuda.launch(kernel.of(self.wave.scene), warps_for(&(0..count as u64), 1, words), arguments)
    }
}

/// Reads a count on the device. Waits for all work queued before.
pub(super) fn read_count<R: Runtime>(count: &Buffer<R, u32>) -> Result<usize, RenderError> {
    let mut value = [0];
    count.read_into(0, &mut value)?;
    Ok(value[0] as usize)
}
