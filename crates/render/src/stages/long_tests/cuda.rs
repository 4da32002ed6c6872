//! Step 4 on a CUDA device: one thread per light point, light by light.

use lightmesh_kernels::Runtime;
use lightmesh_layout::mesh::VisibilityOfLight;
use lightmesh_layout::stages::LongTests;
use lightmesh_scene::Light;

use crate::cache::{Cache, ColumnKey, DeviceTable};
use crate::counters::Tally;
use crate::error::RenderError;
use crate::gpu::light_point_visibility::DeviceLightPointVisibility;
use crate::gpu::points::DevicePoints;
use crate::gpu::rays::DeviceWave;
use crate::gpu::{BLOCK, Cuda, PerStructure, Work, blocks_for, per_structure, sampling, slices_of_rays};
use crate::light_mesh::LightMesh;
use crate::stages::light_points::cuda::only;

const KERNELS: PerStructure = per_structure!("long_tests", "long_tests");

pub(crate) fn long_tests<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    points: &DevicePoints<R>,
    mesh: &LightMesh,
    cache: Option<&mut Cache<DeviceTable<R>>>,
) -> Result<DeviceLightPointVisibility<R>, RenderError> {
    let tests = LongTestsOf { cuda, wave, points, mesh };
    match cache {
        Some(cache) => tests.unknown(cache.table(&wave.scene.host, &mesh.lattice)?),
        None => tests.all(),
    }
}

/// The long tests from some light points.
struct LongTestsOf<'a, R: Runtime> {
    cuda: &'a Cuda<R>,
    wave: &'a DeviceWave<'a, R>,
    points: &'a DevicePoints<R>,
    mesh: &'a LightMesh,
}

impl<R: Runtime> LongTestsOf<'_, R> {
    /// All of them.
    fn all(&self) -> Result<DeviceLightPointVisibility<R>, RenderError> {
        let lights = &self.wave.scene.host.scene.lights;
        let lit = DeviceLightPointVisibility::new(self.cuda, lights, self.points)?;
        for (index, light) in lights.iter().enumerate() {
            self.towards(index, light, lit.records[index])?;
        }
        Ok(lit)
    }

    /// Those whose result is not in a table. The results are added to it.
    fn unknown(&self, table: &mut DeviceTable<R>) -> Result<DeviceLightPointVisibility<R>, RenderError> {
        let LongTestsOf { cuda, wave, points, .. } = *self;
        let lights = &wave.scene.host.scene.lights;
        let seen = lights.iter().map(|light| ColumnKey::of(light, &wave.context.sampling)).collect();
        let Some(rows) = table.admit(cuda, points, seen)? else { return self.all() };
        let lit = DeviceLightPointVisibility::new(cuda, lights, points)?;
        for (index, light) in lights.iter().enumerate() {
            let unknown = only(cuda, points, table.unknown(cuda, index, &rows, points)?)?;
            if unknown.count > 0 {
                let found = DeviceLightPointVisibility::new(cuda, std::slice::from_ref(light), &unknown)?;
                LongTestsOf { points: &unknown, ..*self }.towards(index, light, found.records[0])?;
                table.learn(cuda, index, &rows, (&unknown, found.records[0]))?;
            }
            table.lookup(cuda, index, &rows, (points, lit.records[index]))?;
            let saved = (points.count - unknown.count) as u64 * u64::from(table.samples(index));
            Tally::add(&wave.context.tally.long_tests_saved, saved);
        }
        Ok(lit)
    }

    /// The tests towards one light.
    fn towards(&self, index: usize, light: &Light, lit: VisibilityOfLight) -> Result<(), RenderError> {
        let LongTestsOf { cuda, wave, points, mesh } = *self;
        let kernel = KERNELS.of(wave.scene);
        let samples = if light.has_size() { wave.context.sampling.samples } else { 1 };
        let blocks = points.count.div_ceil(BLOCK as usize) as u64;
        for slice in slices_of_rays(u64::from(samples)) {
            let progress = points.count as u64 * (slice.end - slice.start);
            cuda.in_pieces(wave.context, kernel, Work::of_rays(blocks, &slice, progress), |piece| {
                let first_point = piece.start * u64::from(BLOCK);
                let rest = points.count as u64 - first_point;
                let arguments = LongTests {
                    scene: wave.scene.record,
                    mesh: cuda.mesh(mesh)?,
                    points: points.record(),
                    lit,
                    sampling: sampling(wave.context.sampling.of_light_points()),
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
        Tally::add(&wave.context.tally.long_tests, points.count as u64 * u64::from(samples));
        Ok(())
    }
}
