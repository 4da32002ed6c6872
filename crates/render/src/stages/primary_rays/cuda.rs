//! Step 1 on a CUDA device.

use lightmesh_kernels::Runtime;
use lightmesh_layout::geometry as layout;
use lightmesh_layout::stages::PrimaryRays;

use crate::counters::Tally;
use crate::error::RenderError;
use crate::gpu::rays::{DeviceHits, DeviceRays};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, DeviceScene, PerStructure, Work, blocks_for, per_structure};
use crate::render_context::RenderContext;

const KERNELS: PerStructure = per_structure!("primary_rays", "primary_rays");
/// Number of blocks in the first launch.
const FIRST: u64 = 256;

pub(crate) fn primary_rays<R: Runtime>(
    cuda: &Cuda<R>,
    context: &RenderContext,
    scene: &DeviceScene<R>,
    rays: &DeviceRays<R>,
) -> Result<DeviceHits<R>, RenderError> {
    let hits = closest_hits(cuda, context, scene, rays, (cuda.tally()?, rays.len() as u64))?;
    Tally::add(&context.tally.rays, rays.len() as u64);
    Ok(hits)
}

/// The hits of rays, with other counters and progress.
pub(crate) fn closest_hits<R: Runtime>(
    cuda: &Cuda<R>,
    context: &RenderContext,
    scene: &DeviceScene<R>,
    rays: &DeviceRays<R>,
    (tally, progress): (layout::Tally, u64),
) -> Result<DeviceHits<R>, RenderError> {
    let kernel = KERNELS.of(scene);
    let hits = cuda.pool().room("hits", rays.len())?;
    let work = Work { units: rays.blocks(BLOCK_SIDE), cost: 1, first: FIRST, progress };
    cuda.in_pieces(context, kernel, work, |piece| {
        let arguments = PrimaryRays {
            scene: scene.record,
            rays: rays.record,
            hits: hits.output(),
            tally,
            first_block: piece.start,
        };
        let launch = blocks_for(&piece, BLOCK);
        cuda.launch(kernel, launch, &arguments)
    })?;
    Ok(DeviceHits { hits })
}
