//! Adaptive shadow rays on the CPU: light by light, a task per run of rays.

use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering};

use lightmesh_layout::constants::{ANSWER_BOTH, ANSWER_DARK, ANSWER_LIT, ANSWER_STRADDLES, AROUND};
use rayon::prelude::*;

use super::first::{Extent, Places, all_are_points, place_of, places};
use crate::counters::Tally;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shadow::projected_light::Emitter;
use crate::shadow::{SEGMENTS, ShadowTarget, hidden, shadow_segment};
use crate::stages::primary_rays::cpu::{camera_rays, closest_hits};
use crate::stages::shadow_rays::cpu::{Batch, shadow_rays};
use crate::steps::spread_out;
use crate::view::View;

/// Maximum number of rays per task.
const RUN: usize = 1024;

/// The visible share of each light from each surface point.
pub(crate) fn adaptive_shadows(wave: &HostWave, target: &ShadowTarget) -> Visibility {
    if all_are_points(target, wave.lights()) {
        return shadow_rays(wave, &ShadowTarget::Center);
    }
    let Some(view) = wave.rays.view.filter(|_| !wave.hits.is_empty()) else { return shadow_rays(wave, target) };
    let rows = wave.rows(target);
    let band = Band::new(wave, &view);
    let mut visibility = Visibility::dark(wave.group(), wave.hits.len());
    let planes = visibility.share.chunks_exact_mut(wave.hits.len());
    for (emitter, shares) in Emitter::all(wave, target, &rows).iter().zip(planes) {
        if emitter.is_point() {
            band.all_samples(emitter, shares);
        } else {
            band.adapt(emitter, shares);
        }
    }
    visibility
}

/// The rows of a wave, with those next to it that belong to the neighbourhoods of its pixels.
struct Band<'a> {
    wave: &'a HostWave<'a>,
    width: usize,
    /// All rows.
    rows: Range<u32>,
    /// Rays and hits of the rows next to the wave's.
    margins: Vec<(crate::data::rays::RayList, Vec<lightmesh_trace::accel::Hit>)>,
    places: Places,
    /// Whether some pixels are not in the image.
    leaves_image: bool,
}

