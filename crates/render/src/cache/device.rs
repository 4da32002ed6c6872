//! Visibility of light points, cached on a CUDA device: a table of bricks and, for each light, the known values by slot. The table grows
//! until it takes its part of the memory. Then the bricks that were used last are taken to the host and make a new one.

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::Out;
use lightmesh_layout::constants::POINT_BITS;
use lightmesh_layout::mesh::{BrickTable, KeptBy, VisibilityOfLight};
use lightmesh_layout::stages::Cache;
use rayon::prelude::*;

use super::stored::{POINTS, Readable, ReadableAnswers, Stored, StoredAnswers, StoredColumn, bytes_of_brick};
use super::{Allowance, ColumnKey, Invalidation, Table};
use crate::error::RenderError;
use crate::gpu::points::DevicePoints;
use crate::gpu::{BLOCK, Cuda, blocks_for};
use crate::light_mesh::{BrickKey, brick_hash};
use crate::stages::irradiance_cache::cuda::DeviceSurfaceLight;
use crate::stages::irradiance_cache::saved::SavedLight;

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
    /// What was read from a file, until the device is at hand; the rest is empty then.
    stored: Option<Stored>,
    allowance: Allowance,
}

/// The known bricks: at most half of the slots.
struct Bricks<R: Runtime> {
    keys: Buffer<R, u64>,
    /// Their number.
    count: Buffer<R, u32>,
    /// The number of the last image that used each of them, by slot.
    ages: Buffer<R, u32>,
}

/// The known values for one light, by slot.
struct Column<R: Runtime> {
    seen: ColumnKey,
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
        DeviceTable { bricks: None, columns: Vec::new(), stored: None, allowance: Allowance::default() }
    }
}

impl<R: Runtime> Table for DeviceTable<R> {
    type Light = DeviceSurfaceLight<R>;
    type Error = RenderError;

    fn memory_of(light: &DeviceSurfaceLight<R>) -> u64 {
        light.memory()
    }

    fn saved_light(light: &DeviceSurfaceLight<R>) -> Result<SavedLight, RenderError> {
        light.saved()
    }

    fn restored_light(saved: SavedLight) -> DeviceSurfaceLight<R> {
        DeviceSurfaceLight::restored(saved)
    }

    fn len(&self) -> u64 {
        self.columns.iter().map(|column| column.count).sum::<u64>() + self.stored.as_ref().map_or(0, Stored::len)
    }

    fn memory(&self) -> u64 {
        self.bricks.as_ref().map_or(0, Bricks::memory) + self.columns.iter().map(Column::memory).sum::<u64>()
    }

    /// On the host, by the same rule to the bit as its own table: a few bytes for each brick go back and forth.
    fn evict(&mut self, invalidation: &Invalidation) -> Result<(), RenderError> {
        // What was never uploaded is of no image.
        self.stored = None;
        let Some(bricks) = &self.bricks else { return Ok(()) };
        let keys = bricks.keys.read()?;
        for column in &mut self.columns {
            let kind = column.seen.kind();
            let mut known = column.known.read()?;
            // Keys are stored increased by 1: 0 is an empty slot.
            let is_invalidated = |&slot: &usize| known[slot] != 0 && invalidation.by(keys[slot] - 1, kind);
            let evicted: Vec<usize> = (0..keys.len()).into_par_iter().filter(is_invalidated).collect();
            if evicted.is_empty() {
                continue;
            }
            for &slot in &evicted {
                column.count -= u64::from(known[slot].count_ones());
                known[slot] = 0;
            }
            column.known.write(&known)?;
            if let Answers::Bits(bits) = &column.answers {
                let mut words = bits.read()?;
                evicted.iter().for_each(|&slot| words[slot] = 0);
                bits.write(&words)?;
            }
        }
        Ok(())
    }

    fn allow(&mut self, allowance: Allowance) {
        self.allowance = allowance;
    }

    fn stored(&self) -> Result<Stored, RenderError> {
        self.youngest(usize::MAX)
    }

    fn restored(stored: Stored) -> DeviceTable<R> {
        DeviceTable { stored: Some(stored), ..DeviceTable::default() }
    }
}

impl<R: Runtime> DeviceTable<R> {
    /// What is known of the bricks that were used last, at most `count` of them.
    fn youngest(&self, count: usize) -> Result<Stored, RenderError> {
        let Some(bricks) = &self.bricks else { return Ok(self.stored.clone().unwrap_or_default()) };
        // Keys are stored increased by 1: 0 is an empty slot.
        let mut keys: Vec<_> = bricks.keys.read()?.into_iter().map(|key| key.checked_sub(1)).collect();
        let mut places: Vec<usize> = (0..keys.len()).filter(|&slot| keys[slot].is_some()).collect();
        let ages = bricks.ages.read()?;
        if places.len() > count {
            // Of the same age, those go that have the larger keys: slots may differ from run to run.
            places.sort_unstable_by_key(|&slot| (u32::MAX - ages[slot], keys[slot]));
            places[count..].iter().for_each(|&slot| keys[slot] = None);
        }
        let columns = self.columns.iter().map(Column::download).collect::<Result<Vec<_>, RenderError>>()?;
        let columns: Vec<Readable> = columns.iter().map(Downloaded::readable).collect();
        Ok(Stored::gather(&keys, &ages, &columns))
    }

