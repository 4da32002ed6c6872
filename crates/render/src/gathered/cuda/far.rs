//! What coarse sites gather, on a device.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::gathered::{FarLight, GatherFar, GuideFans, Site, TakeSites};
use lightmesh_layout::{In, Out};

use super::bounce::DeviceBounce;
use super::cells::DeviceCells;
use super::device::{Device, read_count};
use super::fans::{DeviceFans, Guides, Sites, guides, taken};
use crate::error::RenderError;
use crate::gathered::fan::Fan;
use crate::gpu::Cuda;

/// What coarse sites gather, by the number of its value.
pub(super) struct DeviceFar<R: Runtime> {
    pub(super) far: Buffer<R, FarLight>,
}

/// Where results go: the number of the first, in a list.
#[derive(Clone, Copy)]
struct Target {
    far: Out<FarLight>,
    first: usize,
}

impl<R: Runtime> DeviceFar<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceFar<R>, RenderError> {
        Ok(DeviceFar { far: cuda.pool().room("far light", 0)? })
    }

    pub(super) fn input(&self) -> In<FarLight> {
        self.far.input()
    }

    /// Computes new values: what the sites gather that own them.
    pub(super) fn extend(
        &mut self,
        device: &Device<R>,
        cells: &DeviceCells<R>,
        new: Range<usize>,
        bounce: &mut DeviceBounce<R>,
        fans: [Fan; 2],
    ) -> Result<(), RenderError> {
        device.cuda.extend(&mut self.far, "far light", new.start, new.end)?;
        let at_once = device.at_once(fans[0]);
        for first in new.clone().step_by(at_once) {
            let count = at_once.min(new.end - first);
            let from = TakeSites { sites: cells.sites(), numbers: cells.owners(), ..TakeSites::zeroed() };
            let sites = taken(device, TakeSites { first: first as u32, ..from }, count)?;
            gather(device, bounce, sites, fans, Target { far: self.far.output(), first })?;
        }
        Ok(())
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        self.far.bytes()
    }
}

/// What some sites receive by their own rays alone: no more than can be cast at once.
pub(super) fn plain<R: Runtime>(
    device: &Device<R>,
    bounce: &mut DeviceBounce<R>,
    sites: Buffer<R, Site>,
    fans: [Fan; 2],
) -> Result<Buffer<R, FarLight>, RenderError> {
    let far = device.cuda.pool().room("light of sites that see no other", sites.len())?;
    gather(device, bounce, sites, fans, Target { far: far.output(), first: 0 })?;
    Ok(far)
}

/// What some sites gather.
fn gather<R: Runtime>(
    device: &Device<R>,
    bounce: &mut DeviceBounce<R>,
    sites: Buffer<R, Site>,
    fans: [Fan; 2],
    target: Target,
) -> Result<(), RenderError> {
    let (pool, count) = (device.cuda.pool(), sites.len());
    let uneven = pool.room::<u32>("sites that see different things", count)?;
    let uneven_count = pool.zeros::<u32>("number of sites that see different things", 1)?;
    let record = GatherFar {
        far: target.far,
        uneven: uneven.output(),
        uneven_count: uneven_count.output(),
        first: target.first as u32,
        ..GatherFar::zeroed()
    };
    // 1. A few rays from each.
    let first_fans = seen(device, bounce, sites, fans[0], None)?;
    device.warps("gather_far", count, &GatherFar { fans: first_fans.record, ..record })?;
    // 2. More where these see different things.
    let count = read_count(&uneven_count)?;
    let at_once = device.at_once(fans[1]);
    let chosen = pool.room::<u32>("some of them", at_once.min(count))?;
    for first in (0..count).step_by(at_once) {
        let count = at_once.min(count - first);
        let from = TakeSites {
            sites: first_fans.record.sites,
            numbers: uneven.input(),
            owners: chosen.output(),
            first: first as u32,
            ..TakeSites::zeroed()
        };
        let sites = taken(device, from, count)?;
        let from =
            GuideFans { fans: first_fans.record, uneven: uneven.input(), first: first as u32, ..GuideFans::zeroed() };
        let guides = guides(device, from, fans, count)?;
        let more = seen(device, bounce, sites, fans[1], Some(&guides))?;
        let before = fans[0].len() as u32;
        let joining = GatherFar { fans: more.record, owners: chosen.input(), before, ..record };
        device.warps("gather_far", count, &joining)?;
    }
    Ok(())
}

/// What the rays of a fan see from each site.
fn seen<R: Runtime>(
    device: &Device<R>,
    bounce: &mut DeviceBounce<R>,
    sites: Buffer<R, Site>,
    fan: Fan,
    guides: Option<&Guides<R>>,
) -> Result<DeviceFans<R>, RenderError> {
    device.wave.context.check()?;
    let fans = DeviceFans::cast(device, Sites { sites, reach: f32::INFINITY }, fan, guides)?;
    fans.see(device)?;
    bounce.complete(device, &fans)?;
    Ok(fans)
}
