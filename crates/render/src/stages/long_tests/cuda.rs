//! Step 4 on a CUDA device: one thread a light point, light by light.

use lightmesh_layout::Out;
use lightmesh_layout::mesh::LitBy;
use lightmesh_layout::stages::LongTests;

use crate::RenderError;
use crate::backend::cuda::{BLOCK, Cuda, Work, blocks_for, kernel_of, sampling, slices_of_rays};
use crate::cuda::{Buffer, Runtime};
use crate::job::{Job, Tally};
use crate::light_mesh::LightMesh;
use crate::prepared::PreparedScene;
use crate::stages::light_points::cuda::DevicePoints;

/// What every used light point sees of every light, on a device.
pub struct DeviceLit<R: Runtime> {
    /// One a light.
    pub(crate) lit: Buffer<R, LitBy>,
    bits: Buffer<R, u64>,
    seen: Buffer<R, u16>,
}

pub(crate) fn long_tests<R: Runtime>(
    cuda: &Cuda<R>,
    job: &Job,
    scene: &PreparedScene,
    points: &DevicePoints<R>,
    mesh: &LightMesh,
) -> Result<DeviceLit<R>, RenderError> {
    let lights = &scene.scene.lights;
    let lit = DeviceLit::new(cuda, lights, points)?;
    let device_scene = cuda.scene(scene)?;
    let names = ["long_tests_bvh", "long_tests_grid", "long_tests_brute_force"];
    let kernel = kernel_of("long_tests", names, device_scene.structure);
    for (index, light) in lights.iter().enumerate() {
        let samples = if light.has_size() { job.sampling.samples } else { 1 };
        let blocks = points.count.div_ceil(BLOCK as usize) as u64;
        for slice in slices_of_rays(u64::from(samples)) {
            cuda.in_pieces(job, kernel, Work::of_rays(blocks, &slice, 0), |piece| {
                let first_point = piece.start * u64::from(BLOCK);
                let rest = points.count as u64 - first_point;
                let arguments = LongTests {
                    scene: device_scene.record,
                    mesh: cuda.mesh(mesh)?,
                    points: points.record(),
                    lit: lit.lit.input(),
                    sampling: sampling(job),
                    tally: cuda.tally()?,
                    light: index as u32,
                    point_count: rest.min((piece.end - piece.start) * u64::from(BLOCK)) as u32,
                    first_point,
                    first_sample: slice.start as u32,
                    sample_count: (slice.end - slice.start) as u32,
                };
                cuda.launch(kernel, blocks_for(&piece, BLOCK), &arguments)
            })?;
        }
        Tally::add(&job.tally.long_tests, points.count as u64 * u64::from(samples));
    }
    Ok(lit)
}

impl<R: Runtime> DeviceLit<R> {
    fn new(
        cuda: &Cuda<R>,
        lights: &[lightmesh_scene::Light],
        points: &DevicePoints<R>,
    ) -> Result<DeviceLit<R>, RenderError> {
        let sized = lights.iter().filter(|light| light.has_size()).count();
        let (slots, count) = (points.capacity(), points.count);
        let bits = cuda.pool().zeros("light points that see lights", slots * (lights.len() - sized))?;
        let seen = cuda.pool().room("light points' shares of lights", count * sized)?;
        let (mut next_bits, mut next_seen) = (bits.output().address(), seen.output().address());
        let records: Vec<LitBy> = lights
            .iter()
            .map(|light| {
                if light.has_size() {
                    next_seen += (2 * count) as u64;
                    LitBy { bits: Out::NULL, seen: Out::to(next_seen - (2 * count) as u64) }
                } else {
                    next_bits += (8 * slots) as u64;
                    LitBy { bits: Out::to(next_bits - (8 * slots) as u64), seen: Out::NULL }
                }
            })
            .collect();
        Ok(DeviceLit { lit: cuda.pool().upload("lights' tables", &records)?, bits, seen })
    }

    /// Reads back what the light points see, in the form of the CPU's twin but in the order of the device's slots.
    pub fn read(&self) -> Result<(Vec<u64>, Vec<u16>), RenderError> {
        Ok((self.bits.read()?, self.seen.read()?))
    }
}
