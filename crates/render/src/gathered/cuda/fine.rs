//! What fine sites receive, on a device.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_layout::In;
use lightmesh_layout::constants::{COARSER, NEAR_CELLS, NEAR_REACH};
use lightmesh_layout::gathered::{FineLight, GatherFine, TakeSites};

use super::bounce::DeviceBounce;
use super::cells::{DeviceCells, Nearest};
use super::device::{Device, read_count};
use super::fans::{DeviceFans, Sites, taken};
use super::far::{self, DeviceFar};
use crate::cuda::{Buffer, Runtime};
use crate::error::RenderError;
use crate::gathered::rays::Fans;
use crate::gpu::Cuda;

/// What fine sites receive, by the number of its value.
pub(super) struct DeviceFine<R: Runtime> {
    fine: Buffer<R, FineLight>,
}

/// What coarse sites know.
pub(super) struct Coarse<'a, R: Runtime> {
    pub(super) cells: &'a mut DeviceCells<R>,
    pub(super) far: &'a mut DeviceFar<R>,
    pub(super) bounce: &'a mut DeviceBounce<R>,
    pub(super) fans: &'a Fans,
}

impl<R: Runtime> DeviceFine<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceFine<R>, RenderError> {
        Ok(DeviceFine { fine: cuda.pool().room("fine light", 0)? })
    }

    pub(super) fn input(&self) -> In<FineLight> {
        self.fine.input()
    }

    /// Computes new values: what the sites receive that own them.
    pub(super) fn extend(
        &mut self,
        device: &Device<R>,
        cells: &DeviceCells<R>,
        new: Range<usize>,
        coarse: &mut Coarse<R>,
    ) -> Result<(), RenderError> {
        device.cuda.extend(&mut self.fine, "fine light", new.start, new.end)?;
        let at_once = device.at_once(coarse.fans.near);
        for first in new.clone().step_by(at_once) {
            device.wave.job.check()?;
            self.receive(device, cells, first..new.end.min(first + at_once), coarse)?;
        }
        Ok(())
    }

    fn receive(
        &self,
        device: &Device<R>,
        cells: &DeviceCells<R>,
        numbers: Range<usize>,
        coarse: &mut Coarse<R>,
    ) -> Result<(), RenderError> {
        let (pool, count) = (device.cuda.pool(), numbers.len());
        // 1. What is near. Sites are as coarse as what they ask.
        let places = pool.room("fine sites that ask", count)?;
        let from = TakeSites {
            sites: cells.sites(),
            numbers: cells.owners(),
            places: places.output(),
            first: numbers.start as u32,
            coarser: COARSER,
            ..TakeSites::zeroed()
        };
        let sites = taken(device, from, count)?;
        let from = Sites { sites, reach: NEAR_REACH * NEAR_CELLS, nodes: None };
        let mut fans = DeviceFans::cast(device, from, coarse.fans.near)?;
        let nearest = fans.nearest(device)?;

        // 2. The coarse sites around that are seen, and what they gather.
        let links = coarse.cells.links(device, &places)?;
        coarse.cells.settle(device, &places, &links, Nearest::OfPlaces(nearest.input()))?;
        let new = coarse.cells.value(device, &places, &links)?;
        coarse.far.extend(device, coarse.cells, new, coarse.bounce, coarse.fans.far)?;

        // 3. What near rays see.
        fans.see(device)?;
        coarse.bounce.complete(device, &fans)?;

        // 4. Both together; more rays of their own for sites that see no coarse one.
        let alone = pool.room::<u32>("fine sites that see no coarse one", count)?;
        let alone_count = pool.zeros::<u32>("number of fine sites that see no coarse one", 1)?;
        let record = GatherFine {
            fans: fans.record,
            lookup: coarse.cells.lookup(device, &places, &links),
            far: coarse.far.input(),
            fine: self.fine.output(),
            alone: alone.output(),
            alone_count: alone_count.output(),
            first: numbers.start as u32,
            ..GatherFine::zeroed()
        };
        device.warps("gather_fine", count, &record)?;
        let count = read_count(&alone_count)?;
        let at_once = device.at_once(coarse.fans.far[0]);
        for first in (0..count).step_by(at_once) {
            let count = at_once.min(count - first);
            let from = TakeSites { sites: fans.record.sites, numbers: alone.input(), ..TakeSites::zeroed() };
            let sites = taken(device, TakeSites { first: first as u32, ..from }, count)?;
            let own = far::plain(device, coarse.bounce, sites, coarse.fans.far)?;
            let record = GatherFine { far: own.input(), first_alone: first as u32, count: count as u32, ..record };
            device.threads("take_light", count, &record)?;
        }
        Ok(())
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        self.fine.bytes()
    }
}
