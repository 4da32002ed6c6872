//! Cells and their sites on a device, and what places take from them.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::In;
use lightmesh_layout::constants::SURFACE_KINDS;
use lightmesh_layout::gathered::{LightPlace, Link, Lookup, Site, SurfaceCells};

use super::device::{Device, read_count};
use super::names::DeviceNames;
use crate::error::RenderError;
use crate::gpu::{Cuda, PerStructure, per_structure};

const PLACE_SITES: PerStructure = per_structure!("gathered_rays", "place_sites");
const SETTLE: PerStructure = per_structure!("gathered_rays", "settle_links");
/// New cells whose sites are placed at once.
const CELLS_AT_ONCE: usize = 1 << 15;

/// Cells with their sites. Some of these have a value, which is stored elsewhere by its number.
pub(super) struct DeviceCells<R: Runtime> {
    pub(super) names: DeviceNames<R>,
    pub(super) ranges: Buffer<R, u64>,
    pub(super) sites: Buffer<R, Site>,
    pub(super) site_count: Buffer<R, u32>,
    /// By site.
    pub(super) values: Buffer<R, u32>,
    pub(super) owners: Buffer<R, u32>,
    pub(super) value_count: Buffer<R, u32>,
    pub(super) site_number: usize,
    pub(super) value_number: usize,
}

/// The sites that places take light from.
pub(super) struct DeviceLinks<R: Runtime> {
    offsets: Buffer<R, u32>,
    links: Buffer<R, Link>,
}

impl<R: Runtime> DeviceCells<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceCells<R>, RenderError> {
        let pool = cuda.pool();
        let names = DeviceNames::new(cuda)?;
        Ok(DeviceCells {
            ranges: pool.room("ranges of sites", names.room())?,
            names,
            sites: pool.room("sites", 0)?,
            site_count: pool.zeros("number of sites", 1)?,
            values: pool.room("values of sites", 0)?,
            owners: pool.room("sites of values", 0)?,
            value_count: pool.zeros("number of values", 1)?,
            site_number: 0,
            value_number: 0,
        })
    }

    fn record(&self) -> SurfaceCells {
        SurfaceCells {
            cells: self.names.record(),
            ranges: self.ranges.output(),
            sites: self.sites.output(),
            site_count: self.site_count.output(),
            values: self.values.output(),
            owners: self.owners.output(),
            value_count: self.value_count.output(),
        }
    }

    /// All sites.
    pub(super) fn sites(&self) -> In<Site> {
        self.sites.input()
    }

    /// The sites of values.
    pub(super) fn owners(&self) -> In<u32> {
        self.owners.input()
    }

    /// The arguments of kernels about the sites of places.
    pub(super) fn lookup(&self, device: &Device<R>, places: &Buffer<R, LightPlace>, links: &DeviceLinks<R>) -> Lookup {
        Lookup { offsets: links.offsets.output(), links: links.links.output(), ..self.asked(device, places) }
    }

    fn asked(&self, device: &Device<R>, places: &Buffer<R, LightPlace>) -> Lookup {
        Lookup {
            scene: device.wave.scene.record,
            table: self.record(),
            places: places.input(),
            count: places.len() as u32,
            ..Lookup::zeroed()
        }
    }

    /// Finds the sites of places; their cells are added where they are new.
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

        let offsets = cuda.pool().room("number of sites of places", places.len() + 1)?;
        let record = Lookup { offsets: offsets.output(), ..self.asked(device, places) };
        device.threads("count_links", places.len(), &record)?;
        let count = cuda.scan_total(&offsets)?;
        let links = cuda.pool().room("sites of places", count)?;
        device.threads("fill_links", places.len(), &Lookup { links: links.output(), ..record })?;
        Ok(DeviceLinks { offsets, links })
    }

    /// Finds the sites of new cells.
    fn place(&mut self, device: &Device<R>, new: Range<usize>) -> Result<(), RenderError> {
        let cuda = device.cuda;
        cuda.extend(&mut self.ranges, "ranges of sites", new.start, self.names.room())?;
        for first in new.clone().step_by(CELLS_AT_ONCE) {
            device.wave.context.check()?;
            let count = CELLS_AT_ONCE.min(new.end - first);
            let most = self.site_number + count * SURFACE_KINDS as usize;
            cuda.extend(&mut self.sites, "sites", self.site_number, most)?;
            cuda.extend(&mut self.owners, "sites of values", self.value_number, most)?;
            cuda.extend(&mut self.values, "values of sites", self.site_number, most)?;
            let record = Lookup {
                scene: device.wave.scene.record,
                tally: cuda.tally()?,
                table: self.record(),
                first: first as u32,
                count: count as u32,
                ..Lookup::zeroed()
            };
            device.searching(PLACE_SITES, count, &record)?;
            self.site_number = read_count(&self.site_count)?;
        }
        Ok(())
    }

    /// Numbers the values of the sites that have a weight, if they have none. Returns the new ones.
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

    /// Takes their weight from sites that places do not see, and balances the others.
    pub(super) fn settle(
        &self,
        device: &Device<R>,
        places: &Buffer<R, LightPlace>,
        links: &DeviceLinks<R>,
    ) -> Result<(), RenderError> {
        let record = Lookup { tally: device.cuda.tally()?, ..self.lookup(device, places, links) };
        device.tracing(SETTLE, places.len(), &record)
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        let sites = self.sites.bytes() + self.values.bytes() + self.owners.bytes();
        self.names.memory() + self.ranges.bytes() + sites
    }
}
