//! Shadow rays on a CUDA device.

use lightmesh_layout::stages::ShadowRays;

use crate::cuda::Runtime;
use crate::error::RenderError;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, PerStructure, Work, blocks_for, per_structure, sampling, slices_of_rays};
use crate::shadow::Aim;

const HARD: PerStructure = per_structure!("shadow_rays", "shadow_rays");
const AREA: PerStructure = per_structure!("shadow_rays", "area_shadows");

/// The visible share of each light, by shadow rays from each surface point.
pub(crate) fn shadow_rays<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    aim: &Aim,
) -> Result<DeviceVisibility<R>, RenderError> {
    let (kernels, samples) = match aim {
        Aim::Middle => (HARD, 1),
        Aim::Extent(sampling) => (AREA, sampling.samples),
    };
    let lights = wave.scene.host.scene.lights.len();
    let slices = slices_of_rays(lights as u64 * u64::from(samples));
    let progress = |slices_done: usize| (wave.rays.len() * slices_done / slices.len()) as u64;
    let kernel = kernels.of(wave.scene.structure);
    let share = cuda.pool().room("shares of lights", wave.rays.len() * lights)?;
    for (index, slice) in slices.iter().enumerate() {
        let work = Work::of_rays(wave.rays.blocks(BLOCK_SIDE), slice, progress(index + 1) - progress(index));
        cuda.in_pieces(wave.job, kernel, work, |piece| {
            let arguments = ShadowRays {
                scene: wave.scene.record,
                rays: wave.rays.record,
                hits: wave.hits.hits.input(),
                share: share.output(),
                sampling: sampling(wave.job.sampling),
                tally: cuda.tally()?,
                first_block: piece.start,
                first_sample: slice.start,
                sample_count: slice.end - slice.start,
            };
            cuda.launch(kernel, blocks_for(&piece, BLOCK), &arguments)
        })?;
    }
    Ok(DeviceVisibility { rays: wave.rays.len(), share, used: None })
}
