//! Merged rays on a CUDA device: found, counted, summed, written in their order.

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::geometry::Rays;
use lightmesh_layout::stages::MergedRays;
use lightmesh_layout::{In, Out};

use crate::error::RenderError;
use crate::gpu::rays::{DeviceHits, DeviceRays, DeviceWave};
use crate::gpu::{BLOCK, Cuda, blocks_for};

const MERGE: Kernel = Kernel { module: "merged_rays", name: "merge_mirrored" };
const COUNT: Kernel = Kernel { module: "merged_rays", name: "count_merged" };
const EMIT: Kernel = Kernel { module: "merged_rays", name: "emit_merged" };

/// The mirrored rays that are left, and what they see.
pub(crate) fn merged_rays<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
) -> Result<(DeviceRays<R>, DeviceHits<R>), RenderError> {
    wave.context.check()?;
    let (pool, rays) = (cuda.pool(), wave.rays);
    let blocks = rays.record.count.div_ceil(BLOCK);
    let launch = blocks_for(&(0..u64::from(blocks)), BLOCK);
    let merged = pool.room("merged rays", rays.len())?;
    let counts = pool.room("counts of merged rays", blocks as usize + 1)?;
    let arguments = MergedRays {
        scene: wave.scene.record,
        rays: rays.record,
        hits: wave.hits.hits.input(),
        merged: merged.output(),
        counts: counts.output(),
        spacing: rays.spacing,
        ..MergedRays::zeroed()
    };
    // 1. Which rays does each take?
    cuda.launch(MERGE, launch, &arguments)?;
    // 2. How many are left of each block, and where do they begin?
    cuda.launch(COUNT, launch, &arguments)?;
    let total = cuda.scan_total(&counts)?;
    // 3. These rays.
    let (list, hits) = (pool.room("merged rays", total)?, pool.room("hits of merged rays", total)?);
    let cones = rays.cones.as_ref().map(|_| pool.room("cones of merged rays", total)).transpose()?;
    let (left, left_hits) = (list.output(), hits.output());
    let outputs = cones.as_ref().map_or(Out::NULL, Buffer::output);
    cuda.launch(EMIT, launch, &MergedRays { left, left_hits, cones: outputs, ..arguments })?;
    let inputs = cones.as_ref().map_or(In::NULL, Buffer::input);
    let record = Rays { list: list.input(), cones: inputs, count: total as u32, ..rays.record };
    let left = DeviceRays { several: rays.several, cones, ..DeviceRays::new(record, Some(list), rays.spacing) };
    Ok((left, DeviceHits { hits }))
}
