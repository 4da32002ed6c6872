//! What fine sites receive, on a device.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::constants::{COARSER, NEAR_CELLS, NEAR_REACH};
use lightmesh_layout::gathered::{ComeCloser, GatherFine, LightPlace, Site, SurfaceLight, TakeSites};
use lightmesh_layout::{In, Out};

use super::bounce::DeviceBounce;
use super::cells::DeviceCells;
use super::device::{Device, read_count};
use super::fans::{DeviceFans, Sites, taken};
use super::far::{self, DeviceFar};
use crate::error::RenderError;
use crate::gathered::fan::Fans;
use crate::gpu::Cuda;

/// What fine sites receive, by the number of its value.
pub(super) struct DeviceFine<R: Runtime> {
    pub(super) fine: Buffer<R, SurfaceLight>,
}

/// What coarse sites know.
pub(super) struct Coarse<'a, R: Runtime> {
    pub(super) cells: &'a mut DeviceCells<R>,
    pub(super) far: &'a mut DeviceFar<R>,
    pub(super) bounce: &'a mut DeviceBounce<R>,
    pub(super) fans: &'a Fans,
}

/// Sites, as coarse as what they ask, and the same as places that ask.
pub(super) struct Asking<R: Runtime> {
    pub(super) sites: Buffer<R, Site>,
    pub(super) places: Buffer<R, LightPlace>,
}

/// Where results go: the number of the first, in a list.
struct Target {
    fine: Out<SurfaceLight>,
    first: usize,
}

impl<R: Runtime> DeviceFine<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceFine<R>, RenderError> {
        Ok(DeviceFine { fine: cuda.pool().room("fine light", 0)? })
    }

    pub(super) fn input(&self) -> In<SurfaceLight> {
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
            device.wave.context.check()?;
            let count = at_once.min(new.end - first);
            let places = device.cuda.pool().room("fine sites that ask", count)?;
            let from = TakeSites {
                sites: cells.sites(),
                numbers: cells.owners(),
                places: places.output(),
                first: first as u32,
                // As coarse as what they ask.
                coarser: COARSER,
                ..TakeSites::zeroed()
            };
            let asking = Asking { sites: taken(device, from, count)?, places };
            receive(device, asking, coarse, Target { fine: self.fine.output(), first })?;
        }
        Ok(())
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        self.fine.bytes()
    }
}

/// What sites receive that belong to no cell: no more than can be cast at once.
pub(super) fn plain<R: Runtime>(
    device: &Device<R>,
    asking: Asking<R>,
    coarse: &mut Coarse<R>,
) -> Result<Buffer<R, SurfaceLight>, RenderError> {
    let fine = device.cuda.pool().room("light of sites of no cell", asking.places.len())?;
    receive(device, asking, coarse, Target { fine: fine.output(), first: 0 })?;
    Ok(fine)
}

fn receive<R: Runtime>(
    device: &Device<R>,
    asking: Asking<R>,
    coarse: &mut Coarse<R>,
    target: Target,
) -> Result<(), RenderError> {
    let Asking { sites, places } = asking;
    let (pool, count) = (device.cuda.pool(), places.len());
    // 1. What is near.
    let from = Sites { sites, reach: NEAR_REACH * NEAR_CELLS };
    let fans = DeviceFans::cast(device, from, coarse.fans.near, None)?;
    let closer = ComeCloser { fans: fans.record, sites: fans.sites_output(), places: places.output() };
    device.threads("come_closer", count, &closer)?;

    // 2. The coarse sites around that are seen, and what they gather.
    let links = coarse.cells.links(device, &places)?;
    coarse.cells.settle(device, &places, &links)?;
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
        fine: target.fine,
        alone: alone.output(),
        alone_count: alone_count.output(),
        first: target.first as u32,
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
