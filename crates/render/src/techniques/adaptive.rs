//! Adaptive shadow rays: one per light, and all samples where those of neighbouring pixels disagree. What [occluder lists](super::lists)
//! are compared with.

use super::{ShadowTechnique, VisibilityQuery, VisibilitySink, each_group};
use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::plan::BytesPerRay;
use crate::prepared::PreparedScene;
use crate::settings::{Lookup, Settings};
use crate::stage::Stage;
use crate::stages::adaptive_shadows::cuda::LIGHTS;
use crate::stats::SettingsStats;

/// One shadow ray per light, or many.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Adaptive;

impl ShadowTechnique for Adaptive {
    fn default_samples(settings: &Settings) -> u32 {
        settings.quality.samples()
    }

    fn default_pixel_samples(settings: &Settings) -> u32 {
        settings.quality.pixel_samples()
    }

    fn resolve(query: &VisibilityQuery) -> Result<Adaptive, RenderError> {
        query.tell_samples();
        Ok(Adaptive)
    }

    fn stages(&self) -> &'static [Stage] {
        &[Stage::AdaptiveShadows]
    }

    fn visibility<B: Backend>(
        &self,
        runner: &StageRunner<B>,
        wave: &WaveOf<B>,
        groups: LightGroups,
        sink: &mut VisibilitySink<B>,
    ) -> Result<(), RenderError> {
        let n = runner.backend.ray_count(wave.rays);
        let target = wave.shadow_target();
        each_group::<B>(wave, groups, sink, |wave| {
            // Each surface point twice for each light: its first ray, and what follows from the answers. Without lights it is looked at, too.
            let pieces = 2 * n * wave.lights.of(groups.lights).len().max(1);
            runner.stage(Stage::AdaptiveShadows, [n, pieces], |backend| backend.adaptive_shadows(wave, &target))
        })
    }

    fn bytes_per_ray(&self, lights: u64) -> BytesPerRay {
        // The answers, and on the host those of whole rows; on a device half of all samples to be tested, of a slice of lights.
        BytesPerRay { host: 2 + 4 * lights, device: 4 * lights + 5 * lights.min(LIGHTS as u64) }
    }

    fn needs_neighbours(&self) -> bool {
        true
    }

    fn spreads_points(&self) -> bool {
        true
    }

    fn describe(&self, _: &PreparedScene, settings: &Settings, stats: &mut SettingsStats) {
        stats.quality = settings.samples.is_none().then(|| settings.quality.name());
        stats.lookup = Some(Lookup::Adaptive.name());
    }
}
