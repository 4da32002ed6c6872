//! Light that was reflected several times, on a device.

use bytemuck::Zeroable;
use lightmesh_layout::gathered::{Bounce, Names, Node, Site, TakeSites};

use super::device::{Device, read_count};
use super::fans::{DeviceFans, Sites, taken};
use super::names::DeviceNames;
use crate::cuda::{Buffer, Runtime};
use crate::error::RenderError;
use crate::gathered::bounce::{FAN, ORDERS};
use crate::gpu::{Cuda, PerStructure, per_structure};

const PLACE_NODES: PerStructure = per_structure!("gathered_rays", "place_nodes");
const HIDE_NODES: PerStructure = per_structure!("gathered_rays", "hide_nodes");
/// New nodes that are placed at once.
const NODES_AT_ONCE: usize = 1 << 16;

/// All sites that rays of others hit.
pub(super) struct DeviceBounce<R: Runtime> {
    pub(super) names: DeviceNames<R>,
    pub(super) nodes: Buffer<R, Node>,
    pub(super) sites: Buffer<R, Site>,
    pub(super) stamps: Buffer<R, u32>,
    pub(super) listed: Buffer<R, u32>,
    pub(super) listed_count: Buffer<R, u32>,
    /// The number of the last list.
    pub(super) stamp: u32,
}

impl<R: Runtime> DeviceBounce<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceBounce<R>, RenderError> {
        let pool = cuda.pool();
        let names = DeviceNames::new(cuda)?;
        let room = names.room();
        Ok(DeviceBounce {
            names,
            nodes: pool.room("nodes", room)?,
            sites: pool.room("sites of nodes", room)?,
            stamps: pool.zeros("lists of nodes", room)?,
            listed: pool.room("listed nodes", room)?,
            listed_count: pool.zeros("number of listed nodes", 1)?,
            stamp: 0,
        })
    }

    fn record(&self, fans: &DeviceFans<R>, order: u32) -> Bounce {
        Bounce { order, stamp: self.stamp, ..self.with_names(fans, self.names.record()) }
    }

    fn with_names(&self, fans: &DeviceFans<R>, names: Names) -> Bounce {
        Bounce {
            scene: fans.record.scene,
            fans: fans.record,
            names,
            nodes: self.nodes.output(),
            sites: self.sites.output(),
            stamps: self.stamps.output(),
            listed: self.listed.output(),
            listed_count: self.listed_count.output(),
            ..Bounce::zeroed()
        }
    }

    /// Adds to what rays see what is reflected of light that lights do not give.
    pub(super) fn complete(&mut self, device: &Device<R>, fans: &DeviceFans<R>) -> Result<(), RenderError> {
        self.resolve(device, fans, ORDERS as u32)?;
        device.warps("reflect", fans.sites, &self.record(fans, ORDERS as u32))
    }

    /// Finds the sites that rays see; what arrives there after up to `order` reflections is known.
    fn resolve(&mut self, device: &Device<R>, fans: &DeviceFans<R>, order: u32) -> Result<(), RenderError> {
        self.ensure(device, fans, order)?;
        device.tracing(HIDE_NODES, fans.rays, &self.record(fans, order))
    }

    /// What arrives at the sites that rays see after up to `order` reflections is known afterwards.
    fn ensure(&mut self, device: &Device<R>, fans: &DeviceFans<R>, order: u32) -> Result<(), RenderError> {
        let pool = device.cuda.pool();
        self.admit(device, fans)?;
        // 1. The sites of which it is not.
        self.stamp += 1;
        self.listed_count.clear()?;
        device.threads("list_nodes", fans.rays, &self.record(fans, order))?;
        let count = read_count(&self.listed_count)?;
        // What follows makes other lists.
        let lacking = pool.room("nodes of which more is asked", count)?;
        device.cuda.copy(&self.listed, &lacking, count)?;
        let at_once = device.at_once(FAN);
        for first in (0..count).step_by(at_once) {
            device.wave.job.check()?;
            let count = at_once.min(count - first);
            let own = self.cast(device, &lacking, first, count)?;
            device.threads("sum_first", count, &self.record(&own, order))?;
            // 2. What arrives at those that their rays hit, after one reflection less; and the sums.
            if order > 1 {
                self.resolve(device, &own, order - 1)?;
                device.threads("sum_second", count, &self.record(&own, order))?;
            }
        }
        Ok(())
    }

    /// Adds sites where they are new.
    fn admit(&mut self, device: &Device<R>, fans: &DeviceFans<R>) -> Result<(), RenderError> {
        let names = self.names.record();
        let asked = self.with_names(fans, names);
        let new =
            self.names.admit(device, |names| device.threads("name_nodes", fans.rays, &Bounce { names, ..asked }))?;
        let (cuda, room) = (device.cuda, self.names.room());
        cuda.extend(&mut self.nodes, "nodes", new.start, room)?;
        cuda.extend(&mut self.sites, "sites of nodes", new.start, room)?;
        cuda.extend(&mut self.stamps, "lists of nodes", new.start, room)?;
        cuda.extend(&mut self.listed, "listed nodes", 0, room)?;
        for first in new.clone().step_by(NODES_AT_ONCE) {
            let count = NODES_AT_ONCE.min(new.end - first);
            let record = Bounce { first: first as u32, count: count as u32, ..self.record(fans, 0) };
            device.searching(PLACE_NODES, count, &record)?;
        }
        Ok(())
    }

    /// Casts the rays of some of the listed nodes. Those that were cast before, for one reflection, are cast again: that takes less than to keep
    /// what they hit.
    fn cast(
        &self,
        device: &Device<R>,
        listed: &Buffer<R, u32>,
        first: usize,
        count: usize,
    ) -> Result<DeviceFans<R>, RenderError> {
        let owners = device.cuda.pool().room("listed nodes at once", count)?;
        let from = TakeSites {
            sites: self.sites.input(),
            numbers: listed.input(),
            owners: owners.output(),
            first: first as u32,
            ..TakeSites::zeroed()
        };
        let sites = taken(device, from, count)?;
        let nodes = Some((owners, self.nodes.input()));
        let fans = DeviceFans::cast(device, Sites { sites, reach: f32::INFINITY, nodes }, FAN)?;
        fans.see(device)?;
        Ok(fans)
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        let nodes = self.nodes.bytes() + self.sites.bytes() + self.stamps.bytes() + self.listed.bytes();
        self.names.memory() + nodes
    }
}
