//! Hard-shadow ray tracing: one shadow ray from each surface point to the middle of each light.

use super::{ShadowTechnique, VisibilityQuery, VisibilitySink, each_group};
use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::plan::BytesPerRay;
use crate::prepared::PreparedScene;
use crate::settings::Settings;
use crate::shadow::ShadowTarget;
use crate::stage::Stage;
use crate::stats::SettingsStats;

/// One hard shadow ray per light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayTrace;

impl ShadowTechnique for RayTrace {
    fn default_samples(_: &Settings) -> u32 {
        4
    }

    fn resolve(_: &VisibilityQuery) -> Result<RayTrace, RenderError> {
        Ok(RayTrace)
    }

    fn stages(&self) -> &'static [Stage] {
        &[Stage::ShadowRays]
    }

    fn visibility<B: Backend>(
        &self,
        runner: &StageRunner<B>,
        wave: &WaveOf<B>,
        groups: LightGroups,
        sink: &mut VisibilitySink<B>,
    ) -> Result<(), RenderError> {
        let rays = runner.backend.ray_count(wave.rays);
        each_group::<B>(wave, groups, sink, |wave| {
            runner.stage(Stage::ShadowRays, [rays; 2], |backend| backend.shadow_rays(wave, &ShadowTarget::Center))
        })
    }

    fn targets_centers(&self) -> bool {
        true
    }

    fn bytes_per_ray(&self, lights: u64) -> BytesPerRay {
        BytesPerRay { host: 4 * lights, device: 4 * lights }
    }

    fn describe(&self, _: &PreparedScene, _: &Settings, _: &mut SettingsStats) {}
}
