//! Exact area shadows by occluder lists, the default: the triangles that can hide a light are found once for surface points that lie close
//! together. The same bits as [area mode](super::area).
//!
//! This is the place to start reading: `visibility` below is the whole technique. `stages/items/` groups the surface points, and
//! `stages/occluder_lists/` finds the triangles between a group and a light and clears the samples that they hide. `docs/method/` explains why.

use lightmesh_layout::constants::{MOST_STARTS, TILE};

use super::{Request, Taker, Visible, each_group};
use crate::backend::run::Run;
use crate::backend::{Backend, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::plan::Footprint;
use crate::prepared::PreparedScene;
use crate::settings::{Lookup, Settings};
use crate::stage::Stage;
use crate::stats::SettingsStats;

/// Occluder lists.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lists;

impl Visible for Lists {
    fn default_samples(settings: &Settings) -> u32 {
        settings.quality.samples()
    }

    fn default_pixel_samples(settings: &Settings) -> u32 {
        settings.quality.pixel_samples()
    }

    fn resolve(request: &Request) -> Result<Lists, RenderError> {
        request.tell_samples();
        Ok(Lists)
    }

    fn stages(&self) -> &'static [Stage] {
        &[Stage::Items, Stage::OccluderLists]
    }

    fn visibility<B: Backend>(
        &self,
        run: &Run<B>,
        wave: &WaveOf<B>,
        groups: LightGroups,
        taker: &mut Taker<B>,
    ) -> Result<(), RenderError> {
        let n = run.backend.ray_count(wave.rays);

        // Which surface points lie close together?
        let items = run.stage(Stage::Items, [n; 2], |backend| backend.items(wave))?;
        let pieces = run.backend.item_pieces(&items);

        // What stands between them and each light?
        let aim = wave.aim();
        each_group::<B>(wave, groups, taker, |wave| {
            run.stage(Stage::OccluderLists, [n, pieces], |backend| backend.occluder_lists(wave, &items, &aim))
        })
    }

    fn footprint(&self, lights: u64) -> Footprint {
        // The ray of each surface point, by tile and in one list; its part of an item, and of where a tile's searches start.
        let starts = (size_of::<u32>() as u64 * u64::from(MOST_STARTS + 1) * lights).div_ceil(u64::from(TILE));
        Footprint { host: 12 + 4 * lights, device: 8 + starts + 4 * lights }
    }

    fn spreads_points(&self) -> bool {
        true
    }

    fn describe(&self, _: &PreparedScene, settings: &Settings, stats: &mut SettingsStats) {
        stats.quality = settings.samples.is_none().then(|| settings.quality.name());
        stats.lookup = Some(Lookup::Lists.name());
    }
}
