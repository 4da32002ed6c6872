//! Occluder lists on a CUDA device: a warp for each bundle.

use lightmesh_kernels::Runtime;
use lightmesh_layout::constants::{
    FOUND_TRIANGLES, MAX_SEARCH_ROOTS, MAX_WORDS, OCCLUDER_PARTS, PLANE_WORDS, ROW_TABLE_WORDS, SEARCHED_WORDS, WARP,
};
use lightmesh_layout::stages::Shadows;

use crate::error::RenderError;
use crate::gpu::bundles::DeviceBundles;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{Cuda, PerStructure, Work, blocks_for, per_structure};
use crate::shadow::ShadowTarget;
use crate::shadow::launch::{ByWords, WarpWork, arguments, test_samples};

const KERNELS: ByWords = [
    (1, per_structure!("occluder_lists", "shadows_1")),
    (3, per_structure!("occluder_lists", "shadows_3")),
    (MAX_WORDS, per_structure!("occluder_lists", "shadows_10")),
];
const STARTS: PerStructure = per_structure!("occluder_lists", "find_starts");
/// Tiles times lights in the very first launch.
const FIRST_STARTS: u64 = 4096;
/// Bundles of the very first launches.
const FIRST_BUNDLES: u64 = 4096;

pub(crate) fn occluder_lists<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    bundles: &DeviceBundles<R>,
    target: &ShadowTarget,
) -> Result<DeviceVisibility<R>, RenderError> {
    let pool = cuda.pool();
    let units = bundles.tiles.len() as u64 * wave.group().len() as u64;
    let starts = pool.room::<u32>("starts of searches", units as usize * (MAX_SEARCH_ROOTS as usize + 1))?;
    let taken = pool.room::<u32>("taken bundles", 1)?;
    let complete = |record| Shadows {
        members: bundles.members.input(),
        bundles: bundles.bundles.input(),
        tiles: bundles.tiles.input(),
        starts: starts.output(),
        taken: taken.output(),
        ..record
    };
    // Where the searches of a tile's bundles start.
    let record = complete(arguments(cuda, wave)?);
    let kernel = STARTS.of(wave.scene);
    cuda.in_pieces(wave.context, kernel, Work { units, cost: 1, first: FIRST_STARTS, progress: 0 }, |piece| {
        cuda.launch(kernel, blocks_for(&piece, WARP), &Shadows { first: piece.start, ..record })
    })?;
    // The bundles. See `ListMemory` in bundle.cuh.
    let words = 4 * OCCLUDER_PARTS * WARP
        + SEARCHED_WORDS
        + PLANE_WORDS
        + FOUND_TRIANGLES
        + MAX_SEARCH_ROOTS
        + 2 * ROW_TABLE_WORDS;
    let units = bundles.count as u64;
    let work = WarpWork { units, taken: Some(&taken), first: FIRST_BUNDLES, progress: units, words };
    test_samples(cuda, wave, target, (&KERNELS, work), complete)
}
