//! What fine records receive, on a device.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::constants::{COARSER, NEAR_CELLS, NEAR_REACH};
use lightmesh_layout::irradiance_cache::{ComeCloser, GatherFine, LightPlace, Record, SurfaceLight, TakeRecords};
use lightmesh_layout::{In, Out};

use super::bounce::DeviceBounce;
use super::cells::DeviceCells;
use super::coarse::{self, DeviceCoarse};
use super::device::{Device, read_count};
use super::hemisphere_rays::{DeviceHemisphereRays, Records, taken};
use crate::error::RenderError;
use crate::gpu::Cuda;
use crate::stages::irradiance_cache::hemisphere_rays::RecordRays;
use crate::steps::Steps;

/// What fine records receive, by the number of its value.
pub(super) struct DeviceFine<R: Runtime> {
    pub(super) fine: Buffer<R, SurfaceLight>,
}

/// What coarse records know.
pub(super) struct CoarseRecords<'a, R: Runtime> {
    pub(super) cells: &'a mut DeviceCells<R>,
    pub(super) values: &'a mut DeviceCoarse<R>,
    pub(super) bounce: &'a mut DeviceBounce<R>,
    pub(super) rays: &'a RecordRays,
}

/// Records, as coarse as what they ask, and the same as places that ask.
pub(super) struct Asking<R: Runtime> {
    pub(super) records: Buffer<R, Record>,
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

    /// Computes new values: what the records receive that own them.
    pub(super) fn extend(
        &mut self,
        device: &Device<R>,
        cells: &DeviceCells<R>,
        new: Range<usize>,
        coarse: &mut CoarseRecords<R>,
        steps: &mut Steps,
    ) -> Result<(), RenderError> {
        device.cuda.extend(&mut self.fine, "fine light", new.start, new.end)?;
        let at_once = device.at_once(coarse.rays.fine);
        for first in new.clone().step_by(at_once) {
            device.wave.context.check()?;
            let count = at_once.min(new.end - first);
            let places = device.cuda.pool().room("fine records that ask", count)?;
            let from = TakeRecords {
                records: cells.records(),
                numbers: cells.owners(),
                places: places.output(),
                first: first as u32,
                // As coarse as what they ask.
                coarser: COARSER,
                ..TakeRecords::zeroed()
            };
            let asking = Asking { records: taken(device, from, count)?, places };
            receive(device, asking, coarse, Target { fine: self.fine.output(), first })?;
            steps.tell(first + count - new.start, new.len());
        }
        Ok(())
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        self.fine.bytes()
    }
}

/// What records receive that belong to no cell: no more than can be cast at once.
pub(super) fn plain<R: Runtime>(
    device: &Device<R>,
    asking: Asking<R>,
    coarse: &mut CoarseRecords<R>,
) -> Result<Buffer<R, SurfaceLight>, RenderError> {
    let fine = device.cuda.pool().room("light of records of no cell", asking.places.len())?;
    receive(device, asking, coarse, Target { fine: fine.output(), first: 0 })?;
    Ok(fine)
}

fn receive<R: Runtime>(
    device: &Device<R>,
    asking: Asking<R>,
    coarse: &mut CoarseRecords<R>,
    target: Target,
) -> Result<(), RenderError> {
    let Asking { records, places } = asking;
    let (pool, count) = (device.cuda.pool(), places.len());
    // 1. What is near.
    let from = Records { records, reach: NEAR_REACH * NEAR_CELLS };
    let hemispheres = DeviceHemisphereRays::cast(device, from, coarse.rays.fine, None)?;
    let closer = ComeCloser {
        hemispheres: hemispheres.arguments,
        records: hemispheres.records_output(),
        places: places.output(),
    };
    device.threads("come_closer", count, &closer)?;

    // 2. The coarse records around that are seen, and what they gather.
    let links = coarse.cells.links(device, &places)?;
    coarse.cells.settle(device, &places, &links)?;
    let new = coarse.cells.value(device, &places, &links)?;
    coarse.values.extend(device, coarse.cells, new, coarse.bounce, coarse.rays.coarse)?;

    // 3. What near rays see.
    hemispheres.see(device)?;
    coarse.bounce.complete(device, &hemispheres)?;

    // 4. Both together; more rays of their own for records that see no coarse one.
    let misses = pool.room::<u32>("fine records that see no coarse one", count)?;
    let miss_count = pool.zeros::<u32>("number of fine records that see no coarse one", 1)?;
    let arguments = GatherFine {
        hemispheres: hemispheres.arguments,
        lookup: coarse.cells.lookup(device, &places, &links),
        coarse: coarse.values.input(),
        fine: target.fine,
        misses: misses.output(),
        miss_count: miss_count.output(),
        first: target.first as u32,
        ..GatherFine::zeroed()
    };
    device.warps("gather_fine", count, &arguments)?;
    let count = read_count(&miss_count)?;
    let at_once = device.at_once(coarse.rays.coarse[0]);
    for first in (0..count).step_by(at_once) {
        let count = at_once.min(count - first);
        let from =
            TakeRecords { records: hemispheres.arguments.records, numbers: misses.input(), ..TakeRecords::zeroed() };
        let records = taken(device, TakeRecords { first: first as u32, ..from }, count)?;
        let own = coarse::plain(device, coarse.bounce, records, coarse.rays.coarse)?;
        let arguments = GatherFine { coarse: own.input(), first_miss: first as u32, count: count as u32, ..arguments };
        device.threads("take_light", count, &arguments)?;
    }
    Ok(())
}
