//! Shadow rays on a CUDA device.

use lightmesh_kernels::Runtime;
use lightmesh_layout::stages::{ShadowRays, Shadows};

use crate::error::RenderError;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, PerStructure, Work, blocks_for, per_structure, slices_of_rays};
use crate::shadow::ShadowTarget;
use crate::shadow::launch::SampleSets;

const TO_CENTERS: PerStructure = per_structure!("shadow_rays", "shadow_rays");
const TO_SAMPLES: PerStructure = per_structure!("shadow_rays", "sample_rays");

/// The visible share of each light, by shadow rays from each surface point.
pub(crate) fn shadow_rays<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    target: &ShadowTarget,
) -> Result<DeviceVisibility<R>, RenderError> {
    let visibility = DeviceVisibility::dark(cuda, wave.rays.len(), wave.group())?;
    match target {
        ShadowTarget::Center => to_centers(cuda, wave, &visibility)?,
        ShadowTarget::Area(_) => to_samples(cuda, wave, target, &visibility)?,
    }
    Ok(visibility)
}

fn to_centers<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    visibility: &DeviceVisibility<R>,
) -> Result<(), RenderError> {
    let lights = &visibility.lights;
    let slices = slices_of_rays(lights.len() as u64);
    let progress = |slices_done: usize| (wave.rays.len() * slices_done / slices.len()) as u64;
    let kernel = TO_CENTERS.of(wave.scene);
    for (index, slice) in slices.iter().enumerate() {
        let work = Work::of_rays(wave.rays.blocks(BLOCK_SIDE), slice, progress(index + 1) - progress(index));
        cuda.in_pieces(wave.context, kernel, work, |piece| {
            let arguments = ShadowRays {
                scene: wave.scene.record,
                rays: wave.rays.record,
                hits: wave.hits.hits.input(),
                share: visibility.planes(),
                tally: cuda.tally()?,
                first_block: piece.start,
                first_light: lights.start as u32 + slice.start as u32,
                light_count: (slice.end - slice.start) as u32,
            };
            cuda.launch(kernel, blocks_for(&piece, BLOCK), &arguments)
        })?;
    }
    Ok(())
}

/// Light by light and set by set, so that no thread casts more rays than a launch may take.
fn to_samples<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    target: &ShadowTarget,
    visibility: &DeviceVisibility<R>,
) -> Result<(), RenderError> {
    let lights = visibility.lights.len() as u64;
    let kernel = TO_SAMPLES.of(wave.scene);
    let sets = SampleSets::new(wave.rows(target));
    let slices = u64::from(sets.count) * lights;
    let progress = |slices_done: u64| wave.rays.len() as u64 * slices_done / slices;
    for slice in 0..slices {
        let (set, light) = ((slice / lights) as u32, visibility.lights.start as u32 + (slice % lights) as u32);
        let record = Shadows { first_light: light, end_light: light + 1, ..sets.record(cuda, wave, visibility, set)? };
        let work =
            Work::of_rays(wave.rays.blocks(BLOCK_SIDE), &(0..sets.most(set)), progress(slice + 1) - progress(slice));
        cuda.in_pieces(wave.context, kernel, work, |piece| {
            let arguments = Shadows { first: piece.start, count: piece.end - piece.start, ..record };
            cuda.launch(kernel, blocks_for(&piece, BLOCK), &arguments)
        })?;
    }
    Ok(())
}
