//! Area shadows: what each surface point on its own sees of many samples of each light. The reference.

use super::{ShadowTechnique, VisibilityQuery, VisibilitySink, each_group};
use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::plan::BytesPerRay;
use crate::prepared::PreparedScene;
use crate::settings::{Settings, ShadowTests};
use crate::stage::Stage;
use crate::stats::SettingsStats;

/// Many shadow rays per light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Area {
    tests: ShadowTests,
}

impl ShadowTechnique for Area {
    fn default_samples(_: &Settings) -> u32 {
        225
    }

    fn resolve(query: &VisibilityQuery) -> Result<Area, RenderError> {
        Ok(Area { tests: query.settings.shadow_tests })
    }

    fn stages(&self) -> &'static [Stage] {
        match self.tests {
            ShadowTests::Rows => &[Stage::AreaShadows],
            ShadowTests::Rays => &[Stage::ShadowRays],
        }
    }

    fn visibility<B: Backend>(
        &self,
        runner: &StageRunner<B>,
        wave: &WaveOf<B>,
        groups: LightGroups,
        sink: &mut VisibilitySink<B>,
    ) -> Result<(), RenderError> {
        let rays = runner.backend.ray_count(wave.rays);
        let target = wave.shadow_target();
        each_group::<B>(wave, groups, sink, |wave| match wave.context.shadow_tests {
            ShadowTests::Rows => {
                runner.stage(Stage::AreaShadows, [rays; 2], |backend| backend.area_shadows(wave, &target))
            }
            ShadowTests::Rays => {
                runner.stage(Stage::ShadowRays, [rays; 2], |backend| backend.shadow_rays(wave, &target))
            }
        })
    }

    fn bytes_per_ray(&self, lights: u64) -> BytesPerRay {
        BytesPerRay { host: 4 * lights, device: 4 * lights }
    }

    fn spreads_points(&self) -> bool {
        true
    }

    fn describe(&self, _: &PreparedScene, _: &Settings, _: &mut SettingsStats) {}
}
