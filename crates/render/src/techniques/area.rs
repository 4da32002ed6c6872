//! Area shadows: what each surface point on its own sees of many samples of each light. The reference.

use super::{Request, Taker, Visible, each_group};
use crate::backend::run::Run;
use crate::backend::{Backend, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::plan::Footprint;
use crate::prepared::PreparedScene;
use crate::settings::{Settings, ShadowTests};
use crate::stage::Stage;
use crate::stats::SettingsStats;

/// Many shadow rays per light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Area {
    tests: ShadowTests,
}

impl Visible for Area {
    fn default_samples(_: &Settings) -> u32 {
        225
    }

    fn resolve(request: &Request) -> Result<Area, RenderError> {
        Ok(Area { tests: request.settings.shadow_tests })
    }

    fn stages(&self) -> &'static [Stage] {
        match self.tests {
            ShadowTests::Rows => &[Stage::AreaShadows],
            ShadowTests::Rays => &[Stage::ShadowRays],
        }
    }

    fn visibility<B: Backend>(
        &self,
        run: &Run<B>,
        wave: &WaveOf<B>,
        groups: LightGroups,
        taker: &mut Taker<B>,
    ) -> Result<(), RenderError> {
        let rays = run.backend.ray_count(wave.rays);
        let aim = wave.aim();
        each_group::<B>(wave, groups, taker, |wave| match wave.job.shadow_tests {
            ShadowTests::Rows => run.stage(Stage::AreaShadows, [rays; 2], |backend| backend.area_shadows(wave, &aim)),
            ShadowTests::Rays => run.stage(Stage::ShadowRays, [rays; 2], |backend| backend.shadow_rays(wave, &aim)),
        })
    }

    fn footprint(&self, lights: u64) -> Footprint {
        Footprint { host: 4 * lights, device: 4 * lights }
    }

    fn spreads_points(&self) -> bool {
        true
    }

    fn describe(&self, _: &PreparedScene, _: &Settings, _: &mut SettingsStats) {}
}
