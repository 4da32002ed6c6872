//! Fans of rays on a device.

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::gathered::{Fans as Record, GuideFans, SeenRay, Site, TakeSites};
use lightmesh_layout::geometry::{Cone, Hit, ListedRay, Rays};
use lightmesh_layout::{In, Out};

use super::device::Device;
use crate::error::RenderError;
use crate::gathered::fan::Fan;
use crate::gathered::guide::blocks;
use crate::gpu::{PerStructure, per_structure, sampling};
use crate::render_context::Sampling;

const TRACE: PerStructure = per_structure!("gathered_rays", "trace_fans");
const SEE: PerStructure = per_structure!("gathered_rays", "see");

/// Rays from some sites, with what they hit and see.
pub(super) struct DeviceFans<R: Runtime> {
    pub(super) record: Record,
    /// Number of sites.
    pub(super) sites: usize,
    /// Number of rays.
    pub(super) rays: usize,
    /// What the record points to.
    site_list: Buffer<R, Site>,
    _list: Buffer<R, ListedRay>,
    _weights: Buffer<R, f32>,
    _areas: Buffer<R, f32>,
    _hits: Buffer<R, Hit>,
    _seen: Buffer<R, SeenRay>,
    _levels: Buffer<R, i32>,
    _brightness: Buffer<R, f32>,
}

/// Where fans begin, and how far they go.
pub(super) struct Sites<R: Runtime> {
    pub(super) sites: Buffer<R, Site>,
    /// In cells of the site.
    pub(super) reach: f32,
}

/// How many rays go into each block of directions, for some sites.
pub(super) struct Guides<R: Runtime> {
    /// Along each side of the square.
    blocks: u32,
    ends: Buffer<R, u32>,
}

/// Where second rays go: those of `rays` whose first ones, of a fan, see different things, `count` sites from the first one on.
pub(super) fn guides<R: Runtime>(
    device: &Device<R>,
    from: GuideFans,
    [first, second]: [Fan; 2],
    count: usize,
) -> Result<Guides<R>, RenderError> {
    let blocks = blocks(first);
    let ends = device.cuda.pool().room("rays of blocks of directions", count * (blocks * blocks) as usize)?;
    let record = GuideFans { ends: ends.output(), count: count as u32, rays: second.len() as u32, ..from };
    device.warps("guide_fans", count, &record)?;
    Ok(Guides { blocks, ends })
}

/// Copies of `count` sites.
pub(super) fn taken<R: Runtime>(
    device: &Device<R>,
    from: TakeSites,
    count: usize,
) -> Result<Buffer<R, Site>, RenderError> {
    let sites = device.cuda.pool().room("sites that gather", count)?;
    device.threads("take_sites", count, &TakeSites { taken: sites.output(), count: count as u32, ..from })?;
    Ok(sites)
}

impl<R: Runtime> DeviceFans<R> {
    /// Casts a fan of rays from each site: even, or as guides have it.
    pub(super) fn cast(
        device: &Device<R>,
        from: Sites<R>,
        fan: Fan,
        guides: Option<&Guides<R>>,
    ) -> Result<DeviceFans<R>, RenderError> {
        let Device { cuda, wave, .. } = device;
        let Sites { sites, reach } = from;
        let (pool, count) = (cuda.pool(), sites.len());
        let rays = count * fan.len();
        let list = pool.room::<ListedRay>("gather rays", rays)?;
        let weights = pool.room("weights of gather rays", rays)?;
        let areas = pool.room("areas of gather rays", rays)?;
        let hits = pool.room("hits of gather rays", rays)?;
        let seen = pool.room("what gather rays see", rays)?;
        let levels = pool.room("levels that gather rays ask", count)?;
        let brightness = pool.room("brightness of fans", count)?;
        let cone = fan.cone();
        // The first of several samples: a single one would be the centre of a light.
        let sampling = sampling(Sampling { samples: 2, spread: true, ..wave.context.sampling });
        let record = Record {
            scene: wave.scene.record,
            rays: Rays {
                list: list.input(),
                count: rays as u32,
                cone: Cone { width: cone.width, spread: cone.spread },
                ..Rays::zeroed()
            },
            sampling,
            tally: cuda.tally()?,
            sites: sites.input(),
            list: list.output(),
            weights: weights.output(),
            areas: areas.output(),
            hits: hits.output(),
            seen: seen.output(),
            levels: levels.output(),
            brightness: brightness.output(),
            ends: guides.map_or(In::NULL, |guides| guides.ends.input()),
            count: count as u32,
            side: fan.side(),
            reach,
            is_near: u32::from(reach.is_finite()),
            lamps: u32::from(wave.scene.host.has_lamps()),
            blocks: guides.map_or(0, |guides| guides.blocks),
        };
        device.warps("cast_fans", count, &record)?;
        device.tracing(TRACE, rays, &record)?;
        Ok(DeviceFans {
            record,
            sites: count,
            rays,
            site_list: sites,
            _list: list,
            _weights: weights,
            _areas: areas,
            _hits: hits,
            _seen: seen,
            _levels: levels,
            _brightness: brightness,
        })
    }

    /// The sites, to be changed.
    pub(super) fn sites_output(&self) -> Out<Site> {
        self.site_list.output()
    }

    /// Finds what the rays see, but for the light that reaches what they hit from no light directly.
    pub(super) fn see(&self, device: &Device<R>) -> Result<(), RenderError> {
        device.threads("level_fans", self.sites, &self.record)?;
        device.tracing(SEE, self.rays, &self.record)?;
        device.threads("brighten_fans", self.sites, &self.record)
    }
}
