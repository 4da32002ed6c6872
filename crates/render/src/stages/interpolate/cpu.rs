//! Formula (3) on the CPU: the values of a cell's template points are fetched once, then every surface point of the cell takes its
//! mean.

use std::ops::Range;

use fearless_simd::{Level, prelude::*};
use glam::Vec3;
use lightmesh_scene::Weight;
use lightmesh_trace::simd::dispatch;
use rayon::prelude::*;

use crate::counters::Tally;
use crate::data::light_point_visibility::{LightPointVisibility, VisibilityOfLight};
use crate::data::masks::population;
use crate::data::visibility::Visibility;
use crate::data::wave::{HostSeen, HostWave};
use crate::light_mesh::{CellPoints, LightMesh, Span, UsedPoints, Windows, point_of, sum_in_both, sum_of_products};
use crate::shadow::{above_horizon, fallback};
use crate::steps::spread_out;

/// Number of surface points per task.
const RUN: usize = 4096;

pub(crate) fn interpolate(wave: &HostWave, seen: &HostSeen) -> Visibility {
    Interpolation { wave, seen }.run()
}

/// The inputs of formula (3).
struct Interpolation<'a> {
    wave: &'a HostWave<'a>,
    seen: &'a HostSeen<'a>,
}

impl Interpolation<'_> {
    fn run(&self) -> Visibility {
        let HostSeen { cells, masks, lit, mesh, .. } = *self.seen;
        let lights = lit.lights.len();
        let level = Level::new();
        let windows = Windows::new(&mesh.template);
        let runs = cells.runs(RUN);
        let members = cells.members();
        let mut shares = vec![0.0; members.len() * lights];
        let parts = parts_of(&mut shares, runs.iter().map(|run| cells.slots_of(run).len() * lights));
        let fallbacks = spread_out(runs.iter().zip(parts)).map(|(_, (run, shares))| {
            let fill = || dispatch!(level, simd => self.fill(simd, &windows, run.clone(), shares));
            self.wave.context.piece(cells.slots_of(run).len(), fill)
        });
        Tally::add(&self.wave.context.tally.fallbacks, fallbacks.sum());

        // From the order of cells back to the order of rays.
        let mut slots = vec![None; self.wave.hits.len()];
        for (slot, &ray) in members.iter().enumerate() {
            slots[ray as usize] = Some(slot as u32);
        }
        let mut visibility = Visibility::dark(0..lights, slots.len());
        for (light, plane) in visibility.share.chunks_exact_mut(slots.len().max(1)).enumerate() {
            plane.par_iter_mut().zip(&slots).with_min_len(RUN).for_each(|(share, slot)| {
                *share = slot.map_or(0.0, |slot| shares[slot as usize * lights + light]);
            });
        }
        let used = |slot: &Option<u32>| slot.map_or(0, |slot| population(masks.mask(slot as usize)) as u32);
        visibility.used = slots.par_iter().map(used).collect();
        visibility
    }

    /// Computes the shares of the surface points of some cells, one for each light, and counts the surface points without light
    /// points.
    #[inline(always)]
    fn fill<S: Simd>(&self, simd: S, windows: &Windows, run: Range<usize>, shares: &mut [f32]) -> u64 {
        let (wave, lights) = (self.wave, self.wave.lights());
        let HostSeen { cells, masks, mesh, .. } = *self.seen;
        let mut points = CellPoints::new(mesh);
        let mut values = CellValues::new(self.seen, windows);
        let mut shares = shares.iter_mut();
        let mut fallbacks = 0;
        for group in run {
            let cell = point_of(cells.cell(group));
            points.place(mesh, cell);
            values.fetch(cell);
            for slot in cells.slots(group) {
                let ray = cells.members()[slot] as usize;
                let point = wave.surface_point(ray);
                let reach = wave.scene.geometry.sun_distance(point.origin);
                let mask = masks.mask(slot);
                let mut means = Means::new(&mut values, &points, mesh, mask, point.position);
                let mut fell_back = lights.is_empty() && means.used == 0;
                for ((index, light), share) in lights.iter().enumerate().zip(&mut shares) {
                    let most = above_horizon(&point, light, reach);
                    *share = if most == 0.0 {
                        0.0
                    } else if let Some(mean) = means.mean(simd, index) {
                        mean.min(most)
                    } else {
                        fell_back = true;
                        fallback(wave, ray, &point, index)
                    };
                }
                fallbacks += u64::from(fell_back);
            }
        }
        fallbacks
    }
}

/// Splits a slice into parts of these lengths.
fn parts_of(mut rest: &mut [f32], lengths: impl Iterator<Item = usize>) -> Vec<&mut [f32]> {
    let part = |length| {
        let (part, behind) = std::mem::take(&mut rest).split_at_mut(length);
        rest = behind;
        part
    };
    lengths.map(part).collect()
}

/// What the template points of one cell see, in the template's order.
struct CellValues<'a> {
    points: &'a UsedPoints,
    lit: &'a LightPointVisibility,
    windows: &'a Windows,
    bricks: Vec<Option<usize>>,
    lights: Vec<LightValues>,
    /// Weights of a surface point's light points.
    weights: Vec<f32>,
}

/// The template points' values for one light, as masks. Unused points come out as dark; no surface point refers to them.
struct LightValues {
    /// Points that see the whole light.
    full: Vec<u32>,
    /// Points that see part of it.
    some: Vec<u32>,
    /// The share that each point sees, padded to whole words; empty for a light without an area, which is visible or not.
    share: Vec<f32>,
}

