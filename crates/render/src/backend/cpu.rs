//! The CPU: every stage runs with rayon over tiles, with SIMD chosen at run time.

use std::ops::Range;

use glam::Vec3;
use lightmesh_trace::accel::Hit;

use super::table::{stage_table, stages_on_cpu};
use super::{Backend, Probed, SeenOf, WaveOf};
use crate::antialiasing::Antialiasing;
use crate::bands;
use crate::cache::{Cache, HostTable};
use crate::data::bundles::Bundles;
use crate::data::cells::CellGroups;
use crate::data::light_point_visibility::LightPointVisibility;
use crate::data::masks::Masks;
use crate::data::picture::Picture;
use crate::data::rays::RayList;
use crate::data::samples::PixelSamples;
use crate::data::visibility::Visibility;
use crate::device::cpu_name;
use crate::error::RenderError;
use crate::light_mesh::{LightMesh, UsedPoints};
use crate::plan::Plan;
use crate::prepared::{PreparedScene, TransmissionParts};
use crate::probes::Probes;
use crate::render_context::RenderContext;
use crate::settings::Acceleration;
use crate::shadow::ShadowTarget;
use crate::stage::Stage;
use crate::stages::fragments;
use crate::stages::irradiance_cache::cpu::SurfaceLight;
use crate::stages::irradiance_cache::{self, Gathering};
use crate::stages::pixel_samples::SampleRange;
use crate::stages::primary_rays;
use crate::view::View;

/// The CPU. Results do not depend on the number of threads.
#[derive(Clone, Copy, Debug)]
pub struct Cpu;

impl Backend for Cpu {
    type Scene = PreparedScene;
    type Rays = RayList;
    type Hits = Vec<Hit>;
    type Samples = PixelSamples;
    type Cells = CellGroups;
    type Bundles = Bundles;
    type Masks = Masks;
    type Points = UsedPoints;
    type LightPointVisibility = LightPointVisibility;
    type Visibility = Visibility;
    type Gathered = Vec<Vec3>;
    type SurfaceLight = SurfaceLight;
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
        context: &RenderContext,
        stage: Stage,
        work: impl FnOnce() -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        context.wall_time(stage, work)
    }

    fn check_structure(&self, _: &Acceleration) -> Result<(), RenderError> {
        Ok(())
    }

    fn scene(&self, _: &RenderContext, scene: &PreparedScene, _: Option<u64>) -> Result<PreparedScene, RenderError> {
        Ok(scene.clone())
    }

    fn transmission_parts(&self, scene: &PreparedScene) -> Option<TransmissionParts<PreparedScene>> {
        scene.transmission_parts()
    }

    fn check_host_memory(&self, plan: &Plan) -> Result<(), RenderError> {
        bands::rows_on_host(plan).map(drop)
    }

    fn left(&self, plan: &Plan) -> Option<u64> {
        plan.left
    }

    fn rows_at_once(&self, _: &PreparedScene, plan: &Plan) -> Result<u32, RenderError> {
        bands::rows_on_host(plan)
    }

    fn film(&self, plan: &Plan, rows: [Range<u32>; 2]) -> Result<Picture, RenderError> {
        Ok(Picture::planned(plan, rows).with_counted(plan))
    }

    fn camera_rays(&self, view: &View, rows: Range<u32>, bounces: u32) -> Result<RayList, RenderError> {
        Ok(RayList { bounces, ..primary_rays::cpu::camera_rays(view, rows) })
    }

    fn ray_count(&self, rays: &RayList) -> usize {
        rays.rays.len()
    }

    fn probes(&self, scene: &PreparedScene, probes: &Probes) -> Result<Probed<Cpu>, RenderError> {
        Ok((scene.clone(), probes.rays.clone(), probes.hits.clone()))
    }

    fn cell_pieces(&self, cells: &CellGroups) -> usize {
        cells.members().len()
    }

    fn bundle_pieces(&self, bundles: &Bundles) -> usize {
        bundles.points()
    }

    fn long_test_count(&self, wave: &WaveOf<Cpu>, points: &UsedPoints) -> usize {
        points.count() * wave.context.sampling.rays_to(wave.lights())
    }

    const COUNTS_FOR_NOTHING: bool = true;

    fn fragment_counts(
        &self,
        wave: &WaveOf<Cpu>,
        samples: &PixelSamples,
        film: &Picture,
        all: &Antialiasing,
    ) -> Result<[usize; 3], RenderError> {
        Ok(fragments::cpu::fragment_counts(wave, samples, film, all))
    }

    stage_table!(stages_on_cpu);

    fn gather(&self, wave: &WaveOf<Cpu>, how: &Gathering, kept: &mut SurfaceLight) -> Result<Vec<Vec3>, RenderError> {
        Ok(irradiance_cache::cpu::gather(wave, how, kept))
    }

    fn finish(&self, _: &RenderContext) -> Result<(), RenderError> {
        Ok(())
    }

    fn visibility(&self, visibility: Visibility) -> Result<Visibility, RenderError> {
        Ok(visibility)
    }

    fn develop(&self, _: &PreparedScene, mut film: Picture, picture: &mut Picture) -> Result<(), RenderError> {
        film.write_counted();
        picture.take(film);
        Ok(())
    }
}
