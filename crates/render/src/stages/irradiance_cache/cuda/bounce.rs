//! Light that was reflected several times, on a device.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::constants::BOUNCE_FINER;
use lightmesh_layout::irradiance_cache::{Bounce, Node, NodeLink, Record, TakeRecords};

use super::device::{Device, read_count};
use super::hemisphere_rays::{DeviceHemisphereRays, Records, taken};
use super::names::DeviceNames;
use crate::error::RenderError;
use crate::gpu::{Cuda, PerStructure, per_structure};
use crate::stages::irradiance_cache::bounce::{NODE_RAYS, ORDERS};

const PLACE_NODES: PerStructure = per_structure!("irradiance_cache_rays", "place_nodes");
const HIDE_NODES: PerStructure = per_structure!("irradiance_cache_rays", "hide_nodes");
/// New nodes that are placed at once.
const NODES_AT_ONCE: usize = 1 << 16;

/// All nodes, and what their rays see.
pub(super) struct DeviceBounce<R: Runtime> {
    pub(super) names: DeviceNames<R>,
    pub(super) nodes: Buffer<R, Node>,
    pub(super) records: Buffer<R, Record>,
    pub(super) links: Buffer<R, NodeLink>,
    /// How many nodes are linked.
    pub(super) linked: usize,
    pub(super) listed: Buffer<R, u32>,
    pub(super) listed_count: Buffer<R, u32>,
    pub(super) unlinked: Buffer<R, u32>,
    pub(super) unlinked_count: Buffer<R, u32>,
}

impl<R: Runtime> DeviceBounce<R> {
    pub(super) fn new(cuda: &Cuda<R>) -> Result<DeviceBounce<R>, RenderError> {
        let pool = cuda.pool();
        let names = DeviceNames::new(cuda)?;
        let room = names.room();
        Ok(DeviceBounce {
            names,
            nodes: pool.room("nodes", room)?,
            records: pool.room("records of nodes", room)?,
            links: pool.room("links of nodes", 0)?,
            linked: 0,
            listed: pool.room("listed nodes", room)?,
            listed_count: pool.zeros("number of listed nodes", 1)?,
            unlinked: pool.room("nodes without links", room)?,
            unlinked_count: pool.zeros("number of nodes without links", 1)?,
        })
    }

    fn arguments(&self, hemispheres: &DeviceHemisphereRays<R>) -> Bounce {
        Bounce {
            scene: hemispheres.arguments.scene,
            hemispheres: hemispheres.arguments,
            names: self.names.arguments(),
            nodes: self.nodes.output(),
            records: self.records.output(),
            links: self.links.output(),
            listed: self.listed.output(),
            listed_count: self.listed_count.output(),
            unlinked: self.unlinked.output(),
            unlinked_count: self.unlinked_count.output(),
            linked: self.linked as u32,
            ..Bounce::zeroed()
        }
    }

    /// Adds to what rays see what is reflected of light that lights do not give.
    pub(super) fn complete(
        &mut self,
        device: &Device<R>,
        hemispheres: &DeviceHemisphereRays<R>,
    ) -> Result<(), RenderError> {
        self.resolve(device, hemispheres, true)?;
        self.ensure(device, hemispheres)?;
        device.warps("reflect", hemispheres.records, &self.arguments(hemispheres))
    }

    /// Finds the nodes that rays see; they are added where they are new. Only rays that insist ask on where something is in the way: all, or those
    /// that see more than the mean.
    fn resolve(
        &mut self,
        device: &Device<R>,
        hemispheres: &DeviceHemisphereRays<R>,
        insist: bool,
    ) -> Result<(), RenderError> {
        for finer in 0..=BOUNCE_FINER {
            self.admit(device, hemispheres, finer)?;
            device.tracing(
                HIDE_NODES,
                hemispheres.rays,
                &Bounce { finer, insist: insist.into(), ..self.arguments(hemispheres) },
            )?;
        }
        Ok(())
    }

