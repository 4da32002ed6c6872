//! Step 2 on the CPU: masks, one run of cells after another.

use fearless_simd::{Level, prelude::*};
use lightmesh_trace::simd::{LANES, dispatch};
use rayon::prelude::*;

use super::batch::Batch;
use super::cells::CellOccluders;
use super::{MaskCounts, plain};
use crate::counters::Tally;
use crate::data::cells::CellGroups;
use crate::data::masks::Masks;
use crate::data::wave::HostWave;
use crate::light_mesh::{CellPoints, LightMesh, point_of};
use crate::settings::ShortTests;
use crate::steps::spread_out;
use crate::surface::SurfacePoint;

/// Surface points per task.
const RUN: usize = 4096;

pub(crate) fn short_tests(wave: &HostWave, cells: &CellGroups, mesh: &LightMesh) -> Masks {
    let words = mesh.template.words();
    let mut bits = vec![0; words * cells.members().len()];

    let runs = cells.runs(RUN);
    let mut pieces = Vec::with_capacity(runs.len());
    let mut rest = bits.as_mut_slice();
    for run in &runs {
        let (piece, tail) = rest.split_at_mut(cells.slots_of(run).len() * words);
        pieces.push((run.clone(), piece));
        rest = tail;
    }

    let level = Level::new();
    let work = Run { wave, mesh, cells };
    let counts = spread_out(pieces)
        .map(|(_, (run, piece))| {
            wave.context.piece(piece.len() / words, || match wave.context.short_tests {
                ShortTests::Cells => dispatch!(level, simd => work.by_cell(simd, run.clone(), piece)),
                ShortTests::Plain => work.plain(run.clone(), piece),
            })
        })
        .reduce(MaskCounts::default, |a, b| a + b);

    let tally = &wave.context.tally;
    Tally::add(&tally.half_ball, counts.half_ball);
    Tally::add(&tally.used, counts.used);
    Tally::add(&tally.short_tests, counts.tested);
    Tally::add(&tally.short_tests_culled, counts.half_ball - counts.tested);
    Masks { words, bits }
}

/// What a run of cells needs.
struct Run<'a> {
    wave: &'a HostWave<'a>,
    mesh: &'a LightMesh,
    cells: &'a CellGroups,
}

impl Run<'_> {
    #[inline(always)]
    fn by_cell<S: Simd>(&self, simd: S, run: std::ops::Range<usize>, bits: &mut [u32]) -> MaskCounts {
        let words = self.mesh.template.words();
        let mut occluders = CellOccluders::default();
        let mut points = CellPoints::new(self.mesh);
        let mut batch = Batch::new(self.mesh);
        let mut counts = MaskCounts::default();
        let mut surface_points = Vec::new();
        let alpha_mask = &self.wave.scene.geometry.alpha_mask;
        let mut rest = bits;
        for group in run {
            let cell = point_of(self.cells.cell(group));
            points.place(self.mesh, cell);
            surface_points.clear();
            surface_points.extend(self.cells.slots(group).map(|slot| self.point(slot)));
            occluders.collect(self.wave.scene, self.mesh, cell, &surface_points);
            for lanes in surface_points.chunks(LANES) {
                let (masks, tail) = rest.split_at_mut(lanes.len() * words);
                batch.fill(lanes);
                counts = counts + batch.masks(simd, self.mesh, &points, (&occluders, alpha_mask), masks);
                rest = tail;
            }
        }
        counts
    }

    fn plain(&self, run: std::ops::Range<usize>, bits: &mut [u32]) -> MaskCounts {
        let mut scratch = plain::Scratch::default();
        let mut points = CellPoints::new(self.mesh);
        let mut masks = bits.chunks_exact_mut(self.mesh.template.words());
        let mut counts = MaskCounts::default();
        for group in run {
            points.place(self.mesh, point_of(self.cells.cell(group)));
            for (slot, mask) in self.cells.slots(group).zip(&mut masks) {
                counts = counts + scratch.mask(self.wave.scene, self.mesh, &points, &self.point(slot), mask);
            }
        }
        counts
    }

    #[inline(always)]
    fn point(&self, slot: usize) -> SurfacePoint {
        self.wave.surface_point(self.cells.members()[slot] as usize)
    }
}
