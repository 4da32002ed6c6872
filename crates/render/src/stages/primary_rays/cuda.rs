//! Step 1 on a CUDA device.

use lightmesh_layout::stages::PrimaryRays;

use crate::RenderError;
use crate::backend::cuda::{BLOCK, Cuda, DeviceHits, DeviceRays, Work, blocks_for, kernel_of};
use crate::cuda::Runtime;
use crate::job::{Job, Tally};
use crate::prepared::PreparedScene;

/// Blocks of the first launch ever.
const FIRST: u64 = 256;

pub(crate) fn primary_rays<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    scene: &PreparedScene,
    rays: &DeviceRays<R>,
) -> Result<DeviceHits<R>, RenderError> {
    let scene = cuda.scene(scene)?;
    let names = ["primary_rays_bvh", "primary_rays_grid", "primary_rays_brute_force"];
    let kernel = kernel_of("primary_rays", names, scene.structure);
    let hits = cuda.pool().room("hits", rays.len())?;
    let work = Work { units: rays.blocks(16), cost: 1, first: FIRST, progress: rays.len() as u64 };
    cuda.in_pieces(job, kernel, work, |piece| {
        let arguments = PrimaryRays {
            scene: scene.record,
            rays: rays.record,
            hits: hits.output(),
            tally: cuda.tally()?,
            first_block: piece.start,
        };
        let launch = blocks_for(&piece, BLOCK);
        cuda.launch(kernel, launch, &arguments)
    })?;
    Tally::add(&job.tally.rays, rays.len() as u64);
    Ok(DeviceHits { hits })
}