    /// Adds the nodes that rays ask which have no answer yet, where they are new.
    fn admit(
        &mut self,
        device: &Device<R>,
        hemispheres: &DeviceHemisphereRays<R>,
        finer: i32,
    ) -> Result<(), RenderError> {
        let asked = Bounce { finer, ..self.arguments(hemispheres) };
        let new = self
            .names
            .admit(device, |names| device.threads("name_nodes", hemispheres.rays, &Bounce { names, ..asked }))?;
        let (cuda, room) = (device.cuda, self.names.room());
        cuda.extend(&mut self.nodes, "nodes", new.start, room)?;
        cuda.extend(&mut self.records, "records of nodes", new.start, room)?;
        cuda.extend(&mut self.listed, "listed nodes", new.start, room)?;
        cuda.extend(&mut self.unlinked, "nodes without links", new.start, room)?;
        for first in new.clone().step_by(NODES_AT_ONCE) {
            let count = NODES_AT_ONCE.min(new.end - first);
            let arguments = Bounce { first: first as u32, count: count as u32, ..self.arguments(hemispheres) };
            device.searching(PLACE_NODES, count, &arguments)?;
        }
        Ok(())
    }

    /// All that arrives at the nodes that rays see is known afterwards.
    fn ensure(&mut self, device: &Device<R>, hemispheres: &DeviceHemisphereRays<R>) -> Result<(), RenderError> {
        // 1. From reflection to reflection back, the nodes of which more is asked than is known. Each is listed with the highest number first.
        self.listed_count.clear()?;
        device.threads(
            "list_nodes",
            hemispheres.rays,
            &Bounce { order: ORDERS as u32, ..self.arguments(hemispheres) },
        )?;
        let (mut frontier, mut ends) = (0..read_count(&self.listed_count)?, [0; ORDERS]);
        for order in (1..=ORDERS).rev() {
            ends[order - 1] = frontier.end;
            if frontier.is_empty() {
                continue;
            }
            self.link(device, hemispheres, frontier.clone())?;
            let (first, count) = (frontier.start as u32, frontier.len() as u32);
            let arguments = Bounce { first, count, order: order as u32, ..self.arguments(hemispheres) };
            device.threads("list_seen", frontier.len() * NODE_RAYS.len(), &arguments)?;
            frontier = frontier.end..read_count(&self.listed_count)?;
        }
        // 2. The sums.
        for (before, &end) in ends.iter().enumerate().skip(1) {
            let arguments = Bounce { count: end as u32, order: before as u32, ..self.arguments(hemispheres) };
            device.threads("sum_nodes", end, &arguments)?;
        }
        Ok(())
    }

    /// Casts the rays of some of the listed nodes and finds the nodes that they see, unless it was done.
    fn link(
        &mut self,
        device: &Device<R>,
        hemispheres: &DeviceHemisphereRays<R>,
        listed: Range<usize>,
    ) -> Result<(), RenderError> {
        self.unlinked_count.clear()?;
        let (first, count) = (listed.start as u32, listed.len() as u32);
        device.threads("list_unlinked", listed.len(), &Bounce { first, count, ..self.arguments(hemispheres) })?;
        let new = read_count(&self.unlinked_count)?;
        let linked = self.linked * NODE_RAYS.len();
        device.cuda.extend(&mut self.links, "links of nodes", linked, linked + new * NODE_RAYS.len())?;
        let at_once = device.at_once(NODE_RAYS);
        for first in (0..new).step_by(at_once) {
            device.wave.context.check()?;
            let count = at_once.min(new - first);
            let from =
                TakeRecords { records: self.records.input(), numbers: self.unlinked.input(), ..TakeRecords::zeroed() };
            let records = taken(device, TakeRecords { first: first as u32, ..from }, count)?;
            let own = DeviceHemisphereRays::cast(device, Records { records, reach: f32::INFINITY }, NODE_RAYS, None)?;
            own.see(device)?;
            self.resolve(device, &own, false)?;
            let arguments =
                Bounce { first: first as u32, linked: (self.linked + first) as u32, ..self.arguments(&own) };
            device.threads("link_nodes", count, &arguments)?;
        }
        self.linked += new;
        Ok(())
    }

    /// Bytes in the device's memory.
    pub(super) fn memory(&self) -> u64 {
        let lists = self.listed.bytes() + self.unlinked.bytes();
        self.names.memory() + self.nodes.bytes() + self.records.bytes() + self.links.bytes() + lists
    }
}
