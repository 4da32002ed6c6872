//! Visibility of light points, cached on a CUDA device: a table of bricks that only grows and, for each light, the known values by
//! slot.

use bytemuck::Zeroable;
use lightmesh_layout::Out;
use lightmesh_layout::constants::POINT_BITS;
use lightmesh_layout::mesh::{BrickTable, KeptBy, LitBy};
use lightmesh_layout::stages::Cache;
use rayon::prelude::*;

use super::{Noticed, Seen, Table};
use crate::cuda::{Buffer, Kernel, Runtime};
use crate::error::RenderError;
use crate::gathered::cuda::DeviceSurfaceLight;
use crate::gpu::points::DevicePoints;
use crate::gpu::{BLOCK, Cuda, blocks_for};

const ADMIT: Kernel = Kernel { module: "cache", name: "admit_bricks" };
const FIND_UNKNOWN: Kernel = Kernel { module: "cache", name: "find_unknown" };
const LEARN: Kernel = Kernel { module: "cache", name: "learn" };
const RECALL: Kernel = Kernel { module: "cache", name: "recall" };
const MOVE_BRICKS: Kernel = Kernel { module: "cache", name: "move_bricks" };
const MOVE_ANSWERS: Kernel = Kernel { module: "cache", name: "move_answers" };

/// Bricks with the visibility of their light points. After an error in the middle of an update, the table must be dropped.
pub struct DeviceTable<R: Runtime> {
    bricks: Option<Bricks<R>>,
    columns: Vec<Column<R>>,
}

/// The known bricks: at most half of the slots.
struct Bricks<R: Runtime> {
    keys: Buffer<R, u64>,
    /// Their number.
    count: Buffer<R, u32>,
}

/// The known values for one light, by slot.
struct Column<R: Runtime> {
    seen: Seen,
    known: Buffer<R, u64>,
    answers: Answers<R>,
    /// Number of light points whose value is known.
    count: u64,
}

enum Answers<R: Runtime> {
    /// Lit or not, one word per slot.
    Bits(Buffer<R, u64>),
    /// Rays that reached the light, 64 counts per slot.
    Shares(Buffer<R, u16>),
}

impl<R: Runtime> Default for DeviceTable<R> {
    fn default() -> DeviceTable<R> {
        DeviceTable { bricks: None, columns: Vec::new() }
    }
}

impl<R: Runtime> Table for DeviceTable<R> {
    type Light = DeviceSurfaceLight<R>;
    type Error = RenderError;

    fn memory_of(light: &DeviceSurfaceLight<R>) -> u64 {
        light.memory()
    }

    fn len(&self) -> u64 {
        self.columns.iter().map(|column| column.count).sum()
    }

    fn memory(&self) -> u64 {
        let keys = self.bricks.as_ref().map_or(0, |bricks| bricks.keys.bytes() + bricks.count.bytes());
        keys + self.columns.iter().map(Column::memory).sum::<u64>()
    }

    /// On the host, by the same rule to the bit as its own table: a few bytes for each brick go back and forth.
    fn forget(&mut self, noticed: &Noticed) -> Result<(), RenderError> {
        let Some(bricks) = &self.bricks else { return Ok(()) };
        let keys = bricks.keys.read()?;
        for column in &mut self.columns {
            let kind = column.seen.kind();
            let mut known = column.known.read()?;
            // Keys are stored increased by 1: 0 is an empty slot.
            let is_noticed = |&slot: &usize| known[slot] != 0 && noticed.by(keys[slot] - 1, kind);
            let forgotten: Vec<usize> = (0..keys.len()).into_par_iter().filter(is_noticed).collect();
            if forgotten.is_empty() {
                continue;
            }
            for &slot in &forgotten {
                column.count -= u64::from(known[slot].count_ones());
                known[slot] = 0;
            }
            column.known.write(&known)?;
            if let Answers::Bits(bits) = &column.answers {
                let mut words = bits.read()?;
                forgotten.iter().for_each(|&slot| words[slot] = 0);
                bits.write(&words)?;
            }
        }
        Ok(())
    }
}

impl<R: Runtime> DeviceTable<R> {
    /// The slots of an image's bricks, by slot of its own table, and a column for each light. Values for another light, or for other
    /// samples, are discarded.
    pub(crate) fn admit(
        &mut self,
        cuda: &Cuda<R>,
        points: &DevicePoints<R>,
        lights: Vec<Seen>,
    ) -> Result<Buffer<R, u32>, RenderError> {
        let rows = cuda.pool().room("light points' places in the cache", points.capacity())?;
        let record = Cache { points: points.record(), rows: rows.output(), ..Cache::zeroed() };
        loop {
            let bricks = match &self.bricks {
                Some(bricks) => bricks,
                None => self.bricks.insert(Bricks::new(cuda, points.capacity())?),
            };
            cuda.launch(ADMIT, slots(points.capacity()), &bricks.write(record))?;
            let mut count = [0];
            bricks.count.read_into(0, &mut count)?;
            if count[0] as usize <= bricks.keys.len() / 2 {
                self.hold(cuda, lights)?;
                return Ok(rows);
            }
            self.grow(cuda)?;
        }
    }

