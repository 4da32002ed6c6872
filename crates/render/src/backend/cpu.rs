//! The CPU: every stage with rayon over tiles, SIMD chosen at run time.

use std::ops::Range;

use super::Backend;
use crate::accel::Hit;
use crate::device::cpu_name;
use crate::job::Job;
use crate::light_mesh::{LightMesh, UsedPoints};
use crate::modes::{Plan, bands};
use crate::prepared::PreparedScene;
use crate::stages::interpolate::cpu::Interpolation;
use crate::stages::long_tests::Lit;
use crate::stages::primary_rays::RayList;
use crate::stages::shadow_rays::Visibility;
use crate::stages::short_tests::Masks;
use crate::stages::{light_points, long_tests, mirror_rays, primary_rays, shade, shadow_rays, short_tests};
use crate::view::View;
use crate::{Picture, RenderError, Stage};

/// The host's processor. Results do not depend on the number of threads.
#[derive(Clone, Copy, Debug)]
pub struct Cpu;

impl Backend for Cpu {
    type Rays = RayList;
    type Hits = Vec<Hit>;
    type Masks = Masks;
    type Points = UsedPoints;
    type Lit = Lit;
    type Visibility = Visibility;
    type Film = Picture;

    fn kind(&self) -> &'static str {
        "cpu"
    }

    fn name(&self) -> String {
        cpu_name()
    }

    fn peak_memory(&self) -> u64 {
        0
    }

    fn timed<T>(
        &self,
        job: &Job,
        stage: Stage,
        work: impl FnOnce() -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        job.wall_time(stage, work)
    }

    fn upload(&self, _: &Job, _: &PreparedScene, _: &Plan) -> Result<(), RenderError> {
        Ok(())
    }

    fn rows_at_once(&self, scene: &PreparedScene, plan: &Plan) -> Result<u32, RenderError> {
        bands::rows_on_host(scene, plan)
    }

    fn film(&self, plan: &Plan, rows: Range<u32>) -> Result<Picture, RenderError> {
        Ok(Picture::band(plan.size, rows, plan.layers))
    }

    fn camera_rays(&self, view: &View, rows: Range<u32>) -> Result<RayList, RenderError> {
        Ok(primary_rays::cpu::camera_rays(view, rows))
    }

    fn ray_count(&self, rays: &RayList) -> usize {
        rays.rays.len()
    }

    fn primary_rays(&self, job: &Job, scene: &PreparedScene, rays: &RayList) -> Result<Vec<Hit>, RenderError> {
        Ok(primary_rays::cpu::primary_rays(job, scene, rays))
    }

    fn short_tests(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &RayList,
        hits: &Vec<Hit>,
        mesh: &LightMesh,
    ) -> Result<Masks, RenderError> {
        Ok(short_tests::cpu::short_tests(job, scene, rays, hits, mesh, job.short_tests))
    }

    fn light_points(&self, job: &Job, masks: &Masks, mesh: &LightMesh) -> Result<UsedPoints, RenderError> {
        Ok(light_points::cpu::light_points(job, masks, mesh))
    }

    fn long_tests(
        &self,
        job: &Job,
        scene: &PreparedScene,
        points: &UsedPoints,
        mesh: &LightMesh,
    ) -> Result<Lit, RenderError> {
        Ok(long_tests::cpu::long_tests(job, scene, points, mesh))
    }

    fn interpolate(
        &self,
        job: &Job,
        scene: &PreparedScene,
        list: &RayList,
        hits: &Vec<Hit>,
        masks: &Masks,
        points: &UsedPoints,
        lit: &Lit,
        mesh: &LightMesh,
    ) -> Result<Visibility, RenderError> {
        Ok(Interpolation { job, scene, list, hits, masks, points, lit, mesh }.run())
    }

    fn shadow_rays(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &RayList,
        hits: &Vec<Hit>,
    ) -> Result<Visibility, RenderError> {
        Ok(shadow_rays::cpu::shadow_rays(job, scene, rays, hits))
    }

    fn area_shadows(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &RayList,
        hits: &Vec<Hit>,
    ) -> Result<Visibility, RenderError> {
        Ok(shadow_rays::cpu::area_shadows(job, scene, rays, hits))
    }

    fn shade(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &RayList,
        hits: &Vec<Hit>,
        visibility: &Visibility,
        film: &mut Picture,
    ) -> Result<(), RenderError> {
        shade::cpu::shade(job, scene, rays, hits, visibility, film);
        Ok(())
    }

    fn develop(&self, _: &Job, _: &PreparedScene, film: Picture, picture: &mut Picture) -> Result<(), RenderError> {
        picture.take(film);
        Ok(())
    }

    fn mirror_rays(
        &self,
        _: &Job,
        scene: &PreparedScene,
        rays: &RayList,
        hits: &Vec<Hit>,
    ) -> Result<RayList, RenderError> {
        Ok(mirror_rays::cpu::mirror_rays(scene, rays, hits))
    }
}
