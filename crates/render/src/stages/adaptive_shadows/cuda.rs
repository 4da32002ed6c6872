//! Adaptive shadow rays on a CUDA device.

use std::ops::Range;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::Out;
use lightmesh_layout::constants::AROUND;
use lightmesh_layout::counters::Counters;
use lightmesh_layout::geometry::{Rays, Tally};
use lightmesh_layout::stages::{AdaptiveShadows, Shadows};

use super::first::{all_are_points, places};
use crate::error::RenderError;
use crate::gpu::rays::{DeviceHits, DeviceRays, DeviceVisibility, DeviceWave};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, PerModule, PerStructure, Work, blocks_for, per_module, per_structure};
use crate::shadow::ShadowTarget;
use crate::shadow::launch::SampleSets;
use crate::stages::primary_rays::cuda::closest_hits;
use crate::stages::shadow_rays::cuda::shadow_rays;

const FIRST_RAYS: PerStructure = per_structure!("adaptive_shadows", "first_rays");
const FIND_OPEN: PerModule = per_module!("adaptive_shadows", "find_open");
const LIST_OPEN: Kernel = Kernel { module: "adaptive_shadows", name: "list_open" };
const OPEN_RAYS: PerStructure = per_structure!("adaptive_shadows", "open_rays");
/// Lights that are processed at once, which bounds answers and entries.
pub(crate) const LIGHTS: usize = 16;

/// The visible share of each light from each surface point.
pub(crate) fn adaptive_shadows<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    target: &ShadowTarget,
) -> Result<DeviceVisibility<R>, RenderError> {
    if all_are_points(target, &wave.scene.host.scene.lights) {
        return shadow_rays(cuda, wave, &ShadowTarget::Center);
    }
    if !wave.rays.is_from_camera() {
        return shadow_rays(cuda, wave, target);
    }
    let (rays, lights) = (wave.rays.len(), wave.group());
    let visibility = DeviceVisibility::dark(cuda, rays, lights.clone())?;
    let band = Band::new(cuda, wave, SampleSets::new(wave.rows(target)))?;
    // Entries are numbered with 32 bits.
    let at_once = LIGHTS.min(u32::MAX as usize / rays.max(1)).max(1);
    for first in lights.clone().step_by(at_once) {
        band.adapt(&visibility, first..lights.end.min(first + at_once))?;
    }
    Ok(visibility)
}

/// The rows of a wave, with those next to it that belong to the neighbourhoods of its pixels.
struct Band<'a, R: Runtime> {
    cuda: &'a Cuda<R>,
    wave: &'a DeviceWave<'a, R>,
    sets: SampleSets,
    /// Rays and hits of the rows next to the wave's, and where their answers are.
    margins: Vec<(DeviceRays<R>, DeviceHits<R>, u64)>,
    /// Counts what is cast for them, which nobody asks for.
    uncounted: Buffer<R, Counters>,
    /// Pixels of all rows, and the first of the wave's among them.
    pixels: u64,
    first: u64,
}

