//! Formula (1) on a CUDA device.

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::In;
use lightmesh_layout::stages::Shade;

use crate::error::RenderError;
use crate::gpu::film::DeviceFilm;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, Work, blocks_for};
use crate::stages::irradiance_cache::cuda::DeviceGathered;

const KERNEL: Kernel = Kernel { module: "shade", name: "shade" };
const GROUPS: Kernel = Kernel { module: "shade", name: "add_light_groups" };
const ADD: Kernel = Kernel { module: "shade", name: "add_rays" };
/// Number of blocks in the first launch.
const FIRST: u64 = 1024;

pub(crate) fn shade<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    visibility: &DeviceVisibility<R>,
    gathered: Option<&DeviceGathered<R>>,
    film: &mut DeviceFilm<R>,
) -> Result<(), RenderError> {
    let rays = wave.rays;
    let lights = &visibility.lights;
    let cost = lights.len().max(1) as u64;
    // A wave of the camera has a ray per pixel, which takes the sum until it is complete.
    let all = wave.scene.host.scene.lights.len();
    let catches = wave.scene.host.catches();
    let waits = rays.several || !rays.is_from_camera() && lights.len() < all || film.has_light_groups() && catches;
    film.begin_sums(cuda, rays.len(), waits)?;
    let mut record = Shade {
        scene: wave.scene.record,
        rays: rays.record,
        hits: wave.hits.hits.input(),
        share: In::to(visibility.planes().address()),
        passed: In::to(visibility.passed_planes().address()),
        used: visibility.used.as_ref().map_or(In::NULL, Buffer::input),
        gathered: gathered.map_or(In::NULL, |gathered| gathered.light.input()),
        first_light: lights.start as u32,
        end_light: lights.end as u32,
        several: u32::from(rays.several),
        catches: u32::from(catches),
        weighed: u32::from(visibility.weighed),
        ..Shade::zeroed()
    };
    film.expose(rays, &mut record);
    if let Some(sampled) = &rays.sampled {
        record.samples = sampled.hits.input();
        record.sample_count = sampled.count;
        record.first_sampled = sampled.first;
        record.sampled_pixels = sampled.pixels;
    }
    let work = Work { units: rays.blocks(BLOCK_SIDE), cost, first: FIRST, progress: rays.len() as u64 };
    cuda.in_pieces(wave.context, KERNEL, work, |piece| {
        cuda.launch(KERNEL, blocks_for(&piece, BLOCK), &Shade { first_block: piece.start, ..record })
    })?;
    // The radiance of each light by itself; then the sums of rays that share a pixel, in their order.
    let work = Work { progress: 0, ..work };
    let launch = |kernel: Kernel| {
        cuda.in_pieces(wave.context, kernel, work, |piece| {
            cuda.launch(kernel, blocks_for(&piece, BLOCK), &Shade { first_block: piece.start, ..record })
        })
    };
    if film.has_light_groups() {
        launch(GROUPS)?;
    }
    let is_last = lights.end == all;
    if !rays.several || !is_last && !rays.are_fragments { Ok(()) } else { launch(ADD) }
}
