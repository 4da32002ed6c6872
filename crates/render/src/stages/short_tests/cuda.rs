//! Step 2 on a CUDA device: one warp for up to 32 surface points of a cell.

use lightmesh_kernels::Runtime;
use lightmesh_layout::constants::{
    CANDIDATE_WORDS, CANDIDATES, FOUND_TRIANGLES, LISTED_TARGETS, PLANE_WORDS, TARGET_WORDS,
};
use lightmesh_layout::stages::ShortTests;

use crate::error::RenderError;
use crate::gpu::cells::DeviceCells;
use crate::gpu::masks::DeviceMasks;
use crate::gpu::rays::DeviceWave;
use crate::gpu::{Cuda, PerModule, PerStructure, Work, per_module, per_structure, warps_for};
use crate::light_mesh::LightMesh;
use crate::settings;

const HALF_BALLS: PerModule = per_module!("short_tests", "half_balls_of_bundles");
const BY_CELL: PerStructure = per_structure!("short_tests", "short_tests_by_cell");
/// For templates whose masks do not fit into shared memory: the masks stay in global memory, where they end up anyway.
const BY_CELL_LARGE: PerStructure = per_structure!("short_tests", "short_tests_by_cell_large");
const PLAIN: PerStructure = per_structure!("short_tests", "short_tests_plain");
/// Warps per block of the tests.
const WARPS: u32 = 1;
/// Shared memory that every device gives a block, bytes.
const SHARED_MEMORY: u32 = 48 << 10;
/// Bundles of the very first launches.
const FIRST_BUNDLES: u64 = 1024;

pub(crate) fn short_tests<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    cells: &DeviceCells<R>,
    mesh: &LightMesh,
) -> Result<DeviceMasks<R>, RenderError> {
    let scene = wave.scene;
    let words = mesh.template.words();
    let masks = cuda.pool().room("masks", cells.count * 32 * words)?;
    let by_cell = wave.context.short_tests == settings::ShortTests::Cells;
    let least = shared_words(scene.search_words());
    let all = least + 32 * words as u32;
    let (kernels, shared) = if !by_cell {
        (PLAIN, 0)
    } else if 4 * WARPS * all <= SHARED_MEMORY {
        (BY_CELL, all)
    } else {
        (BY_CELL_LARGE, least)
    };
    let record = ShortTests {
        scene: scene.record,
        rays: wave.rays.record,
        hits: wave.hits.hits.input(),
        mesh: cuda.mesh(mesh)?,
        members: cells.members.input(),
        bundles: cells.bundles.input(),
        masks: masks.output(),
        tally: cuda.tally()?,
        first_bundle: 0,
        bundle_count: 0,
    };
    let each_bundle = |kernel, shared, progress| {
        let work = Work { units: cells.count as u64, cost: 1, first: FIRST_BUNDLES, progress };
        cuda.in_pieces(wave.context, kernel, work, |piece| {
            let bundle_count = piece.end - piece.start;
            let arguments = ShortTests { first_bundle: piece.start, bundle_count, ..record };
            cuda.launch(kernel, warps_for(&piece, WARPS, shared), &arguments)
        })
    };
    cuda.bring_lines(kernels.of(scene).module, mesh)?;
    if !by_cell {
        each_bundle(HALF_BALLS.of(scene), 0, 0)?;
    }
    each_bundle(kernels.of(scene), shared, cells.count as u64)?;
    Ok(DeviceMasks { masks, words })
}

/// Shared memory of a warp that tests by cell, in 32-bit words, without its masks: candidates and targets of one round, tangent
/// planes, triangles found, and `search` words that the search for them needs. See `cell_memory` in `memory.cuh`.
fn shared_words(search: u32) -> u32 {
    CANDIDATE_WORDS * CANDIDATES + TARGET_WORDS * (LISTED_TARGETS + 1) + PLANE_WORDS + FOUND_TRIANGLES + search
}