    /// The slots of an image's bricks, by slot of its own table, and a column for each light. Values for another light, or for other
    /// samples, are discarded. `None` if these bricks alone would take more memory than is allowed.
    pub(crate) fn admit(
        &mut self,
        cuda: &Cuda<R>,
        points: &DevicePoints<R>,
        lights: Vec<ColumnKey>,
    ) -> Result<Option<Buffer<R, u32>>, RenderError> {
        let allowance = self.allowance;
        let rows = cuda.pool().room("light points' places in the cache", points.capacity())?;
        let record = Cache { points: points.record(), rows: rows.output(), ..Cache::zeroed() };
        if let Some(mut stored) = self.stored.take() {
            let lights: Vec<ColumnKey> = stored.columns.iter().map(|column| column.seen.clone()).collect();
            let mut capacity = (2 * stored.bricks.len()).next_power_of_two();
            while capacity > points.capacity() && !self.is_allowed(capacity, &lights) {
                capacity /= 2;
                stored.truncate(capacity / 4);
            }
            *self = DeviceTable { allowance, ..DeviceTable::uploaded(cuda, stored, points.capacity())? };
        }
        let mut capacity = self.capacity().max(points.capacity());
        while capacity > points.capacity() && !self.is_allowed(capacity, &lights) {
            capacity /= 2;
        }
        if !self.is_allowed(capacity, &lights) {
            *self = DeviceTable { allowance, ..DeviceTable::default() };
            return Ok(None);
        }
        if capacity < self.capacity() {
            self.evict(cuda, capacity / 4, capacity)?;
        }
        let mut evicted = 0;
        loop {
            let bricks = match &self.bricks {
                Some(bricks) => bricks,
                None => self.bricks.insert(Bricks::new(cuda, points.capacity())?),
            };
            cuda.launch(ADMIT, slots(points.capacity()), &bricks.write(Cache { image: allowance.image, ..record }))?;
            let mut count = [0];
            bricks.count.read_into(0, &mut count)?;
            let capacity = self.capacity();
            if count[0] as usize <= capacity / 2 {
                self.hold(cuda, lights)?;
                return Ok(Some(rows));
            }
            // While it grows, the smaller table is still there.
            if self.is_allowed(capacity + 2 * capacity, &lights) {
                self.grow(cuda)?;
                continue;
            }
            evicted += 1;
            match evicted {
                1 => self.evict(cuda, capacity / 4, capacity)?,
                // Bricks of this image alone.
                2 => self.evict(cuda, 0, capacity)?,
                _ => {
                    *self = DeviceTable { allowance, ..DeviceTable::default() };
                    return Ok(None);
                }
            }
        }
    }

    /// Whether a table of this many slots may be held.
    fn is_allowed(&self, capacity: usize, lights: &[ColumnKey]) -> bool {
        let bytes = || {
            let columns: usize = lights.iter().map(bytes_of_brick).sum();
            (capacity * (size_of::<u64>() + size_of::<u32>() + columns)) as u64
        };
        self.allowance.most.is_none_or(|most| bytes() <= most)
    }

    /// Leaves `count` bricks, those that were used last, in a table of `capacity` slots.
    fn evict(&mut self, cuda: &Cuda<R>, count: usize, capacity: usize) -> Result<(), RenderError> {
        let (stored, allowance) = (self.youngest(count)?, self.allowance);
        *self = DeviceTable::default();
        *self = DeviceTable { allowance, ..DeviceTable::uploaded(cuda, stored, capacity)? };
        Ok(())
    }

    /// A table of at least `capacity` slots with stored values. Slots are assigned as `admit_bricks` does.
    fn uploaded(cuda: &Cuda<R>, stored: Stored, capacity: usize) -> Result<DeviceTable<R>, RenderError> {
        let capacity = capacity.max((2 * stored.bricks.len()).next_power_of_two());
        let mut keys = vec![0; capacity];
        let slot_for = |&brick: &BrickKey| {
            let mut slot = brick_hash(brick) & (capacity - 1);
            while keys[slot] != 0 {
                slot = (slot + 1) & (capacity - 1);
            }
            keys[slot] = brick + 1;
            slot
        };
        let slots: Vec<usize> = stored.bricks.iter().map(slot_for).collect();
        let bricks = Bricks::new(cuda, capacity)?;
        bricks.keys.write(&keys)?;
        bricks.count.write(&[slots.len() as u32])?;
        bricks.ages.write(&by_slot(&stored.ages, &slots, capacity))?;
        let column = |column: &StoredColumn| Column::uploaded(cuda, column, &slots, capacity);
        let columns = stored.columns.iter().map(column).collect::<Result<_, _>>()?;
        Ok(DeviceTable { bricks: Some(bricks), columns, ..DeviceTable::default() })
    }

