//! Formula (1) on a CUDA device.

use bytemuck::Zeroable;
use lightmesh_layout::In;
use lightmesh_layout::stages::Shade;

use crate::RenderError;
use crate::backend::cuda::{BLOCK, Cuda, DeviceFilm, DeviceHits, DeviceRays, DeviceVisibility, Work, blocks_for};
use crate::cuda::{Buffer, Kernel, Runtime};
use crate::job::Job;
use crate::prepared::PreparedScene;

const KERNEL: Kernel = Kernel { module: "shade", name: "shade" };
/// Blocks of the first launch ever.
const FIRST: u64 = 1024;

pub(crate) fn shade<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    scene: &PreparedScene,
    rays: &DeviceRays<R>,
    hits: &DeviceHits<R>,
    visibility: &DeviceVisibility<R>,
    film: &DeviceFilm<R>,
) -> Result<(), RenderError> {
    let cost = scene.scene.lights.len().max(1) as u64;
    let scene = cuda.scene(scene)?;
    let work = Work { units: rays.blocks(16), cost, first: FIRST, progress: rays.len() as u64 };
    cuda.in_pieces(job, KERNEL, work, |piece| {
        let mut arguments = Shade {
            scene: scene.record,
            rays: rays.record,
            hits: hits.hits.input(),
            share: visibility.share.input(),
            direct: visibility.direct.as_ref().map_or(In::NULL, Buffer::input),
            used: visibility.used.as_ref().map_or(In::NULL, Buffer::input),
            first_block: piece.start,
            ..Shade::zeroed()
        };
        film.expose(rays.is_from_camera(), &mut arguments);
        let launch = blocks_for(&piece, BLOCK);
        cuda.launch(KERNEL, launch, &arguments)
    })
}
