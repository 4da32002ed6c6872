//! Hard-shadow ray tracing: one shadow ray from each surface point to the middle of each light.

use super::{Request, Taker, Visible, each_group};
use crate::backend::run::Run;
use crate::backend::{Backend, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::plan::Footprint;
use crate::prepared::PreparedScene;
use crate::settings::Settings;
use crate::shadow::Aim;
use crate::stage::Stage;
use crate::stats::SettingsStats;

/// One hard shadow ray per light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayTrace;

impl Visible for RayTrace {
    fn default_samples(_: &Settings) -> u32 {
        4
    }

    fn resolve(_: &Request) -> Result<RayTrace, RenderError> {
        Ok(RayTrace)
    }

    fn stages(&self) -> &'static [Stage] {
        &[Stage::ShadowRays]
    }

    fn visibility<B: Backend>(
        &self,
        run: &Run<B>,
        wave: &WaveOf<B>,
        groups: LightGroups,
        taker: &mut Taker<B>,
    ) -> Result<(), RenderError> {
        let rays = run.backend.ray_count(wave.rays);
        each_group::<B>(wave, groups, taker, |wave| {
            run.stage(Stage::ShadowRays, [rays; 2], |backend| backend.shadow_rays(wave, &Aim::Middle))
        })
    }

    fn aims_at_centers(&self) -> bool {
        true
    }

    fn footprint(&self, lights: u64) -> Footprint {
        Footprint { host: 4 * lights, device: 4 * lights }
    }

    fn describe(&self, _: &PreparedScene, _: &Settings, _: &mut SettingsStats) {}
}
