//! Cells and their records on a device, and what places take from them.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::In;
use lightmesh_layout::constants::SURFACE_KINDS;
use lightmesh_layout::irradiance_cache::{LightPlace, Link, Lookup, Record, SurfaceCells};

use super::device::{Device, read_count};
use super::names::DeviceNames;
use crate::error::RenderError;
use crate::gpu::{Cuda, PerStructure, per_structure};

const PLACE_RECORDS: PerStructure = per_structure!("irradiance_cache_rays", "place_records");
const SETTLE: PerStructure = per_structure!("irradiance_cache_rays", "settle_links");
/// New cells whose records are placed at once.
const CELLS_AT_ONCE: usize = 1 << 15;

/// Cells with their records. Some of these have a value, which is stored elsewhere by its number.
pub(super) struct DeviceCells<R: Runtime> {
    pub(super) names: DeviceNames<R>,
    pub(super) ranges: Buffer<R, u64>,
    pub(super) records: Buffer<R, Record>,
    pub(super) record_count: Buffer<R, u32>,
    /// By record.
    pub(super) values: Buffer<R, u32>,
    pub(super) owners: Buffer<R, u32>,
    pub(super) value_count: Buffer<R, u32>,
    pub(super) record_number: usize,
    pub(super) value_number: usize,
}

/// The records that places take light from.
pub(super) struct DeviceLinks<R: Runtime> {
    offsets: Buffer<R, u32>,
    links: Buffer<R, Link>,
}

impl<R: Runtime> DeviceCells<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceCells<R>, RenderError> {
        let pool = cuda.pool();
        let names = DeviceNames::new(cuda)?;
        Ok(DeviceCells {
            ranges: pool.room("ranges of records", names.room())?,
            names,
            records: pool.room("records", 0)?,
            record_count: pool.zeros("number of records", 1)?,
            values: pool.room("values of records", 0)?,
            owners: pool.room("records of values", 0)?,
            value_count: pool.zeros("number of values", 1)?,
            record_number: 0,
            value_number: 0,
        })
    }

    fn arguments(&self) -> SurfaceCells {
        SurfaceCells {
            cells: self.names.arguments(),
            ranges: self.ranges.output(),
            records: self.records.output(),
            record_count: self.record_count.output(),
            values: self.values.output(),
            owners: self.owners.output(),
            value_count: self.value_count.output(),
        }
    }

    /// All records.
    pub(super) fn records(&self) -> In<Record> {
        self.records.input()
    }

    /// The records of values.
    pub(super) fn owners(&self) -> In<u32> {
        self.owners.input()
    }

    /// The arguments of kernels about the records of places.
    pub(super) fn lookup(&self, device: &Device<R>, places: &Buffer<R, LightPlace>, links: &DeviceLinks<R>) -> Lookup {
        Lookup { offsets: links.offsets.output(), links: links.links.output(), ..self.asked(device, places) }
    }

    fn asked(&self, device: &Device<R>, places: &Buffer<R, LightPlace>) -> Lookup {
        Lookup {
            scene: device.wave.scene.record,
            table: self.arguments(),
            places: places.input(),
            count: places.len() as u32,
            ..Lookup::zeroed()
        }
    }

    /// Finds the records of places; their cells are added where they are new.
    pub(super) fn links(
        &mut self,
        device: &Device<R>,
        places: &Buffer<R, LightPlace>,
    ) -> Result<DeviceLinks<R>, RenderError> {
        let cuda = device.cuda;
        let asked = self.asked(device, places);
        let new = self.names.admit(device, |cells| {
            device.threads(
                "find_cells",
                places.len(),
                &Lookup { table: SurfaceCells { cells, ..asked.table }, ..asked },
            )
        })?;
        self.place(device, new)?;

        let offsets = cuda.pool().room("number of records of places", places.len() + 1)?;
        let arguments = Lookup { offsets: offsets.output(), ..self.asked(device, places) };
        device.threads("count_links", places.len(), &arguments)?;
        let count = cuda.scan_total(&offsets)?;
        let links = cuda.pool().room("records of places", count)?;
        device.threads("fill_links", places.len(), &Lookup { links: links.output(), ..arguments })?;
        Ok(DeviceLinks { offsets, links })
    }

    /// Finds the records of new cells.
    fn place(&mut self, device: &Device<R>, new: Range<usize>) -> Result<(), RenderError> {
        let cuda = device.cuda;
        cuda.extend(&mut self.ranges, "ranges of records", new.start, self.names.room())?;
        for first in new.clone().step_by(CELLS_AT_ONCE) {
            device.wave.context.check()?;
            let count = CELLS_AT_ONCE.min(new.end - first);
            let most = self.record_number + count * SURFACE_KINDS as usize;
            cuda.extend(&mut self.records, "records", self.record_number, most)?;
            cuda.extend(&mut self.owners, "records of values", self.value_number, most)?;
            cuda.extend(&mut self.values, "values of records", self.record_number, most)?;
            let arguments = Lookup {
                scene: device.wave.scene.record,
                tally: cuda.tally()?,
                table: self.arguments(),
                first: first as u32,
                count: count as u32,
                ..Lookup::zeroed()
            };
            device.searching(PLACE_RECORDS, count, &arguments)?;
            self.record_number = read_count(&self.record_count)?;
        }
        Ok(())
    }

    /// Numbers the values of the records that have a weight, if they have none. Returns the new ones.
    pub(super) fn value(
        &mut self,
        device: &Device<R>,
        places: &Buffer<R, LightPlace>,
        links: &DeviceLinks<R>,
    ) -> Result<Range<usize>, RenderError> {
        device.threads("value_links", places.len(), &self.lookup(device, places, links))?;
        let known = std::mem::replace(&mut self.value_number, read_count(&self.value_count)?);
        Ok(known..self.value_number)
    }

    /// Takes their weight from records that places do not see, and balances the others.
    pub(super) fn settle(
        &self,
        device: &Device<R>,
        places: &Buffer<R, LightPlace>,
        links: &DeviceLinks<R>,
    ) -> Result<(), RenderError> {
        let arguments = Lookup { tally: device.cuda.tally()?, ..self.lookup(device, places, links) };
        device.tracing(SETTLE, places.len(), &arguments)
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        let records = self.records.bytes() + self.values.bytes() + self.owners.bytes();
        self.names.memory() + self.ranges.bytes() + records
    }
}
