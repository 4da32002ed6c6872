//! Surface points by cell on a CUDA device: a block sorts each tile of the image.

use bytemuck::Zeroable;
use lightmesh_kernels::{Kernel, Runtime};
use lightmesh_layout::constants::{TILE, TILE_SIDE};
use lightmesh_layout::stages::GroupCells;

use crate::error::RenderError;
use crate::gpu::cells::DeviceCells;
use crate::gpu::rays::DeviceWave;
use crate::gpu::{Cuda, Work, blocks_for};
use crate::light_mesh::LightMesh;

const GROUP: Kernel = Kernel { module: "cells", name: "group_points" };
const GATHER: Kernel = Kernel { module: "cells", name: "gather_bundles" };
/// Number of tiles in the first launch.
const FIRST_TILES: u64 = 256;

pub(crate) fn cells<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    mesh: &LightMesh,
) -> Result<DeviceCells<R>, RenderError> {
    let pool = cuda.pool();
    let tiles = wave.rays.blocks(TILE_SIDE);
    let members = pool.room("surface points by cell", tiles as usize * TILE as usize)?;
    let tile_bundles = pool.room("bundles of tiles", tiles as usize * TILE as usize)?;
    let counts = pool.room("number of bundles", tiles as usize + 1)?;
    let record = GroupCells {
        scene: wave.scene.record,
        rays: wave.rays.record,
        hits: wave.hits.hits.input(),
        mesh: cuda.mesh(mesh)?,
        members: members.output(),
        tile_bundles: tile_bundles.output(),
        counts: counts.output(),
        ..GroupCells::zeroed()
    };
    // 1. to 3. Each tile sorts its surface points by cell and splits them into bundles.
    let progress = wave.rays.len() as u64;
    cuda.in_pieces(wave.context, GROUP, Work { units: tiles, cost: 1, first: FIRST_TILES, progress }, |piece| {
        cuda.launch(GROUP, blocks_for(&piece, TILE), &GroupCells { first_block: piece.start, ..record })
    })?;
    // 4. The bundles of all tiles in one list.
    let count = cuda.scan_total(&counts)?;
    let bundles = pool.room("bundles", count)?;
    cuda.launch(GATHER, blocks_for(&(0..tiles), TILE), &GroupCells { bundles: bundles.output(), ..record })?;
    Ok(DeviceCells { members, bundles, count })
}
