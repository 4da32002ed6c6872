//! Step 2 on a CUDA device: object points by cell, then masks, a warp for up to 32 object points of one cell.

use bytemuck::Zeroable;
use lightmesh_layout::constants::{
    CANDIDATE_WORDS, CANDIDATES, FOUND_TRIANGLES, LISTED_TARGETS, STACK_OF_ROUNDS, STACK_PER_LEVEL, TANGENT_PLANES,
    TARGET_WORDS, TILE,
};
use lightmesh_layout::mesh::Item;
use lightmesh_layout::stages::{GroupCells, ShortTests};

use crate::RenderError;
use crate::backend::cuda::{Cuda, DeviceHits, DeviceRays, DeviceScene, Work, blocks_for, kernel_of, warps_for};
use crate::cuda::{Buffer, Kernel, Runtime};
use crate::job::Job;
use crate::light_mesh::LightMesh;
use crate::prepared::PreparedScene;
use crate::settings;
use crate::stages::light_points::cuda::window_bricks;

/// The masks of all object points on a device, transposed: a block of 32 · words words for each item.
pub struct DeviceMasks<R: Runtime> {
    /// Ray numbers by slot.
    pub(crate) members: Buffer<R, u32>,
    pub(crate) items: Buffer<R, Item>,
    /// Number of items.
    pub(crate) count: usize,
    pub(crate) masks: Buffer<R, u32>,
    /// The used points of each brick of the window around each item's cell.
    pub(crate) marks: Buffer<R, u64>,
    words: usize,
}

const GROUP: Kernel = Kernel { module: "short_tests", name: "group_points" };
const GATHER: Kernel = Kernel { module: "short_tests", name: "gather_items" };
const HALF_BALLS: Kernel = Kernel { module: "short_tests", name: "half_balls_of_items" };
/// Warps of a block that tests.
const WARPS: u32 = 1;
/// Shared memory that every device gives a block, bytes.
const SHARED_MEMORY: u32 = 48 << 10;
/// Tiles, and items, of the first launches ever.
const FIRST_TILES: u64 = 256;
const FIRST_ITEMS: u64 = 1024;

pub(crate) fn short_tests<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    scene: &PreparedScene,
    rays: &DeviceRays<R>,
    hits: &DeviceHits<R>,
    mesh: &LightMesh,
) -> Result<DeviceMasks<R>, RenderError> {
    let by_cell = job.short_tests == settings::ShortTests::Cells;
    let scene = if by_cell { cuda.upload_scene(scene, true)? } else { cuda.scene(scene)? };
    // 1. Which object points share a cell?
    let masks = group(cuda, job, &scene, rays, hits, mesh)?;
    // 2. Their masks.
    let marks = 2 * window_bricks(mesh.template.reach());
    let search = shared_words(scene.record.bvh.depth, marks);
    let all = search + 32 * mesh.template.words() as u32;
    let (kernel, words) = if !by_cell {
        let names = ["short_tests_plain_bvh", "short_tests_plain_grid", "short_tests_plain_brute_force"];
        (kernel_of("short_tests", names, scene.structure), marks)
    } else if 4 * WARPS * all <= SHARED_MEMORY {
        (Kernel { module: "short_tests", name: "short_tests_by_cell" }, all)
    } else {
        // Masks of large templates stay where they end up anyway.
        (Kernel { module: "short_tests", name: "short_tests_by_cell_large" }, search)
    };
    let record = ShortTests {
        scene: scene.record,
        rays: rays.record,
        hits: hits.hits.input(),
        mesh: cuda.mesh(mesh)?,
        members: masks.members.input(),
        items: masks.items.input(),
        masks: masks.masks.output(),
        marks: masks.marks.output(),
        tally: cuda.tally()?,
        first_item: 0,
        item_count: 0,
    };
    let each_item = |kernel, words, progress| {
        let work = Work { units: masks.count as u64, cost: 1, first: FIRST_ITEMS, progress };
        cuda.in_pieces(job, kernel, work, |piece| {
            let item_count = piece.end - piece.start;
            let arguments = ShortTests { first_item: piece.start, item_count, ..record };
            cuda.launch(kernel, warps_for(&piece, WARPS, words), &arguments)
        })
    };
    if !by_cell {
        each_item(HALF_BALLS, 0, 0)?;
    }
    each_item(kernel, words, rays.len() as u64)?;
    Ok(masks)
}

fn group<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    scene: &DeviceScene<R>,
    rays: &DeviceRays<R>,
    hits: &DeviceHits<R>,
    mesh: &LightMesh,
) -> Result<DeviceMasks<R>, RenderError> {
    let pool = cuda.pool();
    let tiles = rays.blocks(32);
    let members = pool.room("object points by cell", tiles as usize * TILE as usize)?;
    let tile_items = pool.room("items of tiles", tiles as usize * TILE as usize)?;
    let counts = pool.room("number of items", tiles as usize + 1)?;
    let record = GroupCells {
        scene: scene.record,
        rays: rays.record,
        hits: hits.hits.input(),
        mesh: cuda.mesh(mesh)?,
        members: members.output(),
        tile_items: tile_items.output(),
        counts: counts.output(),
        ..GroupCells::zeroed()
    };
    // a. Each tile sorts its object points by cell and cuts them into items.
    cuda.in_pieces(job, GROUP, Work { units: tiles, cost: 1, first: FIRST_TILES, progress: 0 }, |piece| {
        cuda.launch(GROUP, blocks_for(&piece, TILE), &GroupCells { first_block: piece.start, ..record })
    })?;
    // b. The items of all tiles in one list.
    let count = cuda.scan_total(&counts)?;
    let items = pool.room("items", count)?;
    cuda.launch(GATHER, blocks_for(&(0..tiles), TILE), &GroupCells { items: items.output(), ..record })?;
    drop(tile_items);
    let words = mesh.template.words();
    let masks = pool.room("masks", count * 32 * words)?;
    let marks = pool.room("used points around items", count * window_bricks(mesh.template.reach()) as usize)?;
    Ok(DeviceMasks { members, items, count, masks, marks, words })
}

impl<R: Runtime> DeviceMasks<R> {
    /// Reads the masks: for each ray that has an object point its cell and its mask, ordered by ray.
    pub fn read(&self) -> Result<Vec<(u32, u64, Vec<u32>)>, RenderError> {
        let (members, items, masks) = (self.members.read()?, self.items.read()?, self.masks.read()?);
        let mut found = Vec::new();
        for (item, columns) in items.iter().zip(masks.chunks_exact(32 * self.words)) {
            for lane in 0..item.count {
                let bit = |k: usize| columns[k] >> lane & 1;
                let word = |word: usize| (0..32).map(|k| bit(32 * word + k) << k).sum();
                let mask = (0..self.words).map(word).collect();
                found.push((members[(item.first + lane) as usize], item.cell, mask));
            }
        }
        found.sort_unstable_by_key(|(ray, ..)| *ray);
        Ok(found)
    }
}

/// Shared memory of a warp that tests by cell, in 32-bit words, its masks apart: candidates and targets of one round, triangles
/// found (later `marks`), and the stack of the search through a BVH of `depth` levels. See `cell_memory` in `memory.cuh`.
fn shared_words(depth: u32, marks: u32) -> u32 {
    let found = marks.max(FOUND_TRIANGLES);
    let stack = (STACK_OF_ROUNDS + STACK_PER_LEVEL * depth).next_multiple_of(4);
    CANDIDATE_WORDS * CANDIDATES + TARGET_WORDS * (LISTED_TARGETS + 1) + 4 * TANGENT_PLANES + found + stack
}
