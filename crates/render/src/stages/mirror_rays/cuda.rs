//! Rays that go on, on a CUDA device: counted, summed, written in the order of the rays.

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::geometry::{Cone, Rays};
use lightmesh_layout::stages::MirrorRays;
use lightmesh_layout::{In, Out};

use crate::error::RenderError;
use crate::gpu::rays::{DeviceRays, DeviceWave};
use crate::gpu::{BLOCK, Cuda, blocks_for};

const THIN: Kernel = Kernel { module: "mirror_rays", name: "mirror_rays_thin" };
const COUNT: Kernel = Kernel { module: "mirror_rays", name: "mirror_rays_count" };
const EMIT: Kernel = Kernel { module: "mirror_rays", name: "mirror_rays_emit" };

pub(crate) fn mirror_rays<R: Runtime>(cuda: &Cuda<R>, wave: &DeviceWave<R>) -> Result<DeviceRays<R>, RenderError> {
    wave.context.check()?;
    let rays = wave.rays;
    let blocks = rays.record.count.div_ceil(BLOCK);
    let counts = cuda.pool().room("counts of mirror rays", blocks as usize + 1)?;
    let per_ray = cuda.pool().room("mirror rays of each ray", rays.record.count as usize)?;
    let launch = blocks_for(&(0..u64::from(blocks)), BLOCK);
    let thin = match wave.scene.host.is_transmissive() {
        true => Some(cuda.pool().room("shares of thin rays", rays.record.count as usize)?),
        false => None,
    };
    let arguments = MirrorRays {
        scene: wave.scene.record,
        rays: rays.record,
        hits: wave.hits.hits.input(),
        counts: counts.output(),
        per_ray: per_ray.output(),
        seed: wave.context.sampling.seed,
        pixel_samples: u64::from(wave.context.pixel_samples.next_power_of_two()),
        thin: thin.as_ref().map_or(Out::NULL, Buffer::output),
        ..MirrorRays::zeroed()
    };
    // 1. The shares of thin rays.
    if thin.is_some() {
        cuda.launch(THIN, launch, &arguments)?;
    }
    // 2. How many rays go on from each block?
    cuda.launch(COUNT, launch, &arguments)?;
    // Where do those of each block begin?
    let total = cuda.scan_total(&counts)?;
    // 3. These rays.
    let list = cuda.pool().room("mirror rays", total)?;
    let cones = match rays.has_cones() {
        true => Some(cuda.pool().room("cones of mirror rays", total)?),
        false => None,
    };
    let onward = list.output();
    let outputs = cones.as_ref().map_or(Out::NULL, Buffer::output);
    if total > 0 {
        cuda.launch(EMIT, launch, &MirrorRays { onward, cones: outputs, ..arguments })?;
    }
    let inputs = cones.as_ref().map_or(In::NULL, Buffer::input);
    // Cones are those of the list alone.
    let own = Rays { cones: inputs, cone: Cone::zeroed(), first_pixel: 0, count: total as u32, ..rays.record };
    let record = Rays { list: list.input(), depth: rays.record.depth + 1, ..own };
    // A surface may both let rays through and mirror them.
    let several = rays.several || wave.scene.host.is_transmissive();
    Ok(DeviceRays { several, cones, ..DeviceRays::new(record, Some(list), rays.spacing) })
}
