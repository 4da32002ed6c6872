//! The light mesh method of the thesis: the mean over the light points of a half-ball. Each line of `visibility` below is one step of it;
//! `stages/` has one folder for each.
//!
//! Step 1, primary rays, is common to all techniques; so is formula (1), which takes the result.

use lightmesh_scene::Weight;

use super::{ShadowTechnique, VisibilityQuery, VisibilitySink};
use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, SeenOf, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::gpu::memory::bytes_of_light_mesh;
use crate::light_mesh::{Lattice, LightMesh, Template, auto_step, window_bricks};
use crate::plan::BytesPerRay;
use crate::prepared::PreparedScene;
use crate::settings::{Lookup, Setting, Settings, Step};
use crate::stage::Stage;
use crate::stats::{LatticeStats, SettingsStats};

/// The light mesh that visibility is interpolated on.
#[derive(Clone, Debug)]
pub(crate) struct HalfBall {
    mesh: LightMesh,
    /// Whether the step was chosen for this image.
    step_auto: bool,
}

impl ShadowTechnique for HalfBall {
    const HAS_LIGHT_POINTS: bool = true;

    fn default_samples(_: &Settings) -> u32 {
        4
    }

    fn resolve(query: &VisibilityQuery) -> Result<HalfBall, RenderError> {
        let VisibilityQuery { scene, settings, view, observer, bounds } = *query;
        let defaults = scene.scene.light_mesh;
        let radius = settings.radius.or(defaults.radius).unwrap_or(Settings::DEFAULT_RADIUS);
        let template = Template::new(radius)?;
        let wanted = settings.step.or(defaults.step.map(Step::Fixed)).unwrap_or(Step::Auto);
        let step = match wanted {
            Step::Fixed(step) => step,
            Step::Auto => {
                let step = auto_step(scene, view, radius);
                observer.report_default(Setting::Step, &format!("light-mesh step h = {step} chosen for this image"));
                step
            }
        };
        let lattice = Lattice::covering(scene, &bounds, step, radius)?;
        let weight = settings.weight.or(defaults.weight).unwrap_or(Weight::Smooth);
        let mesh = LightMesh { lattice, template, radius: radius * step, weight };
        Ok(HalfBall { mesh, step_auto: wanted == Step::Auto })
    }

    fn stages(&self) -> &'static [Stage] {
        &[Stage::Cells, Stage::ShortTests, Stage::Collect, Stage::LongTests, Stage::Interpolate]
    }

    fn visibility<B: Backend>(
        &self,
        runner: &StageRunner<B>,
        wave: &WaveOf<B>,
        _: LightGroups,
        sink: &mut VisibilitySink<B>,
    ) -> Result<(), RenderError> {
        let (mesh, n) = (&self.mesh, runner.backend.ray_count(wave.rays));

        // Which surface points share a cell?
        let cells = runner.stage(Stage::Cells, [n; 2], |backend| backend.cells(wave, mesh))?;
        let pieces = runner.backend.cell_pieces(&cells);

        // Which light points does each surface point see?                                                     (2)
        let masks = runner.stage(Stage::ShortTests, [n, pieces], |backend| backend.short_tests(wave, &cells, mesh))?;

        // Each of them once.                                                                                  (7)
        let collect = |backend: &B| backend.light_points(runner.context, &cells, &masks, mesh);
        let points = runner.stage(Stage::Collect, [n, pieces], collect)?;

        // Which lights does each of them see?
        let rays = runner.backend.long_test_count(wave, &points);
        let test = |backend: &B| runner.with_cache(|cache| backend.long_tests(wave, &points, mesh, cache));
        let lit = runner.stage(Stage::LongTests, [n, rays], test)?;

        // The weighted mean of what a surface point's light points see.                                       (3)
        let seen = SeenOf::<B> { mesh, cells: &cells, masks: &masks, points: &points, lit: &lit };
        sink(runner.stage(Stage::Interpolate, [n, pieces], |backend| backend.interpolate(wave, &seen))?)
    }

    /// What light points see is kept for all lights.
    fn lights_at_once(&self) -> usize {
        usize::MAX
    }

    fn bytes_per_ray(&self, lights: u64) -> BytesPerRay {
        let words = self.mesh.template.words();
        // Sorting by cell, members and starts; the mask; and the light points, at most a half-ball per pixel but in
        // practice fewer than two, each with its share of a brick and its visibility.
        let points = 2 * (16 + 16 + 2 * lights + lights.div_ceil(8) * 8);
        // Shares by cell and by ray, and light points used.
        let host = 2 * 16 + 4 + 16 + 4 * words as u64 + points + 2 * 4 * lights + 4;
        let bricks = window_bricks(self.mesh.template.reach()) as usize;
        BytesPerRay { host, device: bytes_of_light_mesh(words, bricks, lights) }
    }

    fn template(&self) -> u64 {
        self.mesh.template.len() as u64
    }

    fn describe(&self, scene: &PreparedScene, settings: &Settings, stats: &mut SettingsStats) {
        stats.step = Some(self.mesh.lattice.step);
        stats.step_auto = self.step_auto;
        stats.radius = Some(self.mesh.template.radius());
        stats.weight = Some(self.mesh.weight.name());
        stats.lookup = Some(Lookup::HalfBall.name());
        stats.short_tests = Some(settings.short_tests.name());
        stats.lattice = Some(LatticeStats::new(scene, &self.mesh.lattice));
    }
}