    /// Provides a column for each light.
    fn hold(&mut self, cuda: &Cuda<R>, lights: Vec<ColumnKey>) -> Result<(), RenderError> {
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
        let from_ages = old.ages.output();
        let record = new.write(Cache { from_table: old.record(), from_ages, rows: rows.output(), ..Cache::zeroed() });
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
        (unknown, found): (&DevicePoints<R>, VisibilityOfLight),
    ) -> Result<(), RenderError> {
        let column = &mut self.columns[light];
        let record = Cache { lit: found, ..column.of(unknown, rows) };
        cuda.launch(LEARN, slots(unknown.capacity()), &record)?;
        column.count += unknown.count as u64;
        Ok(())
    }

    /// What all points of an image see of a light.
    pub(crate) fn lookup(
        &self,
        cuda: &Cuda<R>,
        light: usize,
        rows: &Buffer<R, u32>,
        (points, lit): (&DevicePoints<R>, VisibilityOfLight),
    ) -> Result<(), RenderError> {
        let record = Cache { lit, ..self.columns[light].of(points, rows) };
        cuda.launch(RECALL, slots(points.capacity()), &record)
    }
}

/// A launch of one thread per slot.
fn slots(capacity: usize) -> lightmesh_kernels::Launch {
    blocks_for(&(0..capacity.div_ceil(BLOCK as usize) as u64), BLOCK)
}

impl<R: Runtime> Bricks<R> {
    fn new(cuda: &Cuda<R>, capacity: usize) -> Result<Bricks<R>, RenderError> {
        let keys = cuda.pool().zeros("bricks of the cache", capacity)?;
        let count = cuda.pool().zeros("number of bricks of the cache", 1)?;
        Ok(Bricks { keys, count, ages: cuda.pool().zeros("ages of bricks of the cache", capacity)? })
    }

    fn memory(&self) -> u64 {
        self.keys.bytes() + self.count.bytes() + self.ages.bytes()
    }

    fn record(&self) -> BrickTable {
        BrickTable { keys: self.keys.output(), capacity: self.keys.len() as u32, spare: 0 }
    }

    /// Writes the addresses of the bricks into a kernel's arguments.
    fn write(&self, record: Cache) -> Cache {
        Cache { table: self.record(), bricks: self.count.output(), ages: self.ages.output(), ..record }
    }
}

impl<R: Runtime> Column<R> {
    fn new(cuda: &Cuda<R>, seen: ColumnKey, capacity: usize) -> Result<Column<R>, RenderError> {
        let known = cuda.pool().zeros("known light points", capacity)?;
        let answers = if seen.is_share() {
            Answers::Shares(cuda.pool().room("known shares of a light", capacity << POINT_BITS)?)
        } else {
            Answers::Bits(cuda.pool().zeros("known light points that see a light", capacity)?)
        };
        Ok(Column { seen, known, answers, count: 0 })
    }

    /// Stored values, by the slots of their bricks.
    fn uploaded(
        cuda: &Cuda<R>,
        stored: &StoredColumn,
        slots: &[usize],
        capacity: usize,
    ) -> Result<Column<R>, RenderError> {
        let mut column = Column::new(cuda, stored.seen.clone(), capacity)?;
        column.known.write(&by_slot(&stored.known, slots, capacity))?;
        match (&column.answers, &stored.answers) {
            (Answers::Bits(bits), StoredAnswers::Bits(words)) => bits.write(&by_slot(words, slots, capacity))?,
            (Answers::Shares(seen), StoredAnswers::Shares(shares)) => {
                let mut by_point = vec![0; capacity * POINTS];
                stored.spread(shares, |row, bit, share| by_point[slots[row] * POINTS + bit as usize] = share);
                seen.write(&by_point)?;
            }
            // A column has the same form as its light.
            _ => return Ok(column),
        }
        column.count = stored.known.iter().map(|known| u64::from(known.count_ones())).sum();
        Ok(column)
    }

    /// All values, by slot.
    fn download(&self) -> Result<Downloaded<'_>, RenderError> {
        let answers = match &self.answers {
            Answers::Bits(bits) => DownloadedAnswers::Bits(bits.read()?),
            Answers::Shares(seen) => DownloadedAnswers::Shares(seen.read()?),
        };
        Ok(Downloaded { seen: &self.seen, known: self.known.read()?, answers })
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

/// Values of bricks, by their slots.
fn by_slot<T: Copy + Default>(values: &[T], slots: &[usize], capacity: usize) -> Vec<T> {
    let mut by_slot = vec![T::default(); capacity];
    slots.iter().zip(values).for_each(|(&slot, &value)| by_slot[slot] = value);
    by_slot
}

/// The values of a column on the host, by slot.
struct Downloaded<'a> {
    seen: &'a ColumnKey,
    known: Vec<u64>,
    answers: DownloadedAnswers,
}

enum DownloadedAnswers {
    Bits(Vec<u64>),
    Shares(Vec<u16>),
}

impl Downloaded<'_> {
    fn readable(&self) -> Readable<'_> {
        let answers = match &self.answers {
            DownloadedAnswers::Bits(words) => ReadableAnswers::Bits(words),
            DownloadedAnswers::Shares(shares) => ReadableAnswers::Shares(shares),
        };
        Readable { seen: self.seen, known: &self.known, answers }
    }
}