impl<'a, R: Runtime> Band<'a, R> {
    fn new(cuda: &'a Cuda<R>, wave: &'a DeviceWave<'a, R>, sets: SampleSets) -> Result<Band<'a, R>, RenderError> {
        let record = wave.rays.record;
        let [width, height] = record.view.size;
        let (start, end) = (record.first_pixel / width, (record.first_pixel + record.count) / width);
        let rows = start.saturating_sub(AROUND)..height.min(end.saturating_add(AROUND));
        let uncounted: Buffer<R, Counters> =
            cuda.pool().zeros("counters of rows next to a band", Tally::SHARDS as usize)?;
        let mut margins = Vec::new();
        for part in [rows.start..start, end..rows.end] {
            let record = Rays { first_pixel: part.start * width, count: part.len() as u32 * width, ..record };
            let rays = DeviceRays::new(record, None, wave.rays.spacing);
            let counts = (Tally { shards: uncounted.output() }, 0);
            let hits = closest_hits(cuda, wave.context, wave.scene, &rays, counts)?;
            margins.push((rays, hits, u64::from(part.start - rows.start) * u64::from(width)));
        }
        let place = |row: u32| u64::from(row - rows.start) * u64::from(width);
        Ok(Band { cuda, wave, sets, margins, uncounted, pixels: place(rows.end), first: place(start) })
    }

    /// Computes the shares of some lights.
    fn adapt(&self, visibility: &DeviceVisibility<R>, lights: Range<usize>) -> Result<(), RenderError> {
        let Band { cuda, wave, sets, .. } = self;
        let pool = cuda.pool();
        let answers = pool.room("answers of first rays", self.pixels as usize * lights.len())?;
        let tiles = wave.rays.blocks(BLOCK_SIDE);
        let blocks = tiles * lights.len() as u64;
        let counts = pool.room("number of pixels whose neighbours disagree", blocks as usize + 1)?;
        let of_lights = |shadows| Shadows { first_light: lights.start as u32, end_light: lights.end as u32, ..shadows };
        let record = AdaptiveShadows {
            scene: wave.scene.record,
            shadows: of_lights(sets.record(cuda, wave, visibility, 0)?),
            answers: answers.output(),
            answer_count: self.pixels,
            first_answer: self.first,
            counts: counts.output(),
            places: places(),
            tiles: tiles as u32,
            ..AdaptiveShadows::zeroed()
        };

        // 1. The first rays, those of the rows next to the band and its own.
        for (rays, hits, first_answer) in &self.margins {
            let tally = Tally { shards: self.uncounted.output() };
            let (rays, hits) = (rays.record, hits.hits.input());
            let shadows = Shadows { rays, hits, share: Out::NULL, tally, ..record.shadows };
            self.first_rays(AdaptiveShadows { shadows, first_answer: *first_answer, ..record }, 0)?;
        }
        let progress = (wave.rays.len() * lights.len()) as u64;
        self.first_rays(record, progress)?;

        // 2. Where neighbours disagree.
        let all = blocks_for(&(0..blocks), BLOCK);
        cuda.launch(FIND_OPEN.of(wave.scene), all, &record)?;
        let count = cuda.scan_total(&counts)?;
        if count == 0 {
            return Ok(());
        }
        let entries = pool.room("pixels whose neighbours disagree", count)?;
        let record = AdaptiveShadows { entries: entries.output(), entry_count: count as u64, ..record };
        cuda.launch(LIST_OPEN, all, &record)?;

        // 3. All samples there, set by set.
        let kernel = OPEN_RAYS.of(wave.scene);
        let progress = |done: u32| progress * u64::from(done) / u64::from(sets.count);
        for set in 0..sets.count {
            let shadows = of_lights(sets.record(cuda, wave, visibility, set)?);
            let blocks = (count as u64).div_ceil(u64::from(BLOCK));
            let work = Work::of_rays(blocks, &(0..sets.most(set)), progress(set + 1) - progress(set));
            cuda.in_pieces(wave.context, kernel, work, |piece| {
                cuda.launch(kernel, blocks_for(&piece, BLOCK), &of_piece(&record, &shadows, &piece))
            })?;
        }
        Ok(())
    }

    /// Casts the first rays of some rows.
    fn first_rays(&self, record: AdaptiveShadows, progress: u64) -> Result<(), RenderError> {
        let (cuda, shadows) = (self.cuda, record.shadows);
        let kernel = FIRST_RAYS.of(self.wave.scene);
        let rays = DeviceRays::<R>::new(shadows.rays, None, self.wave.rays.spacing);
        let lights = u64::from(shadows.first_light)..u64::from(shadows.end_light);
        let work = Work::of_rays(rays.blocks(BLOCK_SIDE), &lights, progress);
        cuda.in_pieces(self.wave.context, kernel, work, |piece| {
            cuda.launch(kernel, blocks_for(&piece, BLOCK), &of_piece(&record, &shadows, &piece))
        })
    }
}

/// The arguments of one launch.
fn of_piece(record: &AdaptiveShadows, shadows: &Shadows, piece: &Range<u64>) -> AdaptiveShadows {
    let shadows = Shadows { first: piece.start, count: piece.end - piece.start, ..*shadows };
    AdaptiveShadows { shadows, ..*record }
}
