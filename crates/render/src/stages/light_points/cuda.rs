//! Step 3 on a CUDA device: a table of bricks, marks in them, ranks, a list.
//!
//! The table is filled so that it looks the same whatever the order of the threads (Shun, Blelloch: *Phase-Concurrent Hash Tables for
//! Determinism*, SPAA 2014). So slots, ranks and lists are reproducible.

use std::sync::Arc;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::constants::BUNDLE_WARPS;
use lightmesh_layout::mesh::BrickTable;
use lightmesh_layout::stages::LightPoints;

use crate::counters::Tally;
use crate::error::RenderError;
use crate::gpu::cells::DeviceCells;
use crate::gpu::masks::DeviceMasks;
use crate::gpu::points::DevicePoints;
use crate::gpu::{BLOCK, Cuda, Work, blocks_for, warps_for};
use crate::light_mesh::{LightMesh, window_bricks};
use crate::render_context::RenderContext;

const MARK_BUNDLES: Kernel = Kernel { module: "light_points", name: "mark_bundles" };
const INSERT: Kernel = Kernel { module: "light_points", name: "insert_bricks" };
const MARK: Kernel = Kernel { module: "light_points", name: "mark_points" };
const COUNT: Kernel = Kernel { module: "light_points", name: "count_points" };
const LIST: Kernel = Kernel { module: "light_points", name: "list_points" };

/// Number of bundles in the first launch.
const FIRST: u64 = 4096;
/// Slots of the smallest table.
const MIN_CAPACITY: usize = 1024;

pub(crate) fn light_points<R: Runtime>(
    cuda: &Cuda<R>,
    context: &RenderContext,
    cells: &DeviceCells<R>,
    masks: &DeviceMasks<R>,
    mesh: &LightMesh,
) -> Result<DevicePoints<R>, RenderError> {
    // 1. The used points of each brick around each bundle's cell.
    let bricks_of_bundle = window_bricks(mesh.template.reach());
    let marks = cuda.pool().room("used points around bundles", cells.count * bricks_of_bundle as usize)?;
    let record = LightPoints {
        mesh: cuda.mesh(mesh)?,
        bundles: cells.bundles.input(),
        masks: masks.masks.input(),
        marks: marks.output(),
        bundle_count: cells.count as u64,
        ..LightPoints::zeroed()
    };
    let work = Work { units: cells.count as u64, cost: 1, first: FIRST, progress: cells.count as u64 };
    cuda.in_pieces(context, MARK_BUNDLES, work, |piece| {
        let bundle_count = piece.end - piece.start;
        let launch = warps_for(&piece, BUNDLE_WARPS, 2 * bricks_of_bundle);
        cuda.launch(MARK_BUNDLES, launch, &LightPoints { first_bundle: piece.start, bundle_count, ..record })
    })?;
    // 2. The bricks that hold a used point, in a table that is at most half full.
    let mut capacity = cells.count.next_power_of_two().max(MIN_CAPACITY);
    let (keys, record) = loop {
        let keys = cuda.pool().zeros("table of bricks", capacity)?;
        let bricks = cuda.pool().zeros("number of bricks", 1)?;
        let table = BrickTable { keys: keys.output(), capacity: capacity as u32, spare: 0 };
        let record = LightPoints { table, bricks: bricks.output(), ..record };
        each_bundle(cuda, context, INSERT, &record)?;
        let mut count = [0u32];
        bricks.read_into(0, &mut count)?;
        if count[0] as usize <= capacity / 2 {
            break (keys, record);
        }
        capacity *= 2;
    };
    // 3. The used points in each. The order of marking does not matter to an "or".
    let used = cuda.pool().zeros("used light points", capacity)?;
    let slots = cuda.pool().room("bricks around bundles", marks.len())?;
    let record = LightPoints { used: used.output(), slots: slots.output(), ..record };
    each_bundle(cuda, context, MARK, &record)?;
    // 4. and 5. Ranks, and the list.
    let points = listed(cuda, (Arc::new(keys), Arc::new(slots)), used)?;
    Tally::add(&context.tally.light_points, points.count as u64);
    Ok(points)
}

/// A subset of the used light points: `used`, by slot.
pub(crate) fn only<R: Runtime>(
    cuda: &Cuda<R>,
    points: &DevicePoints<R>,
    used: Buffer<R, u64>,
) -> Result<DevicePoints<R>, RenderError> {
    listed(cuda, (Arc::clone(&points.keys), Arc::clone(&points.slots)), used)
}

/// Keys of a table, and the slots of the bricks of each bundle's window.
type Bricks<R> = (Arc<Buffer<R, u64>>, Arc<Buffer<R, u32>>);

/// Ranks and list of used points in a table.
fn listed<R: Runtime>(
    cuda: &Cuda<R>,
    (keys, slots): Bricks<R>,
    used: Buffer<R, u64>,
) -> Result<DevicePoints<R>, RenderError> {
    let capacity = keys.len();
    let table = BrickTable { keys: keys.output(), capacity: capacity as u32, spare: 0 };
    let rank = cuda.pool().room("ranks of bricks", capacity + 1)?;
    let record = LightPoints { table, used: used.output(), rank: rank.output(), ..LightPoints::zeroed() };
    let launch = blocks_for(&(0..capacity.div_ceil(BLOCK as usize) as u64), BLOCK);
    cuda.launch(COUNT, launch, &record)?;
    let count = cuda.scan_total(&rank)?;
    let points = cuda.pool().room("light points", count)?;
    if count > 0 {
        cuda.launch(LIST, launch, &LightPoints { points: points.output(), ..record })?;
    }
    Ok(DevicePoints { keys, used, rank, points, slots, count })
}

/// Launches a kernel with one thread per brick of a bundle's window, over all bundles.
fn each_bundle<R: Runtime>(
    cuda: &Cuda<R>,
    context: &RenderContext,
    kernel: Kernel,
    record: &LightPoints,
) -> Result<(), RenderError> {
    let work = Work { units: record.bundle_count, cost: 1, first: FIRST, progress: 0 };
    cuda.in_pieces(context, kernel, work, |piece| {
        let bundle_count = piece.end - piece.start;
        let bricks = bundle_count * u64::from(window_bricks(record.mesh.reach));
        let launch = blocks_for(&(0..bricks.div_ceil(u64::from(BLOCK))), BLOCK);
        cuda.launch(kernel, launch, &LightPoints { first_bundle: piece.start, bundle_count, ..*record })
    })
}
