//! Fans of rays on a device.

use bytemuck::Zeroable;
use lightmesh_layout::gathered::{Fans as Record, SeenRay, Site, TakeSites};
use lightmesh_layout::geometry::{Cone, Hit, ListedRay, Rays};

use super::device::Device;
use crate::cuda::{Buffer, Runtime};
use crate::error::RenderError;
use crate::gathered::rays::Fan;
use crate::gpu::{PerStructure, per_structure, sampling};
use crate::job::Sampling;

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
    _sites: Buffer<R, Site>,
    _list: Buffer<R, ListedRay>,
    _weights: Buffer<R, f32>,
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
    /// Casts a fan of rays from each site.
    pub(super) fn cast(device: &Device<R>, from: Sites<R>, fan: Fan) -> Result<DeviceFans<R>, RenderError> {
        let Device { cuda, wave, .. } = device;
        let Sites { sites, reach } = from;
        let (pool, count) = (cuda.pool(), sites.len());
        let rays = count * fan.len();
        let list = pool.room::<ListedRay>("gather rays", rays)?;
        let weights = pool.room("weights of gather rays", rays)?;
        let hits = pool.room("hits of gather rays", rays)?;
        let seen = pool.room("what gather rays see", rays)?;
        let levels = pool.room("levels that gather rays ask", count)?;
        let brightness = pool.room("brightness of fans", count)?;
        let cone = fan.cone();
        // The first of several samples: a single one would be the centre of a light.
        let sampling = sampling(Sampling { samples: 2, spread: true, ..wave.job.sampling });
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
            hits: hits.output(),
            seen: seen.output(),
            levels: levels.output(),
            brightness: brightness.output(),
            count: count as u32,
            side: fan.side(),
            reach,
            is_near: u32::from(reach.is_finite()),
            lamps: u32::from(wave.scene.host.has_lamps()),
            ..Record::zeroed()
        };
        device.warps("cast_fans", count, &record)?;
        device.tracing(TRACE, rays, &record)?;
        Ok(DeviceFans {
            record,
            sites: count,
            rays,
            _sites: sites,
            _list: list,
            _weights: weights,
            _hits: hits,
            _seen: seen,
            _levels: levels,
            _brightness: brightness,
        })
    }

    /// Finds what the rays see, but for the light that reaches what they hit from no light directly.
    pub(super) fn see(&self, device: &Device<R>) -> Result<(), RenderError> {
        device.threads("level_fans", self.sites, &self.record)?;
        device.tracing(SEE, self.rays, &self.record)?;
        device.threads("brighten_fans", self.sites, &self.record)
    }
}
