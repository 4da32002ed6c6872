//! Transmittance on a CUDA device.

use lightmesh_kernels::Runtime;
use lightmesh_layout::stages::{Shadows, Transmittance};

use super::levels;
use crate::data::wave::Wave;
use crate::error::RenderError;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, DeviceScene, Modules, PerStructure, Work, blocks_for, sampling};
use crate::shadow::ShadowTarget;
use crate::shadow::launch::SampleSets;

/// One for all scenes: see the kernel.
const KERNEL: PerStructure = PerStructure {
    modules: Modules { plain: "transmittance", alpha_test: "transmittance", instanced: "transmittance" },
    names: lightmesh_layout::names_per_structure!("transmittance"),
};

/// `visibility` times the transmittance of what is `transmissive`: light by light and set by set, so that no thread casts more rays than a launch may take.
pub(crate) fn transmittance<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    transmissive: &DeviceScene<R>,
    target: &ShadowTarget,
    visibility: DeviceVisibility<R>,
) -> Result<DeviceVisibility<R>, RenderError> {
    let lights = visibility.lights.len() as u64;
    let passed = cuda.pool().room("transmitted light", wave.rays.len() * lights as usize)?;
    let visibility = DeviceVisibility { passed: Some(passed), ..visibility };
    let kernel = KERNEL.of(transmissive);
    let of_transmissive = Wave { scene: transmissive, ..*wave };
    let with_rows = |target: ShadowTarget| (target, SampleSets::new(wave.rows(&target)));
    let levels: Vec<(ShadowTarget, SampleSets)> = levels(target).into_iter().map(with_rows).collect();
    // A light without samples has its centre.
    let slices_of = |sets: &SampleSets| u64::from(sets.count.max(1)) * lights;
    let slices: u64 = levels.iter().map(|(_, sets)| slices_of(sets)).sum();
    let progress = |slices_done: u64| wave.rays.len() as u64 * slices_done / slices.max(1);
    let mut done = 0;
    for (level, (target, sets)) in (0..).zip(&levels) {
        for slice in 0..slices_of(sets) {
            let (set, light) = ((slice / lights) as u32, visibility.lights.start as u32 + (slice % lights) as u32);
            let mut shadows = sets.record(cuda, &of_transmissive, &visibility, set)?;
            if let ShadowTarget::Area(all) = target {
                shadows.sampling = sampling(*all);
            }
            let record = Transmittance {
                scene: wave.scene.record,
                shadows: Shadows { first_light: light, end_light: light + 1, ..shadows },
                triangles: transmissive.triangles(),
                normals: transmissive.normals(),
                passed: visibility.passed_planes(),
                middle: u32::from(matches!(target, ShadowTarget::Center)),
                level,
                parts: wave.parts,
                spare: 0,
            };
            let rays = sets.most(set).max(1);
            let pieces = progress(done + 1) - progress(done);
            done += 1;
            let work = Work::of_rays(wave.rays.blocks(BLOCK_SIDE), &(0..rays), pieces);
            cuda.in_pieces(wave.context, kernel, work, |piece| {
                let shadows = Shadows { first: piece.start, count: piece.end - piece.start, ..record.shadows };
                cuda.launch(kernel, blocks_for(&piece, BLOCK), &Transmittance { shadows, ..record })
            })?;
        }
    }
    Ok(visibility)
}
