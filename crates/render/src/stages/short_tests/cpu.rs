//! Step 2 on the CPU: groups, then masks run by run.

use fearless_simd::{Level, prelude::*};
use lightmesh_scene::Bounds;
use rayon::prelude::*;

use super::batch::Batch;
use super::cells::CellOccluders;
use super::lanes::LANES;
use super::plain;
use super::{CellGroups, CellPoints, MaskCounts, Masks};
use crate::accel::Hit;
use crate::job::{Job, Tally};
use crate::light_mesh::{LightMesh, point_of};
use crate::prepared::PreparedScene;
use crate::settings::ShortTests;
use crate::simd::dispatch;
use crate::stages::primary_rays::{RayList, object_point};
use crate::surface::SurfacePoint;

/// Object points that one task takes.
const RUN: usize = 4096;

pub(crate) fn short_tests(
    job: &Job,
    scene: &PreparedScene,
    list: &RayList,
    hits: &[Hit],
    mesh: &LightMesh,
    kind: ShortTests,
) -> Masks {
    let groups = CellGroups::new(scene, list, hits, &mesh.lattice);
    let words = mesh.template.words();
    let mut bits = vec![0; words * groups.members().len()];

    let runs = groups.runs(RUN);
    let mut pieces = Vec::with_capacity(runs.len());
    let mut rest = bits.as_mut_slice();
    for run in &runs {
        let (piece, tail) = rest.split_at_mut(groups.slots_of(run).len() * words);
        pieces.push((run.clone(), piece));
        rest = tail;
    }

    let level = Level::new();
    let counts = pieces
        .into_par_iter()
        .map(|(run, piece)| {
            if job.observer.cancelled() {
                return MaskCounts::default();
            }
            let work = Run { scene, list, hits, mesh, groups: &groups };
            let counts = match kind {
                ShortTests::Cells => dispatch!(level, simd => work.by_cell(simd, run.clone(), piece)),
                ShortTests::Plain => work.plain(run.clone(), piece),
            };
            job.observer.advance((piece.len() / words) as u64);
            counts
        })
        .reduce(MaskCounts::default, |a, b| a + b);

    let tally = &job.tally;
    Tally::add(&tally.half_ball, counts.half_ball);
    Tally::add(&tally.used, counts.used);
    Tally::add(&tally.short_tests, counts.tested);
    Tally::add(&tally.short_tests_culled, counts.half_ball - counts.tested);
    Masks { groups, words, bits }
}

/// What a run of cells needs.
struct Run<'a> {
    scene: &'a PreparedScene<'a>,
    list: &'a RayList,
    hits: &'a [Hit],
    mesh: &'a LightMesh,
    groups: &'a CellGroups,
}

impl Run<'_> {
    #[inline(always)]
    fn by_cell<S: Simd>(&self, simd: S, run: std::ops::Range<usize>, bits: &mut [u32]) -> MaskCounts {
        let words = self.mesh.template.words();
        let mut occluders = CellOccluders::default();
        let mut points = CellPoints::new(self.mesh);
        let mut batch = Batch::new(self.mesh);
        let mut counts = MaskCounts::default();
        let mut object_points = Vec::new();
        let mut rest = bits;
        for group in run {
            let cell = point_of(self.groups.cell(group));
            points.place(self.mesh, cell);
            object_points.clear();
            object_points.extend(self.groups.slots(group).map(|slot| self.point(slot)));
            let origins = Bounds::around(object_points.iter().map(|point| point.origin));
            occluders.collect(self.scene, self.mesh, cell, &origins);
            for lanes in object_points.chunks(LANES) {
                let (masks, tail) = rest.split_at_mut(lanes.len() * words);
                batch.fill(lanes);
                counts = counts + batch.masks(simd, self.mesh, &points, &occluders, masks);
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
            points.place(self.mesh, point_of(self.groups.cell(group)));
            for (slot, mask) in self.groups.slots(group).zip(&mut masks) {
                counts = counts + plain::mask(self.scene, self.mesh, &points, &self.point(slot), &mut scratch, mask);
            }
        }
        counts
    }

    #[inline(always)]
    fn point(&self, slot: usize) -> SurfacePoint {
        object_point(self.scene, self.list, self.hits, self.groups.members()[slot] as usize)
    }
}
