//! Names on a device and their numbers.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::constants::FULL_TABLE;
use lightmesh_layout::irradiance_cache::{Name, Names};

use super::device::{Device, read_count};
use crate::error::RenderError;
use crate::gpu::Cuda;

/// Slots of a new table: few, so that small scenes grow it, too.
const FIRST_CAPACITY: usize = 1 << 10;
/// How many times larger the next table is.
const GROWTH: usize = 4;

/// A table of names: at most half of its slots are taken.
pub(super) struct DeviceNames<R: Runtime> {
    keys: Buffer<R, u64>,
    numbers: Buffer<R, u32>,
    names: Buffer<R, Name>,
    count: Buffer<R, u32>,
    /// How many there are.
    known: usize,
}

impl<R: Runtime> DeviceNames<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceNames<R>, RenderError> {
        DeviceNames::with_capacity(cuda, FIRST_CAPACITY)
    }

    fn with_capacity(cuda: &Cuda<R>, capacity: usize) -> Result<DeviceNames<R>, RenderError> {
        let pool = cuda.pool();
        Ok(DeviceNames {
            keys: pool.zeros("names of cells", capacity)?,
            numbers: pool.room("numbers of cells", capacity)?,
            names: pool.room("cells by number", capacity / 2)?,
            count: pool.zeros("number of cells", 1)?,
            known: 0,
        })
    }

    /// Maximum number of names.
    pub(super) fn room(&self) -> usize {
        self.names.len()
    }

    pub(super) fn arguments(&self) -> Names {
        Names {
            keys: self.keys.output(),
            numbers: self.numbers.output(),
            names: self.names.output(),
            count: self.count.output(),
            capacity: self.keys.len() as u32,
            room: self.names.len() as u32,
        }
    }

    /// Adds the names that `ask` asks for. The numbers of the new ones.
    pub(super) fn admit(
        &mut self,
        device: &Device<R>,
        ask: impl Fn(Names) -> Result<(), RenderError>,
    ) -> Result<Range<usize>, RenderError> {
        let known = self.known;
        loop {
            ask(self.arguments())?;
            let count = read_count(&self.count)?;
            if count <= self.room() {
                self.known = count;
                return Ok(known..count);
            }
            self.grow(device, count & !(FULL_TABLE as usize))?;
        }
    }

    /// Moves all names that are in the table into a larger one, with their numbers.
    fn grow(&mut self, device: &Device<R>, count: usize) -> Result<(), RenderError> {
        let count = count.min(self.room());
        let larger = DeviceNames::with_capacity(device.cuda, GROWTH * self.keys.len())?;
        device.cuda.copy(&self.names, &larger.names, count)?;
        larger.count.write(&[count as u32])?;
        device.threads("add_names_again", count, &larger.arguments())?;
        *self = DeviceNames { known: self.known, ..larger };
        Ok(())
    }

    /// All names, by number.
    pub(super) fn read(&self) -> Result<Vec<Name>, RenderError> {
        let mut names = vec![Name::zeroed(); self.known];
        self.names.read_into(0, &mut names)?;
        Ok(names)
    }

    /// A table of these names, which are numbered in their order.
    pub(super) fn restored(device: &Device<R>, names: Vec<Name>) -> Result<DeviceNames<R>, RenderError> {
        let count = names.len();
        let capacity = FIRST_CAPACITY.max((2 * count).next_power_of_two());
        let table = DeviceNames::with_capacity(device.cuda, capacity)?;
        table.names.write(&names)?;
        table.count.write(&[count as u32])?;
        device.threads("add_names_again", count, &table.arguments())?;
        Ok(DeviceNames { known: count, ..table })
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        self.keys.bytes() + self.numbers.bytes() + self.names.bytes()
    }
}
