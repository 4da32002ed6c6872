//! The reference on a CUDA device: a warp for 32 surface points, one after the other.

use lightmesh_kernels::Runtime;
use lightmesh_layout::constants::{FOUND_TRIANGLES, MAX_WORDS, PLANE_WORDS, ROW_TABLE_WORDS, SHAFT_WORDS, WARP};

use crate::error::RenderError;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, per_structure};
use crate::shadow::ShadowTarget;
use crate::shadow::launch::{ByWords, WarpWork, test_samples};

const KERNELS: ByWords = [
    (1, per_structure!("area_shadows", "area_shadows_1")),
    (3, per_structure!("area_shadows", "area_shadows_3")),
    (MAX_WORDS, per_structure!("area_shadows", "area_shadows_10")),
];
/// Warps of the very first launches.
const FIRST_WARPS: u64 = 4096;

/// The visible share of each light from each surface point.
pub(crate) fn area_shadows<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    target: &ShadowTarget,
) -> Result<DeviceVisibility<R>, RenderError> {
    let warps = wave.rays.blocks(BLOCK_SIDE) * u64::from(BLOCK / WARP);
    let work = WarpWork {
        units: warps,
        taken: None,
        first: FIRST_WARPS,
        progress: wave.rays.len() as u64,
        words: PLANE_WORDS + SHAFT_WORDS + FOUND_TRIANGLES + 2 * ROW_TABLE_WORDS,
    };
    test_samples(cuda, wave, target, (&KERNELS, work), |record| record)
}
