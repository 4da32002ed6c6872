//! Step 4 on the CPU: brick by brick, light by light.

use lightmesh_scene::Light;
use rayon::prelude::*;

use super::{Lit, LitBy};
use crate::accel::Ray;
use crate::job::{Job, Sampling, Tally};
use crate::light_mesh::{LightMesh, UsedPoints, bits};
use crate::prepared::PreparedScene;
use crate::sampling::{Pattern, light_center, light_point};
use crate::surface::long_segment;

/// Bricks that one task takes.
const RUN: usize = 64;

pub(crate) fn long_tests(job: &Job, scene: &PreparedScene, points: &UsedPoints, mesh: &LightMesh) -> Lit {
    let lights = scene.scene.lights.iter().enumerate();
    let lit = lights.map(|(index, light)| LongTests { job, scene, points, mesh, index, light }.run()).collect();
    Lit { lights: lit }
}

/// The long tests towards one light.
struct LongTests<'a> {
    job: &'a Job<'a>,
    scene: &'a PreparedScene<'a>,
    points: &'a UsedPoints,
    mesh: &'a LightMesh,
    index: usize,
    light: &'a Light,
}

impl LongTests<'_> {
    fn run(&self) -> LitBy {
        if self.light.has_size() { self.share() } else { LitBy::Bits(self.bits()) }
    }

    fn bits(&self) -> Vec<u64> {
        let mut seen = vec![0; self.points.used().len()];
        seen.par_chunks_mut(RUN).enumerate().for_each(|(run, seen)| {
            let first = run * RUN;
            let segments: Vec<Ray> = self
                .positions(first..first + seen.len())
                .map(|(_, from)| long_segment(from, light_center(self.light, from, self.scene.reach(from))))
                .collect();
            let mut free = self.trace(&segments).into_iter().map(|occluded| !occluded);
            for (brick, word) in seen.iter_mut().enumerate() {
                for bit in bits(self.points.used()[first + brick]) {
                    *word |= u64::from(free.next().unwrap_or(false)) << bit;
                }
            }
        });
        seen
    }

    fn share(&self) -> LitBy {
        let Sampling { samples, seed, .. } = self.job.sampling;
        let bricks = self.points.used().len();
        let runs = (0..bricks).step_by(RUN).map(|first| first..(first + RUN).min(bricks)).collect::<Vec<_>>();
        let seen = runs
            .into_par_iter()
            .flat_map_iter(|run| {
                let segments: Vec<Ray> = self
                    .positions(run)
                    .flat_map(|(key, from)| {
                        let pattern = Pattern::new(seed, key, self.index);
                        (0..samples).map(move |sample| (from, pattern.point(sample)))
                    })
                    .map(|(from, u)| long_segment(from, light_point(self.light, from, self.scene.reach(from), u)))
                    .collect();
                let occluded = self.trace(&segments);
                let free = |rays: &[bool]| rays.iter().filter(|occluded| !**occluded).count() as u16;
                occluded.chunks_exact(samples as usize).map(free).collect::<Vec<u16>>()
            })
            .collect();
        LitBy::Share { seen, samples }
    }

    /// Number by formula (7) and position of the used points of some bricks, ascending.
    fn positions(&self, bricks: std::ops::Range<usize>) -> impl Iterator<Item = (u64, glam::Vec3)> + '_ {
        let lattice = &self.mesh.lattice;
        bricks.flat_map(|brick| self.points.points(brick)).map(|index| (lattice.packed(index), lattice.point(index)))
    }

    fn trace(&self, segments: &[Ray]) -> Vec<bool> {
        let mut occluded = vec![true; segments.len()];
        if !self.job.observer.cancelled() {
            self.scene.accelerator.occluded(segments, &mut occluded);
        }
        Tally::add(&self.job.tally.long_tests, segments.len() as u64);
        occluded
    }
}
