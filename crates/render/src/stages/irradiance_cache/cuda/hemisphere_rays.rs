//! Rays of records on a device.

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::geometry::{Cone, Hit, ListedRay, Rays};
use lightmesh_layout::irradiance_cache::{GuideRays, HemisphereRays as Arguments, Record, SeenRay, TakeRecords};
use lightmesh_layout::{In, Out};

use super::device::Device;
use crate::error::RenderError;
use crate::gpu::{PerStructure, per_structure, sampling};
use crate::render_context::Sampling;
use crate::stages::irradiance_cache::guide::blocks;
use crate::stages::irradiance_cache::hemisphere_rays::HemisphereRays;

const TRACE: PerStructure = per_structure!("irradiance_cache_rays", "trace_hemispheres");
const SEE: PerStructure = per_structure!("irradiance_cache_rays", "see");

/// Rays from some records, with what they hit and see.
pub(super) struct DeviceHemisphereRays<R: Runtime> {
    pub(super) arguments: Arguments,
    /// Number of records.
    pub(super) records: usize,
    /// Number of rays.
    pub(super) rays: usize,
    /// What the arguments point to.
    record_list: Buffer<R, Record>,
    _list: Buffer<R, ListedRay>,
    _weights: Buffer<R, f32>,
    _areas: Buffer<R, f32>,
    _hits: Buffer<R, Hit>,
    _seen: Buffer<R, SeenRay>,
    _levels: Buffer<R, i32>,
    _brightness: Buffer<R, f32>,
}

/// Where rays begin, and how far they go.
pub(super) struct Records<R: Runtime> {
    pub(super) records: Buffer<R, Record>,
    /// In cells of the record.
    pub(super) reach: f32,
}

/// How many rays go into each block of directions, for some records.
pub(super) struct Guides<R: Runtime> {
    /// Along each side of the square.
    blocks: u32,
    ends: Buffer<R, u32>,
}

/// Where second rays go: those of `rays` whose first ones see different things, `count` records from the first one on.
pub(super) fn guides<R: Runtime>(
    device: &Device<R>,
    from: GuideRays,
    [first, second]: [HemisphereRays; 2],
    count: usize,
) -> Result<Guides<R>, RenderError> {
    let blocks = blocks(first);
    let ends = device.cuda.pool().room("rays of blocks of directions", count * (blocks * blocks) as usize)?;
    let arguments = GuideRays { ends: ends.output(), count: count as u32, rays: second.len() as u32, ..from };
    device.warps("guide_hemispheres", count, &arguments)?;
    Ok(Guides { blocks, ends })
}

/// Copies of `count` records.
pub(super) fn taken<R: Runtime>(
    device: &Device<R>,
    from: TakeRecords,
    count: usize,
) -> Result<Buffer<R, Record>, RenderError> {
    let records = device.cuda.pool().room("records that gather", count)?;
    device.threads("take_records", count, &TakeRecords { taken: records.output(), count: count as u32, ..from })?;
    Ok(records)
}

impl<R: Runtime> DeviceHemisphereRays<R> {
    /// Casts a hemisphere of rays from each record: even, or as guides have it.
    pub(super) fn cast(
        device: &Device<R>,
        from: Records<R>,
        hemisphere: HemisphereRays,
        guides: Option<&Guides<R>>,
    ) -> Result<DeviceHemisphereRays<R>, RenderError> {
        let Device { cuda, wave, .. } = device;
        let Records { records, reach } = from;
        let (pool, count) = (cuda.pool(), records.len());
        let rays = count * hemisphere.len();
        let list = pool.room::<ListedRay>("gather rays", rays)?;
        let weights = pool.room("weights of gather rays", rays)?;
        let areas = pool.room("areas of gather rays", rays)?;
        let hits = pool.room("hits of gather rays", rays)?;
        let seen = pool.room("what gather rays see", rays)?;
        let levels = pool.room("levels that gather rays ask", count)?;
        let brightness = pool.room("brightness of hemispheres", count)?;
        let cone = hemisphere.cone();
        // The first of several samples: a single one would be the centre of a light.
        let sampling = sampling(Sampling { samples: 2, spread: true, ..wave.context.sampling });
        let arguments = Arguments {
            scene: wave.scene.record,
            rays: Rays {
                list: list.input(),
                count: rays as u32,
                cone: Cone { width: cone.width, spread: cone.spread },
                ..Rays::zeroed()
            },
            sampling,
            tally: cuda.tally()?,
            records: records.input(),
            list: list.output(),
            weights: weights.output(),
            areas: areas.output(),
            hits: hits.output(),
            seen: seen.output(),
            levels: levels.output(),
            brightness: brightness.output(),
            ends: guides.map_or(In::NULL, |guides| guides.ends.input()),
            count: count as u32,
            side: hemisphere.side(),
            reach,
            is_near: u32::from(reach.is_finite()),
            lamps: u32::from(wave.scene.host.has_lamps()),
            blocks: guides.map_or(0, |guides| guides.blocks),
        };
        device.warps("cast_hemispheres", count, &arguments)?;
        device.tracing(TRACE, rays, &arguments)?;
        Ok(DeviceHemisphereRays {
            arguments,
            records: count,
            rays,
            record_list: records,
            _list: list,
            _weights: weights,
            _areas: areas,
            _hits: hits,
            _seen: seen,
            _levels: levels,
            _brightness: brightness,
        })
    }

    /// The records, to be changed.
    pub(super) fn records_output(&self) -> Out<Record> {
        self.record_list.output()
    }

    /// Finds what the rays see, but for the light that reaches what they hit from no light directly.
    pub(super) fn see(&self, device: &Device<R>) -> Result<(), RenderError> {
        device.threads("level_hemispheres", self.records, &self.arguments)?;
        device.tracing(SEE, self.rays, &self.arguments)?;
        device.threads("brighten_hemispheres", self.records, &self.arguments)
    }
}
