//! A CUDA device: every stage runs as kernels, none on the host.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::Runtime;
use lightmesh_layout::In;
use lightmesh_layout::geometry::Rays;
use lightmesh_memory::Budget;

use super::table::{stage_table, stages_on_cuda};
use super::{
    Backend, Cuda, DeviceBundles, DeviceCells, DeviceFilm, DeviceHits, DeviceLightPointVisibility, DeviceMasks,
    DevicePoints, DeviceRays, DeviceSamples, DeviceScene, DeviceVisibility, Probed, SeenOf, WaveOf,
};
use crate::antialiasing::Antialiasing;
use crate::bands;
use crate::cache::{Cache, DeviceTable};
use crate::data::picture::Picture;
use crate::data::visibility::Visibility;
use crate::error::RenderError;
use crate::gpu;
use crate::light_mesh::LightMesh;
use crate::plan::Plan;
use crate::prepared::{PreparedScene, TransmissionParts};
use crate::probes::Probes;
use crate::render_context::RenderContext;
use crate::settings::Acceleration;
use crate::shadow::ShadowTarget;
use crate::stage::Stage;
use crate::stages::fragments;
use crate::stages::irradiance_cache::cuda::{DeviceGathered, DeviceSurfaceLight};
use crate::stages::irradiance_cache::{self, Gathering};
use crate::stages::pixel_samples::SampleRange;
use crate::view::View;

impl<R: Runtime> Backend for Cuda<R> {
    type Scene = DeviceScene<R>;
    type Rays = DeviceRays<R>;
    type Hits = DeviceHits<R>;
    type Samples = DeviceSamples<R>;
    type Cells = DeviceCells<R>;
    type Bundles = DeviceBundles<R>;
    type Masks = DeviceMasks<R>;
    type Points = DevicePoints<R>;
    type LightPointVisibility = DeviceLightPointVisibility<R>;
    type Visibility = DeviceVisibility<R>;
    type Gathered = DeviceGathered<R>;
    type SurfaceLight = DeviceSurfaceLight<R>;
    type Film = DeviceFilm<R>;
    type Table = DeviceTable<R>;

    fn kind(&self) -> &'static str {
        "cuda"
    }

    fn name(&self) -> String {
        self.pool().runtime().name()
    }

    fn peak_memory(&self) -> u64 {
        self.pool().peak()
    }

    /// Uses the device's clock; the time is read when the band is done.
    fn timed<T>(
        &self,
        _: &RenderContext,
        stage: Stage,
        work: impl FnOnce() -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        self.on_device_clock(stage, work)
    }

    fn check_structure(&self, acceleration: &Acceleration) -> Result<(), RenderError> {
        gpu::check_structure(self.pool().runtime(), acceleration)
    }

    fn scene(
        &self,
        context: &RenderContext,
        scene: &PreparedScene,
        memory_limit: Option<u64>,
    ) -> Result<DeviceScene<R>, RenderError> {
        self.pool().set_limit(memory_limit);
        self.device_scene(context, scene)
    }

    fn transmission_parts(&self, scene: &DeviceScene<R>) -> Option<TransmissionParts<DeviceScene<R>>> {
        scene.transmission_parts()
    }

    fn check_host_memory(&self, plan: &Plan) -> Result<(), RenderError> {
        // The limit is that of the device's own memory.
        let left = Budget::default().left();
        bands::check_picture(&Plan { left, memory_limit: None, ..plan.clone() })
    }

    fn left(&self, _: &Plan) -> Option<u64> {
        self.memory_left()
    }

    fn rows_at_once(&self, _: &DeviceScene<R>, plan: &Plan) -> Result<u32, RenderError> {
        self.rows_that_fit(plan)
    }

    fn film(&self, plan: &Plan, rows: [Range<u32>; 2]) -> Result<DeviceFilm<R>, RenderError> {
        self.begin_band()?;
        DeviceFilm::new(self, plan, rows)
    }

    fn camera_rays(&self, view: &View, rows: Range<u32>, bounces: u32) -> Result<DeviceRays<R>, RenderError> {
        let [width, _] = view.size();
        let count = width * rows.len() as u32;
        let first_pixel = rows.start * width;
        let record = Rays { view: view.record(), list: In::NULL, first_pixel, count, bounces, ..Rays::zeroed() };
        Ok(DeviceRays::new(record, None, view.spacing()))
    }

    fn ray_count(&self, rays: &DeviceRays<R>) -> usize {
        rays.len()
    }

    fn probes(&self, scene: &DeviceScene<R>, probes: &Probes) -> Result<Probed<Self>, RenderError> {
        self.begin_band()?;
        self.device_probes(scene, probes)
    }

    fn cell_pieces(&self, cells: &DeviceCells<R>) -> usize {
        cells.count
    }

    fn bundle_pieces(&self, bundles: &DeviceBundles<R>) -> usize {
        bundles.count
    }

    fn long_test_count(&self, wave: &WaveOf<Self>, points: &DevicePoints<R>) -> usize {
        points.count * wave.context.sampling.rays_to(&wave.scene.host.scene.lights)
    }

    fn fragment_counts(
        &self,
        wave: &WaveOf<Self>,
        samples: &DeviceSamples<R>,
        film: &DeviceFilm<R>,
        _: &Antialiasing,
    ) -> Result<[usize; 3], RenderError> {
        fragments::cuda::fragment_counts(self, wave, samples, film)
    }

    stage_table!(stages_on_cuda);

    fn gather(
        &self,
        wave: &WaveOf<Self>,
        how: &Gathering,
        kept: &mut DeviceSurfaceLight<R>,
    ) -> Result<DeviceGathered<R>, RenderError> {
        irradiance_cache::cuda::gather(self, wave, how, kept)
    }

    fn finish(&self, context: &RenderContext) -> Result<(), RenderError> {
        self.end_band(context)
    }

    fn visibility(&self, visibility: DeviceVisibility<R>) -> Result<Visibility, RenderError> {
        visibility.to_host()
    }

    fn develop(&self, scene: &DeviceScene<R>, film: DeviceFilm<R>, picture: &mut Picture) -> Result<(), RenderError> {
        film.develop(&scene.host.scene.geometry, picture)
    }
}
