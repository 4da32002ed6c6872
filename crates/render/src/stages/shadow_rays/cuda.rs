//! Shadow rays on a CUDA device.

use lightmesh_layout::Out;
use lightmesh_layout::geometry::Vec3;
use lightmesh_layout::stages::ShadowRays;

use crate::RenderError;
use crate::backend::cuda::{
    BLOCK, Cuda, DeviceHits, DeviceRays, DeviceVisibility, Work, blocks_for, kernel_of, sampling, slices_of_rays,
};
use crate::cuda::{Buffer, Runtime};
use crate::job::Job;
use crate::prepared::PreparedScene;

/// One ray from each object point to the middle of each light.
pub(crate) fn shadow_rays<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    scene: &PreparedScene,
    rays: &DeviceRays<R>,
    hits: &DeviceHits<R>,
) -> Result<DeviceVisibility<R>, RenderError> {
    let names = ["shadow_rays_bvh", "shadow_rays_grid", "shadow_rays_brute_force"];
    trace(cuda, job, scene, rays, hits, names, 1, None)
}

/// Many rays from each object point to each light, shaded sample by sample.
pub(crate) fn area_shadows<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    scene: &PreparedScene,
    rays: &DeviceRays<R>,
    hits: &DeviceHits<R>,
) -> Result<DeviceVisibility<R>, RenderError> {
    let names = ["area_shadows_bvh", "area_shadows_grid", "area_shadows_brute_force"];
    let direct = cuda.pool().room("direct light", rays.len())?;
    trace(cuda, job, scene, rays, hits, names, job.sampling.samples, Some(direct))
}

#[allow(clippy::too_many_arguments, reason = "what both modes share")]
fn trace<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    scene: &PreparedScene,
    rays: &DeviceRays<R>,
    hits: &DeviceHits<R>,
    names: [&'static str; 3],
    samples: u32,
    direct: Option<Buffer<R, Vec3>>,
) -> Result<DeviceVisibility<R>, RenderError> {
    let lights = scene.scene.lights.len();
    let slices = slices_of_rays(lights as u64 * u64::from(samples));
    let progress = |slices_done: usize| (rays.len() * slices_done / slices.len()) as u64;
    let scene = cuda.scene(scene)?;
    let kernel = kernel_of("shadow_rays", names, scene.structure);
    let share = cuda.pool().room("shares of lights", rays.len() * lights)?;
    for (index, slice) in slices.iter().enumerate() {
        let work = Work::of_rays(rays.blocks(16), slice, progress(index + 1) - progress(index));
        cuda.in_pieces(job, kernel, work, |piece| {
            let arguments = ShadowRays {
                scene: scene.record,
                rays: rays.record,
                hits: hits.hits.input(),
                share: share.output(),
                direct: direct.as_ref().map_or(Out::NULL, Buffer::output),
                sampling: sampling(job),
                tally: cuda.tally()?,
                first_block: piece.start,
                first_sample: slice.start,
                sample_count: slice.end - slice.start,
            };
            cuda.launch(kernel, blocks_for(&piece, BLOCK), &arguments)
        })?;
    }
    Ok(DeviceVisibility { share, used: None, direct })
}
