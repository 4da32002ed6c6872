//! What coarse records gather, on a device.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::irradiance_cache::{CoarseLight, GatherCoarse, GuideRays, Record, TakeRecords};
use lightmesh_layout::{In, Out};

use super::bounce::DeviceBounce;
use super::cells::DeviceCells;
use super::device::{Device, read_count};
use super::hemisphere_rays::{DeviceHemisphereRays, Guides, Records, guides, taken};
use crate::error::RenderError;
use crate::gpu::Cuda;
use crate::stages::irradiance_cache::hemisphere_rays::HemisphereRays;

/// What coarse records gather, by the number of its value.
pub(super) struct DeviceCoarse<R: Runtime> {
    pub(super) coarse: Buffer<R, CoarseLight>,
}

/// Where results go: the number of the first, in a list.
#[derive(Clone, Copy)]
struct Target {
    coarse: Out<CoarseLight>,
    first: usize,
}

impl<R: Runtime> DeviceCoarse<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceCoarse<R>, RenderError> {
        Ok(DeviceCoarse { coarse: cuda.pool().room("coarse light", 0)? })
    }

    pub(super) fn input(&self) -> In<CoarseLight> {
        self.coarse.input()
    }

    /// Computes new values: what the records gather that own them.
    pub(super) fn extend(
        &mut self,
        device: &Device<R>,
        cells: &DeviceCells<R>,
        new: Range<usize>,
        bounce: &mut DeviceBounce<R>,
        hemispheres: [HemisphereRays; 2],
    ) -> Result<(), RenderError> {
        device.cuda.extend(&mut self.coarse, "coarse light", new.start, new.end)?;
        let at_once = device.at_once(hemispheres[0]);
        for first in new.clone().step_by(at_once) {
            let count = at_once.min(new.end - first);
            let from = TakeRecords { records: cells.records(), numbers: cells.owners(), ..TakeRecords::zeroed() };
            let records = taken(device, TakeRecords { first: first as u32, ..from }, count)?;
            gather(device, bounce, records, hemispheres, Target { coarse: self.coarse.output(), first })?;
        }
        Ok(())
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        self.coarse.bytes()
    }
}

/// What some records receive by their own rays alone: no more than can be cast at once.
pub(super) fn plain<R: Runtime>(
    device: &Device<R>,
    bounce: &mut DeviceBounce<R>,
    records: Buffer<R, Record>,
    hemispheres: [HemisphereRays; 2],
) -> Result<Buffer<R, CoarseLight>, RenderError> {
    let coarse = device.cuda.pool().room("light of records that see no other", records.len())?;
    gather(device, bounce, records, hemispheres, Target { coarse: coarse.output(), first: 0 })?;
    Ok(coarse)
}

/// What some records gather.
fn gather<R: Runtime>(
    device: &Device<R>,
    bounce: &mut DeviceBounce<R>,
    records: Buffer<R, Record>,
    hemispheres: [HemisphereRays; 2],
    target: Target,
) -> Result<(), RenderError> {
    let (pool, count) = (device.cuda.pool(), records.len());
    let uneven = pool.room::<u32>("records that see different things", count)?;
    let uneven_count = pool.zeros::<u32>("number of records that see different things", 1)?;
    let arguments = GatherCoarse {
        coarse: target.coarse,
        uneven: uneven.output(),
        uneven_count: uneven_count.output(),
        first: target.first as u32,
        ..GatherCoarse::zeroed()
    };
    // 1. A few rays from each.
    let first_rays = seen(device, bounce, records, hemispheres[0], None)?;
    device.warps("gather_coarse", count, &GatherCoarse { hemispheres: first_rays.arguments, ..arguments })?;
    // 2. More where these see different things.
    let count = read_count(&uneven_count)?;
    let at_once = device.at_once(hemispheres[1]);
    let chosen = pool.room::<u32>("some of them", at_once.min(count))?;
    for first in (0..count).step_by(at_once) {
        let count = at_once.min(count - first);
        let from = TakeRecords {
            records: first_rays.arguments.records,
            numbers: uneven.input(),
            owners: chosen.output(),
            first: first as u32,
            ..TakeRecords::zeroed()
        };
        let records = taken(device, from, count)?;
        let from = GuideRays {
            hemispheres: first_rays.arguments,
            uneven: uneven.input(),
            first: first as u32,
            ..GuideRays::zeroed()
        };
        let guides = guides(device, from, hemispheres, count)?;
        let more = seen(device, bounce, records, hemispheres[1], Some(&guides))?;
        let before = hemispheres[0].len() as u32;
        let joining = GatherCoarse { hemispheres: more.arguments, owners: chosen.input(), before, ..arguments };
        device.warps("gather_coarse", count, &joining)?;
    }
    Ok(())
}

/// What the rays of each record see.
fn seen<R: Runtime>(
    device: &Device<R>,
    bounce: &mut DeviceBounce<R>,
    records: Buffer<R, Record>,
    hemisphere: HemisphereRays,
    guides: Option<&Guides<R>>,
) -> Result<DeviceHemisphereRays<R>, RenderError> {
    device.wave.context.check()?;
    let hemispheres =
        DeviceHemisphereRays::cast(device, Records { records, reach: f32::INFINITY }, hemisphere, guides)?;
    hemispheres.see(device)?;
    bounce.complete(device, &hemispheres)?;
    Ok(hemispheres)
}
