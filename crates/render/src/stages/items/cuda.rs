//! Items on a CUDA device: a block sorts each tile of the image.

use bytemuck::Zeroable;
use lightmesh_kernels::{Kernel, Runtime};
use lightmesh_layout::constants::{TILE, TILE_SIDE};
use lightmesh_layout::stages::GroupItems;

use crate::error::RenderError;
use crate::gpu::items::DeviceItems;
use crate::gpu::rays::DeviceWave;
use crate::gpu::{Cuda, Work, blocks_for};

const GROUP: Kernel = Kernel { module: "items", name: "group_items" };
const GATHER: Kernel = Kernel { module: "items", name: "gather_items" };
/// Number of tiles in the first launch.
const FIRST_TILES: u64 = 256;

pub(crate) fn items<R: Runtime>(cuda: &Cuda<R>, wave: &DeviceWave<R>) -> Result<DeviceItems<R>, RenderError> {
    let pool = cuda.pool();
    let tiles = wave.rays.blocks(TILE_SIDE);
    let members = pool.room("surface points by item", tiles as usize * TILE as usize)?;
    let ends = pool.room::<u16>("ends of items", tiles as usize * TILE as usize)?;
    let counts = pool.room("number of items", tiles as usize + 1)?;
    let around = pool.room("boxes of tiles", tiles as usize)?;
    let record = GroupItems {
        scene: wave.scene.record,
        rays: wave.rays.record,
        hits: wave.hits.hits.input(),
        members: members.output(),
        ends: ends.output(),
        counts: counts.output(),
        tiles: around.output(),
        spacing: wave.rays.spacing,
        ..GroupItems::zeroed()
    };
    // 1. to 3. Each tile sorts its surface points and splits them into items.
    let progress = wave.rays.len() as u64;
    cuda.in_pieces(wave.context, GROUP, Work { units: tiles, cost: 1, first: FIRST_TILES, progress }, |piece| {
        cuda.launch(GROUP, blocks_for(&piece, TILE), &GroupItems { first_block: piece.start, ..record })
    })?;
    // 4. The items of all tiles in one list.
    let count = cuda.scan_total(&counts)?;
    let items = pool.room("items", count)?;
    cuda.launch(GATHER, blocks_for(&(0..tiles), TILE), &GroupItems { items: items.output(), ..record })?;
    Ok(DeviceItems { members, items, count, tiles: around })
}
