//! Step 4 on the CPU: brick by brick, light by light.

use std::ops::Range;

use lightmesh_scene::Light;
use rayon::prelude::*;

use crate::cache::{Cache, ColumnKey, HostTable};
use crate::counters::Tally;
use crate::data::light_point_visibility::{LightPointVisibility, VisibilityOfLight};
use crate::data::wave::HostWave;
use crate::light_mesh::{LightMesh, UsedPoints, bits};
use crate::shadow::{ShadowTarget, Targets, hidden, shadow_segment};

/// Number of bricks per task.
const RUN: usize = 64;

pub(crate) fn long_tests(
    wave: &HostWave,
    points: &UsedPoints,
    mesh: &LightMesh,
    cache: Option<&mut Cache<HostTable>>,
) -> LightPointVisibility {
    let lights = wave.lights().iter().enumerate();
    let target = ShadowTarget::Area(wave.context.sampling.of_light_points());
    let test = |points: &UsedPoints, (index, light)| LongTests { wave, points, mesh, target, index, light }.run();
    let table = cache.map(|cache| {
        let Ok(table) = cache.table(wave.scene, &mesh.lattice);
        let seen = wave.lights().iter().map(|light| ColumnKey::of(light, &wave.context.sampling)).collect();
        let rows = table.admit(points.bricks().keys(), seen)?;
        Some((table, rows))
    });
    let Some((table, rows)) = table.flatten() else {
        return LightPointVisibility { lights: lights.map(|light| test(points, light)).collect() };
    };
    let lookup = |(index, light)| {
        let unknown = points.only(table.unknown(index, &rows, points.used()));
        let found = test(&unknown, (index, light));
        let saved = (points.count() - unknown.count()) as u64 * u64::from(table.samples(index));
        Tally::add(&wave.context.tally.long_tests_saved, saved);
        // If the observer has requested cancellation, some results are missing.
        if wave.context.check().is_ok() {
            table.learn(index, &rows, unknown.used(), &found);
        }
        table.lookup(index, &rows, points.used())
    };
    LightPointVisibility { lights: lights.map(lookup).collect() }
}

/// The long tests towards one light.
struct LongTests<'a> {
    wave: &'a HostWave<'a>,
    points: &'a UsedPoints,
    mesh: &'a LightMesh,
    target: ShadowTarget,
    index: usize,
    light: &'a Light,
}

impl LongTests<'_> {
    fn run(&self) -> VisibilityOfLight {
        if self.light.has_size() { self.share() } else { VisibilityOfLight::Bits(self.bits()) }
    }

    fn bits(&self) -> Vec<u64> {
        let mut seen = vec![0; self.points.used().len()];
        seen.par_chunks_mut(RUN).enumerate().for_each(|(run, seen)| {
            let first = run * RUN;
            let hidden = self.hidden(first..first + seen.len(), 1);
            let mut free = hidden.into_iter().map(|hidden| !hidden);
            for (brick, word) in seen.iter_mut().enumerate() {
                for bit in bits(self.points.used()[first + brick]) {
                    *word |= u64::from(free.next().unwrap_or(false)) << bit;
                }
            }
        });
        seen
    }

    fn share(&self) -> VisibilityOfLight {
        let samples = self.target.samples(self.light);
        let bricks = self.points.used().len();
        let runs = (0..bricks).step_by(RUN).map(|first| first..(first + RUN).min(bricks)).collect::<Vec<_>>();
        let seen = runs.into_par_iter().flat_map_iter(|run| {
            let free = |rays: &[bool]| rays.iter().filter(|hidden| !**hidden).count() as u16;
            self.hidden(run, samples).chunks_exact(samples as usize).map(free).collect::<Vec<u16>>()
        });
        VisibilityOfLight::Share { seen: seen.collect(), samples }
    }

    /// Whether each of the rays from the used points of some bricks is blocked, `samples` of them per point.
    fn hidden(&self, bricks: Range<usize>, samples: u32) -> Vec<bool> {
        let LongTests { wave, target, light, index, .. } = *self;
        let mut segments = Vec::new();
        for (key, from) in self.positions(bricks) {
            let reach = wave.scene.geometry.sun_distance(from);
            let targets = Targets::new(&target, (index, light), from, reach, key);
            segments.extend((0..samples).map(|sample| shadow_segment(light, from, targets.get(sample))));
        }
        Tally::add(&wave.context.tally.long_tests, segments.len() as u64);
        wave.context.piece(segments.len(), || hidden(wave, &segments))
    }

    /// Formula (7)'s number and the position of the used points of some bricks, in ascending order.
    fn positions(&self, bricks: Range<usize>) -> impl Iterator<Item = (u64, glam::Vec3)> + '_ {
        let lattice = &self.mesh.lattice;
        bricks.flat_map(|brick| self.points.points(brick)).map(|index| (lattice.packed(index), lattice.point(index)))
    }
}
