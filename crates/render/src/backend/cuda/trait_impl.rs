//! The stages of a CUDA device, in the order of [`Backend`].

use std::ops::Range;

use lightmesh_layout::In;
use lightmesh_layout::geometry::Rays;

use super::film::DeviceFilm;
use super::{Cuda, DeviceHits, DeviceRays, DeviceVisibility, locked};
use crate::backend::Backend;
use crate::cuda::Runtime;
use crate::job::Job;
use crate::light_mesh::LightMesh;
use crate::modes::{Plan, Technique};
use crate::prepared::PreparedScene;
use crate::settings::ShortTests;
use crate::stages::light_points::cuda::DevicePoints;
use crate::stages::long_tests::cuda::DeviceLit;
use crate::stages::short_tests::cuda::DeviceMasks;
use crate::stages::{
    interpolate, light_points, long_tests, mirror_rays, primary_rays, shade, shadow_rays, short_tests,
};
use crate::view::View;
use crate::{Picture, RenderError, Stage};

impl<R: Runtime> Backend for Cuda<R> {
    type Rays = DeviceRays<R>;
    type Hits = DeviceHits<R>;
    type Masks = DeviceMasks<R>;
    type Points = DevicePoints<R>;
    type Lit = DeviceLit<R>;
    type Visibility = DeviceVisibility<R>;
    type Film = DeviceFilm<R>;

    fn kind(&self) -> &'static str {
        "cuda"
    }

    fn name(&self) -> String {
        self.pool.runtime().name()
    }

    fn peak_memory(&self) -> u64 {
        self.pool.peak()
    }

    /// By the device's clock; the time is read when the band is done.
    fn timed<T>(&self, _: &Job, stage: Stage, work: impl FnOnce() -> Result<T, RenderError>) -> Result<T, RenderError> {
        let from = self.mark()?;
        let result = work()?;
        let to = self.mark()?;
        locked(&self.spans).push((stage, from, to));
        Ok(result)
    }

    fn upload(&self, job: &Job, scene: &PreparedScene, plan: &Plan) -> Result<(), RenderError> {
        self.pool.set_limit(plan.memory_limit);
        let by_cell = matches!(plan.technique, Technique::LightMesh(_)) && job.short_tests == ShortTests::Cells;
        job.observer.begin(Stage::Upload, 1);
        let uploaded = job.wall_time(Stage::Upload, || self.upload_scene(scene, by_cell));
        job.observer.end(Stage::Upload);
        uploaded.map(|_| ())
    }

    fn rows_at_once(&self, scene: &PreparedScene, plan: &Plan) -> Result<u32, RenderError> {
        self.rows_that_fit(scene, plan)
    }

    fn film(&self, plan: &Plan, rows: Range<u32>) -> Result<DeviceFilm<R>, RenderError> {
        self.begin_band()?;
        DeviceFilm::new(self, plan, rows)
    }

    fn camera_rays(&self, view: &View, rows: Range<u32>) -> Result<DeviceRays<R>, RenderError> {
        let [width, _] = view.size();
        let count = width * rows.len() as u32;
        let record = Rays { view: view.record(), list: In::NULL, first_pixel: rows.start * width, count };
        Ok(DeviceRays { record, list: None })
    }

    fn ray_count(&self, rays: &DeviceRays<R>) -> usize {
        rays.len()
    }

    fn primary_rays(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &DeviceRays<R>,
    ) -> Result<DeviceHits<R>, RenderError> {
        primary_rays::cuda::primary_rays(self, job, scene, rays)
    }

    fn short_tests(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &DeviceRays<R>,
        hits: &DeviceHits<R>,
        mesh: &LightMesh,
    ) -> Result<DeviceMasks<R>, RenderError> {
        short_tests::cuda::short_tests(self, job, scene, rays, hits, mesh)
    }

    fn light_points(
        &self,
        job: &Job,
        masks: &DeviceMasks<R>,
        mesh: &LightMesh,
    ) -> Result<DevicePoints<R>, RenderError> {
        light_points::cuda::light_points(self, job, masks, mesh)
    }

    fn long_tests(
        &self,
        job: &Job,
        scene: &PreparedScene,
        points: &DevicePoints<R>,
        mesh: &LightMesh,
    ) -> Result<DeviceLit<R>, RenderError> {
        long_tests::cuda::long_tests(self, job, scene, points, mesh)
    }

    fn interpolate(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &DeviceRays<R>,
        hits: &DeviceHits<R>,
        masks: &DeviceMasks<R>,
        points: &DevicePoints<R>,
        lit: &DeviceLit<R>,
        mesh: &LightMesh,
    ) -> Result<DeviceVisibility<R>, RenderError> {
        interpolate::cuda::Interpolation { cuda: self, job, scene, rays, hits, masks, points, lit, mesh }.run()
    }

    fn shadow_rays(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &DeviceRays<R>,
        hits: &DeviceHits<R>,
    ) -> Result<DeviceVisibility<R>, RenderError> {
        shadow_rays::cuda::shadow_rays(self, job, scene, rays, hits)
    }

    fn area_shadows(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &DeviceRays<R>,
        hits: &DeviceHits<R>,
    ) -> Result<DeviceVisibility<R>, RenderError> {
        shadow_rays::cuda::area_shadows(self, job, scene, rays, hits)
    }

    fn shade(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &DeviceRays<R>,
        hits: &DeviceHits<R>,
        visibility: &DeviceVisibility<R>,
        film: &mut DeviceFilm<R>,
    ) -> Result<(), RenderError> {
        shade::cuda::shade(self, job, scene, rays, hits, visibility, film)
    }

    fn develop(
        &self,
        job: &Job,
        scene: &PreparedScene,
        film: DeviceFilm<R>,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        job.observer.begin(Stage::Download, 1);
        self.end_band(job)?;
        job.wall_time(Stage::Download, || film.develop(scene, picture))?;
        job.observer.end(Stage::Download);
        Ok(())
    }

    fn mirror_rays(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &DeviceRays<R>,
        hits: &DeviceHits<R>,
    ) -> Result<DeviceRays<R>, RenderError> {
        mirror_rays::cuda::mirror_rays(self, job, scene, rays, hits)
    }
}
