//! Exact area shadows by occluder lists, the default: the triangles that can hide a light are found once for surface points that lie close
//! together. The same bits as [area mode](super::area).
//!
//! This is the place to start reading: `visibility` below is the whole technique. `stages/bundles/` groups the surface points, and
//! `stages/occluder_lists/` finds the triangles between a group and a light and clears the samples that they hide. `docs/method/` explains why.

use lightmesh_layout::constants::{MAX_SEARCH_ROOTS, TILE};

use super::{ShadowTechnique, VisibilityQuery, VisibilitySink, each_group};
use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::plan::BytesPerRay;
use crate::prepared::PreparedScene;
use crate::settings::{Lookup, Settings};
use crate::stage::Stage;
use crate::stats::SettingsStats;

/// Occluder lists.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lists;

impl ShadowTechnique for Lists {
    fn default_samples(settings: &Settings) -> u32 {
        settings.quality.samples()
    }

    fn default_pixel_samples(settings: &Settings) -> u32 {
        settings.quality.pixel_samples()
    }

    fn resolve(query: &VisibilityQuery) -> Result<Lists, RenderError> {
        query.tell_samples();
        Ok(Lists)
    }

    fn stages(&self) -> &'static [Stage] {
        &[Stage::Bundles, Stage::OccluderLists]
    }

    fn visibility<B: Backend>(
        &self,
        runner: &StageRunner<B>,
        wave: &WaveOf<B>,
        groups: LightGroups,
        sink: &mut VisibilitySink<B>,
    ) -> Result<(), RenderError> {
        let n = runner.backend.ray_count(wave.rays);

        // Which surface points lie close together?
        let bundles = runner.stage(Stage::Bundles, [n; 2], |backend| backend.bundles(wave))?;
        let pieces = runner.backend.bundle_pieces(&bundles);

        // What stands between them and each light?
        let target = wave.shadow_target();
        each_group::<B>(wave, groups, sink, |wave| {
            runner.stage(Stage::OccluderLists, [n, pieces], |backend| backend.occluder_lists(wave, &bundles, &target))
        })
    }

    fn bytes_per_ray(&self, lights: u64) -> BytesPerRay {
        // The ray of each surface point, by tile and in one list; its part of a bundle, and of where a tile's searches start.
        let starts = (size_of::<u32>() as u64 * u64::from(MAX_SEARCH_ROOTS + 1) * lights).div_ceil(u64::from(TILE));
        BytesPerRay { host: 12 + 4 * lights, device: 8 + starts + 4 * lights }
    }

    fn spreads_points(&self) -> bool {
        true
    }

    fn describe(&self, _: &PreparedScene, settings: &Settings, stats: &mut SettingsStats) {
        stats.quality = settings.samples.is_none().then(|| settings.quality.name());
        stats.lookup = Some(Lookup::Lists.name());
    }
}
