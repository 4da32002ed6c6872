//! Step 3 on a CUDA device: a table of bricks, marks in them, ranks, a list.
//!
//! The table is filled so that it looks the same whatever the order of the threads (Shun, Blelloch: *Phase-Concurrent Hash Tables for
//! Determinism*, SPAA 2014). So slots, ranks and lists repeat from run to run.

use bytemuck::Zeroable;
use lightmesh_layout::mesh::{BrickTable, UsedPoints};
use lightmesh_layout::stages::LightPoints;

use super::window_side;
use crate::RenderError;
use crate::backend::cuda::{BLOCK, Cuda, Work, blocks_for};
use crate::cuda::{Buffer, Kernel, Runtime};
use crate::job::{Job, Tally};
use crate::light_mesh::{BrickKey, LightMesh};
use crate::stages::short_tests::cuda::DeviceMasks;

/// The used light points of a picture on a device.
pub struct DevicePoints<R: Runtime> {
    keys: Buffer<R, u64>,
    used: Buffer<R, u64>,
    rank: Buffer<R, u32>,
    points: Buffer<R, u64>,
    /// The slot of each brick of the window around each item's cell that has used points.
    pub(crate) slots: Buffer<R, u32>,
    /// S_total.
    pub(crate) count: usize,
}

const INSERT: Kernel = Kernel { module: "light_points", name: "insert_bricks" };
const MARK: Kernel = Kernel { module: "light_points", name: "mark_points" };
const COUNT: Kernel = Kernel { module: "light_points", name: "count_points" };
const LIST: Kernel = Kernel { module: "light_points", name: "list_points" };

/// Items of the first launch ever.
const FIRST: u64 = 4096;
/// Slots of the smallest table.
const LEAST_CAPACITY: usize = 1024;

pub(crate) fn light_points<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    masks: &DeviceMasks<R>,
    mesh: &LightMesh,
) -> Result<DevicePoints<R>, RenderError> {
    // 1. The bricks that hold a used point, in a table that is at most half full.
    let mut capacity = masks.count.next_power_of_two().max(LEAST_CAPACITY);
    let (keys, record) = loop {
        let keys = cuda.pool().zeros("table of bricks", capacity)?;
        let bricks = cuda.pool().zeros("number of bricks", 1)?;
        let table = BrickTable { keys: keys.output(), capacity: capacity as u32, spare: 0 };
        let record = LightPoints {
            mesh: cuda.mesh(mesh)?,
            items: masks.items.input(),
            marks: masks.marks.input(),
            item_count: masks.count as u64,
            table,
            bricks: bricks.output(),
            ..LightPoints::zeroed()
        };
        each_item(cuda, job, INSERT, &record)?;
        let mut count = [0u32];
        bricks.read_into(0, &mut count)?;
        if count[0] as usize <= capacity / 2 {
            break (keys, record);
        }
        capacity *= 2;
    };
    // 2. The used points in each. The order of marking does not matter to an "or".
    let used = cuda.pool().zeros("used light points", capacity)?;
    let slots = cuda.pool().room("bricks around items", masks.marks.len())?;
    let record = LightPoints { used: used.output(), slots: slots.output(), ..record };
    each_item(cuda, job, MARK, &record)?;
    // 3. Ranks.
    let rank = cuda.pool().room("ranks of bricks", capacity + 1)?;
    let record = LightPoints { rank: rank.output(), ..record };
    let launch = blocks_for(&(0..capacity.div_ceil(BLOCK as usize) as u64), BLOCK);
    cuda.launch(COUNT, launch, &record)?;
    let count = cuda.scan_total(&rank)?;
    // 4. The list.
    let points = cuda.pool().room("light points", count)?;
    cuda.launch(LIST, launch, &LightPoints { points: points.output(), ..record })?;
    Tally::add(&job.tally.light_points, count as u64);
    Ok(DevicePoints { keys, used, rank, points, slots, count })
}

/// Launches a kernel that takes a brick of an item's window a thread, over all items.
fn each_item<R: Runtime>(cuda: &Cuda<R>, job: &Job, kernel: Kernel, record: &LightPoints) -> Result<(), RenderError> {
    let work = Work { units: record.item_count, cost: 1, first: FIRST, progress: 0 };
    cuda.in_pieces(job, kernel, work, |piece| {
        let item_count = piece.end - piece.start;
        let bricks = item_count * u64::from(window_bricks(record.mesh.reach));
        let launch = blocks_for(&(0..bricks.div_ceil(u64::from(BLOCK))), BLOCK);
        cuda.launch(kernel, launch, &LightPoints { first_item: piece.start, item_count, ..*record })
    })
}

/// Bricks of the window around a cell.
pub(crate) fn window_bricks(reach: i32) -> u32 {
    window_side(reach).pow(3) as u32
}

impl<R: Runtime> DevicePoints<R> {
    /// Slots of the table.
    pub(crate) fn capacity(&self) -> usize {
        self.keys.len()
    }

    /// Where everything is.
    pub(crate) fn record(&self) -> UsedPoints {
        UsedPoints {
            table: BrickTable { keys: self.keys.output(), capacity: self.keys.len() as u32, spare: 0 },
            used: self.used.input(),
            rank: self.rank.input(),
            points: self.points.input(),
        }
    }

    /// Reads the bricks that hold used points: slot, key and used points of each.
    pub fn read_bricks(&self) -> Result<Vec<(usize, BrickKey, u64)>, RenderError> {
        let (keys, used) = (self.keys.read()?, self.used.read()?);
        let slots = keys.into_iter().zip(used).enumerate();
        Ok(slots.filter(|(_, (key, _))| *key != 0).map(|(slot, (key, used))| (slot, key - 1, used)).collect())
    }

    /// Reads the rank of the first used point of each slot.
    pub fn read_ranks(&self) -> Result<Vec<u32>, RenderError> {
        self.rank.read()
    }
}
