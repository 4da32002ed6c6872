//! The CPU: every stage with rayon over tiles, SIMD chosen at run time.

use std::ops::Range;

use super::{Backend, SeenOf, WaveOf};
use crate::accel::Hit;
use crate::bands;
use crate::cache::{HostTable, Kept};
use crate::data::cells::CellGroups;
use crate::data::lit::Lit;
use crate::data::masks::Masks;
use crate::data::picture::Picture;
use crate::data::rays::RayList;
use crate::data::visibility::Visibility;
use crate::device::cpu_name;
use crate::error::RenderError;
use crate::job::Job;
use crate::light_mesh::{LightMesh, UsedPoints};
use crate::plan::Plan;
use crate::prepared::PreparedScene;
use crate::shadow::Aim;
use crate::stage::Stage;
use crate::stages::{
    cells, interpolate, light_points, long_tests, mirror_rays, primary_rays, shade, shadow_rays, short_tests,
};
use crate::view::View;

/// The host's processor. Results do not depend on the number of threads.
#[derive(Clone, Copy, Debug)]
pub struct Cpu;

impl Backend for Cpu {
    type Scene = PreparedScene;
    type Rays = RayList;
    type Hits = Vec<Hit>;
    type Cells = CellGroups;
    type Masks = Masks;
    type Points = UsedPoints;
    type Lit = Lit;
    type Visibility = Visibility;
    type Film = Picture;
    type Table = HostTable;

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

    fn scene(&self, _: &Job, scene: &PreparedScene, _: Option<u64>) -> Result<PreparedScene, RenderError> {
        Ok(scene.clone())
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

    fn cells(&self, wave: &WaveOf<Cpu>, mesh: &LightMesh) -> Result<CellGroups, RenderError> {
        Ok(cells::cpu::cells(wave, &mesh.lattice))
    }

    fn cell_pieces(&self, cells: &CellGroups) -> usize {
        cells.members().len()
    }

    fn short_tests(&self, wave: &WaveOf<Cpu>, cells: &CellGroups, mesh: &LightMesh) -> Result<Masks, RenderError> {
        Ok(short_tests::cpu::short_tests(wave, cells, mesh))
    }

    fn light_points(
        &self,
        job: &Job,
        cells: &CellGroups,
        masks: &Masks,
        mesh: &LightMesh,
    ) -> Result<UsedPoints, RenderError> {
        Ok(light_points::cpu::light_points(job, cells, masks, mesh))
    }

    fn long_test_count(&self, wave: &WaveOf<Cpu>, points: &UsedPoints) -> usize {
        points.count() * wave.job.sampling.rays_to(wave.lights())
    }

    fn long_tests(
        &self,
        wave: &WaveOf<Cpu>,
        points: &UsedPoints,
        mesh: &LightMesh,
        kept: Option<&mut Kept<HostTable>>,
    ) -> Result<Lit, RenderError> {
        Ok(long_tests::cpu::long_tests(wave, points, mesh, kept))
    }

    fn interpolate(&self, wave: &WaveOf<Cpu>, seen: &SeenOf<Cpu>) -> Result<Visibility, RenderError> {
        Ok(interpolate::cpu::interpolate(wave, seen))
    }

    fn shadow_rays(&self, wave: &WaveOf<Cpu>, aim: &Aim) -> Result<Visibility, RenderError> {
        Ok(shadow_rays::cpu::shadow_rays(wave, aim))
    }

    fn shade(&self, wave: &WaveOf<Cpu>, visibility: &Visibility, film: &mut Picture) -> Result<(), RenderError> {
        shade::cpu::shade(wave, visibility, film);
        Ok(())
    }

    fn mirror_rays(&self, wave: &WaveOf<Cpu>) -> Result<RayList, RenderError> {
        Ok(mirror_rays::cpu::mirror_rays(wave))
    }

    fn finish(&self, _: &Job) -> Result<(), RenderError> {
        Ok(())
    }

    fn develop(&self, _: &PreparedScene, film: Picture, picture: &mut Picture) -> Result<(), RenderError> {
        picture.take(film);
        Ok(())
    }
}
