//! Occluder lists on a CUDA device: a warp for each item.

use lightmesh_layout::constants::{
    FOUND_TRIANGLES, MOST_WORDS, OCCLUDER_PARTS, PLANE_WORDS, ROW_TABLE_WORDS, SEARCHED_WORDS, WARP,
};
use lightmesh_layout::stages::Shadows;

use crate::cuda::Runtime;
use crate::error::RenderError;
use crate::gpu::items::DeviceItems;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{Cuda, per_structure};
use crate::shadow::Aim;
use crate::shadow::launch::{ByWords, WarpWork, test_samples};

const KERNELS: ByWords = [
    (1, per_structure!("occluder_lists", "shadows_1")),
    (3, per_structure!("occluder_lists", "shadows_3")),
    (MOST_WORDS, per_structure!("occluder_lists", "shadows_10")),
];
/// Items of the very first launches.
const FIRST_ITEMS: u64 = 4096;

pub(crate) fn occluder_lists<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    items: &DeviceItems<R>,
    aim: &Aim,
) -> Result<DeviceVisibility<R>, RenderError> {
    // See `ListMemory` in item.cuh.
    let words = 4 * OCCLUDER_PARTS * WARP + SEARCHED_WORDS + PLANE_WORDS + FOUND_TRIANGLES + 2 * ROW_TABLE_WORDS;
    let work = WarpWork { warps: items.count as u64, first: FIRST_ITEMS, words };
    test_samples(cuda, wave, aim, (&KERNELS, work), |record| Shadows {
        members: items.members.input(),
        items: items.items.input(),
        ..record
    })
}