impl<'a> CellValues<'a> {
    fn new(work: &HostSeen<'a>, windows: &'a Windows) -> CellValues<'a> {
        let words = work.mesh.template.words();
        let values = |lit: &VisibilityOfLight| match lit {
            VisibilityOfLight::Bits(_) => LightValues { full: Vec::new(), some: vec![0; words], share: Vec::new() },
            VisibilityOfLight::Share { .. } => {
                LightValues { full: vec![0; words], some: vec![0; words], share: vec![0.0; 32 * words] }
            }
        };
        CellValues {
            points: work.points,
            lit: work.lit,
            windows,
            bricks: vec![None; windows.len()],
            lights: work.lit.lights.iter().map(values).collect(),
            weights: vec![0.0; 32 * words],
        }
    }

    /// Fetches the values around `cell`.
    fn fetch(&mut self, cell: glam::IVec3) {
        let window = self.windows.around(cell);
        for (slot, brick) in self.bricks.iter_mut().enumerate() {
            *brick = self.points.bricks().find(window.key(slot));
        }
        for (values, lit) in self.lights.iter_mut().zip(&self.lit.lights) {
            match lit {
                VisibilityOfLight::Bits(words) => values.fetch_bits(window.spans, &self.bricks, words),
                VisibilityOfLight::Share { seen, samples } => {
                    values.fetch_shares(window.spans, &self.bricks, self.points, seen, *samples);
                }
            }
        }
    }
}

impl LightValues {
    fn fetch_bits(&mut self, spans: &[Span], bricks: &[Option<usize>], words: &[u64]) {
        self.some.fill(0);
        for span in spans {
            if let Some(brick) = bricks[usize::from(span.slot)] {
                self.some[usize::from(span.word)] |= span.to_mask(words[brick]);
            }
        }
    }

    fn fetch_shares(
        &mut self,
        spans: &[Span],
        bricks: &[Option<usize>],
        points: &UsedPoints,
        seen: &[u16],
        samples: u32,
    ) {
        self.full.fill(0);
        self.some.fill(0);
        for span in spans {
            let (word, brick) = (usize::from(span.word), bricks[usize::from(span.slot)]);
            for point in 0..span.count {
                let bit = span.bit + point;
                let brick = brick.filter(|&brick| points.used()[brick] >> bit & 1 != 0);
                let count = brick.map_or(0, |brick| u32::from(seen[points.rank(brick, u32::from(bit))]));
                let shift = span.shift + point;
                self.share[32 * word + usize::from(shift)] = count as f32 / samples as f32;
                self.full[word] |= u32::from(count == samples) << shift;
                self.some[word] |= u32::from(count > 0) << shift;
            }
        }
    }
}

/// Formula (3) without χ for one surface point.
struct Means<'a> {
    lights: &'a [LightValues],
    points: &'a CellPoints,
    mesh: &'a LightMesh,
    mask: &'a [u32],
    position: Vec3,
    /// Light points of the mask.
    used: u64,
    /// Their weights, and the sum once a light has required it: weights are the same for all lights.
    weights: &'a mut [f32],
    sum: Option<f32>,
}

impl<'a> Means<'a> {
    #[inline(always)]
    fn new(
        values: &'a mut CellValues,
        points: &'a CellPoints,
        mesh: &'a LightMesh,
        mask: &'a [u32],
        position: Vec3,
    ) -> Means<'a> {
        let (lights, weights) = (&values.lights, &mut values.weights);
        Means { lights, points, mesh, mask, position, used: population(mask), weights, sum: None }
    }

    /// The mean for a light; `None` if no light point counts.
    #[inline(always)]
    fn mean<S: Simd>(&mut self, simd: S, light: usize) -> Option<f32> {
        if self.used == 0 {
            return None;
        }
        let values = &self.lights[light];
        if values.share.is_empty() { self.mean_of_bits(simd, values) } else { self.mean_of_shares(simd, values) }
    }

    /// If all light points see the same, or all weights are 1, counts give the mean.
    #[inline(always)]
    fn mean_of_bits<S: Simd>(&mut self, simd: S, values: &LightValues) -> Option<f32> {
        let mut lit = 0;
        for (word, seen) in self.mask.iter().zip(&values.some) {
            lit += (word & seen).count_ones();
        }
        let lit = u64::from(lit);
        if lit == 0 {
            Some(0.0)
        } else if lit == self.used {
            Some(1.0)
        } else if self.mesh.weight == Weight::Constant {
            Some(lit as f32 / self.used as f32)
        } else {
            let sum = self.weigh(simd)?;
            Some((sum_in_both(simd, self.weights, self.mask, &values.some) / sum).min(1.0))
        }
    }

    /// If light points see all or nothing, the mean is known without weights.
    #[inline(always)]
    fn mean_of_shares<S: Simd>(&mut self, simd: S, values: &LightValues) -> Option<f32> {
        let (mut dark, mut full) = (true, true);
        for (word, (all, some)) in self.mask.iter().zip(values.full.iter().zip(&values.some)) {
            dark &= word & some == 0;
            full &= word & !all == 0;
        }
        if dark {
            Some(0.0)
        } else if full {
            Some(1.0)
        } else {
            let sum = self.weigh(simd)?;
            Some((sum_of_products(simd, self.weights, self.mask, &values.share) / sum).min(1.0))
        }
    }

    /// Computes the weights at the first call. `None` if all of them vanish, which is possible at the rim.
    #[inline(always)]
    fn weigh<S: Simd>(&mut self, simd: S) -> Option<f32> {
        let sum = match self.sum {
            Some(sum) => sum,
            None => self.points.weights(simd, self.position, self.mesh, self.mask, self.weights),
        };
        self.sum = Some(sum);
        (sum > 0.0).then_some(sum)
    }
}
