//! Bundles on a CUDA device: a block sorts each tile of the image.

use bytemuck::Zeroable;
use lightmesh_kernels::{Kernel, Runtime};
use lightmesh_layout::constants::{TILE, TILE_SIDE};
use lightmesh_layout::stages::GroupBundles;

use crate::error::RenderError;
use crate::gpu::bundles::DeviceBundles;
use crate::gpu::rays::DeviceWave;
use crate::gpu::{Cuda, Work, blocks_for};

const GROUP: Kernel = Kernel { module: "bundles", name: "group_bundles" };
const GATHER: Kernel = Kernel { module: "bundles", name: "gather_bundles" };
/// Number of tiles in the first launch.
const FIRST_TILES: u64 = 256;

pub(crate) fn bundles<R: Runtime>(cuda: &Cuda<R>, wave: &DeviceWave<R>) -> Result<DeviceBundles<R>, RenderError> {
    let pool = cuda.pool();
    let tiles = wave.rays.blocks(TILE_SIDE);
    let members = pool.room("surface points by bundle", tiles as usize * TILE as usize)?;
    let ends = pool.room::<u16>("ends of bundles", tiles as usize * TILE as usize)?;
    let counts = pool.room("number of bundles", tiles as usize + 1)?;
    let around = pool.room("boxes of tiles", tiles as usize)?;
    let record = GroupBundles {
        scene: wave.scene.record,
        rays: wave.rays.record,
        hits: wave.hits.hits.input(),
        members: members.output(),
        ends: ends.output(),
        counts: counts.output(),
        tiles: around.output(),
        spacing: wave.rays.spacing,
        ..GroupBundles::zeroed()
    };
    // 1. to 3. Each tile sorts its surface points and splits them into bundles.
    let progress = wave.rays.len() as u64;
    cuda.in_pieces(wave.context, GROUP, Work { units: tiles, cost: 1, first: FIRST_TILES, progress }, |piece| {
        cuda.launch(GROUP, blocks_for(&piece, TILE), &GroupBundles { first_block: piece.start, ..record })
    })?;
    // 4. The bundles of all tiles in one list.
    let count = cuda.scan_total(&counts)?;
    let bundles = pool.room("bundles", count)?;
    cuda.launch(GATHER, blocks_for(&(0..tiles), TILE), &GroupBundles { bundles: bundles.output(), ..record })?;
    Ok(DeviceBundles { members, bundles, count, tiles: around })
}