    /// Provides a column for each light.
    fn hold(&mut self, cuda: &Cuda<R>, lights: Vec<Seen>) -> Result<(), RenderError> {
        let capacity = self.capacity();
        self.columns.truncate(lights.len());
        for (index, seen) in lights.into_iter().enumerate() {
            if self.columns.get(index).is_some_and(|column| column.seen == seen) {
                continue;
            }
            let column = Column::new(cuda, seen, capacity)?;
            if index < self.columns.len() {
                self.columns[index] = column;
            } else {
                self.columns.push(column);
            }
        }
        Ok(())
    }

    /// Moves everything into a table of twice as many slots.
    fn grow(&mut self, cuda: &Cuda<R>) -> Result<(), RenderError> {
        let Some(old) = &self.bricks else { return Ok(()) };
        let new = Bricks::new(cuda, 2 * old.keys.len())?;
        let rows = cuda.pool().room("new places in the cache", old.keys.len())?;
        let record = new.write(Cache { from_table: old.record(), rows: rows.output(), ..Cache::zeroed() });
        cuda.launch(MOVE_BRICKS, slots(old.keys.len()), &record)?;
        for column in &mut self.columns {
            let larger = Column { count: column.count, ..Column::new(cuda, column.seen.clone(), new.keys.len())? };
            let record = Cache { from: column.record(), kept: larger.record(), ..record };
            cuda.launch(MOVE_ANSWERS, slots(old.keys.len()), &record)?;
            *column = larger;
        }
        self.bricks = Some(new);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bricks.as_ref().map_or(0, |bricks| bricks.keys.len())
    }

    /// Number of rays from each light point to a light.
    pub(crate) fn samples(&self, light: usize) -> u32 {
        self.columns[light].seen.samples()
    }

    /// The used points whose value for a light is unknown, by slot of the image's table.
    pub(crate) fn unknown(
        &self,
        cuda: &Cuda<R>,
        light: usize,
        rows: &Buffer<R, u32>,
        points: &DevicePoints<R>,
    ) -> Result<Buffer<R, u64>, RenderError> {
        let unknown = cuda.pool().zeros("unknown light points", points.capacity())?;
        let record = Cache { unknown: unknown.output(), ..self.columns[light].of(points, rows) };
        cuda.launch(FIND_UNKNOWN, slots(points.capacity()), &record)?;
        Ok(unknown)
    }

    /// Stores the results for some light points, `unknown`.
    pub(crate) fn learn(
        &mut self,
        cuda: &Cuda<R>,
        light: usize,
        rows: &Buffer<R, u32>,
        (unknown, found): (&DevicePoints<R>, LitBy),
    ) -> Result<(), RenderError> {
        let column = &mut self.columns[light];
        let record = Cache { lit: found, ..column.of(unknown, rows) };
        cuda.launch(LEARN, slots(unknown.capacity()), &record)?;
        column.count += unknown.count as u64;
        Ok(())
    }

    /// What all points of an image see of a light.
    pub(crate) fn recall(
        &self,
        cuda: &Cuda<R>,
        light: usize,
        rows: &Buffer<R, u32>,
        (points, lit): (&DevicePoints<R>, LitBy),
    ) -> Result<(), RenderError> {
        let record = Cache { lit, ..self.columns[light].of(points, rows) };
        cuda.launch(RECALL, slots(points.capacity()), &record)
    }
}

/// A launch of one thread per slot.
fn slots(capacity: usize) -> crate::cuda::Launch {
    blocks_for(&(0..capacity.div_ceil(BLOCK as usize) as u64), BLOCK)
}

impl<R: Runtime> Bricks<R> {
    fn new(cuda: &Cuda<R>, capacity: usize) -> Result<Bricks<R>, RenderError> {
        let keys = cuda.pool().zeros("bricks of the cache", capacity)?;
        Ok(Bricks { keys, count: cuda.pool().zeros("number of bricks of the cache", 1)? })
    }

    fn record(&self) -> BrickTable {
        BrickTable { keys: self.keys.output(), capacity: self.keys.len() as u32, spare: 0 }
    }

    /// Writes the addresses of the bricks into a kernel's arguments.
    fn write(&self, record: Cache) -> Cache {
        Cache { table: self.record(), bricks: self.count.output(), ..record }
    }
}

impl<R: Runtime> Column<R> {
    fn new(cuda: &Cuda<R>, seen: Seen, capacity: usize) -> Result<Column<R>, RenderError> {
        let known = cuda.pool().zeros("known light points", capacity)?;
        let answers = if seen.is_share() {
            Answers::Shares(cuda.pool().room("known shares of a light", capacity << POINT_BITS)?)
        } else {
            Answers::Bits(cuda.pool().zeros("known light points that see a light", capacity)?)
        };
        Ok(Column { seen, known, answers, count: 0 })
    }

    fn record(&self) -> KeptBy {
        let (bits, seen) = match &self.answers {
            Answers::Bits(bits) => (bits.output(), Out::NULL),
            Answers::Shares(seen) => (Out::NULL, seen.output()),
        };
        KeptBy { known: self.known.output(), bits, seen }
    }

    /// The arguments of a kernel about some of an image's points.
    fn of(&self, points: &DevicePoints<R>, rows: &Buffer<R, u32>) -> Cache {
        Cache { points: points.record(), rows: rows.output(), kept: self.record(), ..Cache::zeroed() }
    }

    fn memory(&self) -> u64 {
        let answers = match &self.answers {
            Answers::Bits(bits) => bits.bytes(),
            Answers::Shares(seen) => seen.bytes(),
        };
        self.known.bytes() + answers
    }
}
