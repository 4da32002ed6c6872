//! Formula (3) on a CUDA device: one warp per bundle, then long tests where no light point counts.

use lightmesh_kernels::Runtime;
use lightmesh_layout::constants::{BUNDLE_WARPS, MAX_LIGHTS};
use lightmesh_layout::stages::Interpolate;

use crate::data::wave::Seen;
use crate::error::RenderError;
use crate::gpu::cells::DeviceCells;
use crate::gpu::light_point_visibility::DeviceLightPointVisibility;
use crate::gpu::masks::DeviceMasks;
use crate::gpu::points::DevicePoints;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{
    BLOCK, Cuda, PerModule, PerStructure, Work, blocks_for, per_module, per_structure, sampling, warps_for,
};
use crate::light_mesh::window_bricks;

/// The inputs of formula (3).
pub(crate) type DeviceSeen<'a, R> =
    Seen<'a, DeviceCells<R>, DeviceMasks<R>, DevicePoints<R>, DeviceLightPointVisibility<R>>;

const INTERPOLATE: PerModule = per_module!("interpolate", "interpolate");
const FALLBACK: PerStructure = per_structure!("interpolate", "fallback");
/// Bundles, and blocks of rays, in the first launches.
const FIRST_BUNDLES: u64 = 4096;
const FIRST_BLOCKS: u64 = 256;

pub(crate) fn interpolate<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    seen: &DeviceSeen<R>,
) -> Result<DeviceVisibility<R>, RenderError> {
    let Seen { mesh, cells, masks, points, lit } = *seen;
    let lights = wave.scene.host.scene.lights.len();
    let visibility = DeviceVisibility::dark(cuda, wave.rays.len(), 0..lights)?;
    let used = cuda.pool().zeros("light points used", wave.rays.len())?;
    let fallback_rays = cuda.pool().room("rays that fall back", wave.rays.len())?;
    let fallback_count = cuda.pool().zeros("number of rays that fall back", 1)?;
    let record = Interpolate {
        scene: wave.scene.record,
        rays: wave.rays.record,
        hits: wave.hits.hits.input(),
        mesh: cuda.mesh(mesh)?,
        members: cells.members.input(),
        bundles: cells.bundles.input(),
        masks: masks.masks.input(),
        points: points.record(),
        slots: points.slots.input(),
        lit: lit.lit.input(),
        share: visibility.planes(),
        used: used.output(),
        fallback_rays: fallback_rays.output(),
        fallback_count: fallback_count.output(),
        sampling: sampling(wave.context.sampling.of_light_points()),
        tally: cuda.tally()?,
        first: 0,
        count: 0,
    };
    // 1. The weighted means.
    let cost = lights.max(1) as u64;
    let work = Work { units: cells.count as u64, cost, first: FIRST_BUNDLES, progress: cells.count as u64 };
    let interpolate = INTERPOLATE.of(wave.scene);
    cuda.bring_lines(interpolate.module, mesh)?;
    cuda.in_pieces(wave.context, interpolate, work, |piece| {
        let count = piece.end - piece.start;
        let words = window_bricks(mesh.template.reach()) + MAX_LIGHTS * mesh.template.words() as u32;
        cuda.launch(
            interpolate,
            warps_for(&piece, BUNDLE_WARPS, words),
            &Interpolate { first: piece.start, count, ..record },
        )
    })?;
    // 2. Surface points without light points take their own long tests.
    let kernel = FALLBACK.of(wave.scene);
    let blocks = (wave.rays.len() as u64).div_ceil(u64::from(BLOCK));
    cuda.in_pieces(wave.context, kernel, Work { units: blocks, cost, first: FIRST_BLOCKS, progress: 0 }, |piece| {
        let count = piece.end - piece.start;
        cuda.launch(kernel, blocks_for(&piece, BLOCK), &Interpolate { first: piece.start, count, ..record })
    })?;
    Ok(DeviceVisibility { used: Some(used), ..visibility })
}
