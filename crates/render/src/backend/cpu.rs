//! The CPU: every stage with rayon over tiles, SIMD chosen at run time.

use std::ops::Range;

use super::Backend;
use crate::accel::Hit;
use crate::job::Job;
use crate::light_mesh::{LightMesh, UsedPoints};
use crate::prepared::PreparedScene;
use crate::settings::ShortTests;
use crate::stages::interpolate::cpu::Interpolation;
use crate::stages::long_tests::Lit;
use crate::stages::primary_rays::RayList;
use crate::stages::shadow_rays::Visibility;
use crate::stages::short_tests::Masks;
use crate::stages::{light_points, long_tests, mirror_rays, primary_rays, shade, shadow_rays, short_tests};
use crate::view::View;
use crate::{Picture, RenderError};

/// The host's processor. Results do not depend on the number of threads.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cpu {
    /// How short tests are evaluated.
    pub short_tests: ShortTests,
}

impl Backend for Cpu {
    type Rays = RayList;
    type Hits = Vec<Hit>;
    type Masks = Masks;
    type Points = UsedPoints;
    type Lit = Lit;
    type Visibility = Visibility;

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
        Ok(short_tests::cpu::short_tests(job, scene, rays, hits, mesh, self.short_tests))
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
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        shade::cpu::shade(job, scene, rays, hits, visibility, picture);
        Ok(())
    }

    fn mirror_rays(&self, scene: &PreparedScene, rays: &RayList, hits: &Vec<Hit>) -> Result<RayList, RenderError> {
        Ok(mirror_rays::cpu::mirror_rays(scene, rays, hits))
    }
}