impl<'a> Band<'a> {
    fn new(wave: &'a HostWave<'a>, view: &View) -> Band<'a> {
        let [width, height] = view.size();
        let first = wave.rays.pixels[0] / width;
        let end = first + wave.hits.len() as u32 / width;
        let rows = first.saturating_sub(AROUND)..height.min(end + AROUND);
        let margins = [rows.start..first, end..rows.end].map(|rows| {
            let rays = camera_rays(view, rows);
            let hits = closest_hits(wave.scene, &rays, |_, trace| trace());
            (rays, hits)
        });
        let leaves_image = view.window().leaves_image();
        Band { wave, width: width as usize, rows, margins: margins.into(), places: places(), leaves_image }
    }

    /// The shares of a light of which all samples are tested.
    fn all_samples(&self, emitter: &Emitter, shares: &mut [f32]) {
        spread_out(shares.chunks_mut(RUN)).for_each(|(run, shares)| {
            let first = run * RUN;
            self.wave.context.piece(2 * shares.len(), || {
                let mut batch = Batch::new(self.wave);
                batch.take(first..first + shares.len());
                batch.shares(emitter, |ray, share| shares[ray - first] = share);
            });
        });
    }

    /// The shares of a light with a size.
    fn adapt(&self, emitter: &Emitter, shares: &mut [f32]) {
        // 1. The first rays, those of the wave and of the rows next to it.
        let answers: Vec<AtomicU8> = (0..self.width * self.rows.len()).map(|_| AtomicU8::new(0)).collect();
        for (rays, hits) in &self.margins {
            let wave = HostWave { rays, hits, ..*self.wave };
            self.first_rays(&wave, emitter, &answers);
        }
        let (wave, context) = (self.wave, self.wave.context);
        Tally::add(&context.tally.shadow_rays, self.first_rays(wave, emitter, &answers));
        let wide = self.widened(&answers);

        // 2. and 3. Where neighbours agree, the share is theirs; elsewhere all samples are tested.
        let most = emitter.sets.iter().flat_map(|set| set.count).sum::<u32>().max(1) as usize;
        spread_out(shares.chunks_mut(RUN)).for_each(|(run, shares)| {
            let first = run * RUN;
            context.piece(shares.len(), || {
                let mut open = Vec::new();
                for (ray, share) in (first..).zip(shares.iter_mut()) {
                    let place = self.place(wave.rays.pixels[ray]);
                    let own = u32::from(answers[place].load(Ordering::Relaxed));
                    if own & ANSWER_STRADDLES != 0 || own != 0 && self.around(&answers, &wide, place) == ANSWER_BOTH {
                        open.push(ray);
                    } else {
                        *share = (own & ANSWER_LIT) as f32;
                    }
                }
                let mut batch = Batch::new(wave);
                for rays in open.chunks((SEGMENTS / most).max(1)) {
                    batch.take(rays.iter().copied());
                    batch.shares(emitter, |ray, share| shares[ray - first] = share);
                }
            });
        });
    }

    /// Where the answer of a pixel is.
    fn place(&self, pixel: u32) -> usize {
        pixel as usize - self.rows.start as usize * self.width
    }

    /// Casts a ray from each surface point of a wave to a light, and notes the answers. Returns the number of rays.
    fn first_rays(&self, wave: &HostWave, emitter: &Emitter, answers: &[AtomicU8]) -> u64 {
        let is_own = std::ptr::eq(wave.hits, self.wave.hits);
        let runs = spread_out(0..wave.hits.len().div_ceil(RUN)).map(|(_, run)| {
            let rays = run * RUN..wave.hits.len().min((run + 1) * RUN);
            let mut cast = 0;
            let trace = || cast = self.first_rays_of(wave, emitter, rays.clone(), answers);
            if is_own {
                wave.context.piece(rays.len(), trace)
            } else {
                wave.context.piece(0, trace)
            }
            cast
        });
        runs.sum()
    }

    fn first_rays_of(&self, wave: &HostWave, emitter: &Emitter, rays: Range<usize>, answers: &[AtomicU8]) -> u64 {
        let (mut segments, mut owners) = (Vec::with_capacity(RUN), Vec::with_capacity(RUN));
        for ray in rays.filter(|&ray| wave.sees(ray)) {
            let point = emitter.seen_from(&wave.scene.geometry, &wave.shadow_point(ray));
            let pixel = wave.rays.pixels[ray];
            let extent = Extent::new(emitter, &point, wave.scene.geometry.sun_distance(point.origin));
            let Some(known) = extent.at_horizon(point.normal) else { continue };
            let target = extent.target(point.origin, &self.places, place_of(wave.rays.window.place(pixel)));
            if point.normal.dot(target - point.origin) > 0.0 {
                segments.push(shadow_segment(emitter.light().0, point.origin, target));
                owners.push((pixel, known));
            } else {
                answers[self.place(pixel)].store(ANSWER_STRADDLES as u8, Ordering::Relaxed);
            }
        }
        for (&(pixel, known), hidden) in owners.iter().zip(hidden(wave, &segments)) {
            let answer = known | if hidden { ANSWER_DARK } else { ANSWER_LIT };
            answers[self.place(pixel)].store(answer as u8, Ordering::Relaxed);
        }
        segments.len() as u64
    }

    /// The answers of each pixel's neighbours in its row.
    fn widened(&self, answers: &[AtomicU8]) -> Vec<u8> {
        let mut wide = vec![0; answers.len()];
        let around = AROUND as usize;
        answers.par_chunks(self.width).zip(wide.par_chunks_mut(self.width)).for_each(|(answers, wide)| {
            for (x, wide) in wide.iter_mut().enumerate() {
                let near = &answers[x.saturating_sub(around)..answers.len().min(x + around + 1)];
                *wide = near.iter().fold(0, |all, answer| all | answer.load(Ordering::Relaxed));
            }
        });
        wide
    }

    /// The answers in the neighbourhood of a place.
    fn around(&self, answers: &[AtomicU8], wide: &[u8], place: usize) -> u32 {
        let (row, column) = (place / self.width, place % self.width);
        let around = AROUND as usize;
        let rows = row.saturating_sub(around)..self.rows.len().min(row + around + 1);
        let all = if self.leaves_image {
            // Those on the other side of the image's edge do not count for its pixels.
            let columns = column.saturating_sub(around)..self.width.min(column + around + 1);
            let others = rows.flat_map(|row| columns.clone().map(move |column| row * self.width + column));
            let pixel = |place: usize| place as u32 + self.rows.start * self.width as u32;
            let window = &self.wave.rays.window;
            let counting = others.filter(|&other| !window.is_beyond(pixel(place), pixel(other)));
            counting.fold(0, |all, other| all | answers[other].load(Ordering::Relaxed))
        } else {
            rows.fold(0, |all, row| all | wide[row * self.width + column])
        };
        u32::from(all) & ANSWER_BOTH
    }
}
