//! Shadow rays on the CPU: batch by batch of surface points, light by light, so that segments towards one light are traced together.

use lightmesh_scene::Light;
use rayon::prelude::*;

use crate::accel::Ray;
use crate::counters::Tally;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shadow::{Aim, SEGMENTS, Targets, each_shadow_ray, hidden};
use crate::surface::SurfacePoint;

/// Maximum number of surface points per task.
const BATCH: usize = 1024;

/// The visible share of each light, by shadow rays from each surface point.
pub(crate) fn shadow_rays(wave: &HostWave, aim: &Aim) -> Visibility {
    let most = wave.lights().iter().map(|light| aim.samples(light)).max().unwrap_or(1);
    let batch = (SEGMENTS / most as usize).clamp(1, BATCH);
    let mut visibility = Visibility::dark(wave.lights().len(), wave.hits.len());
    visibility.parts(batch).into_par_iter().enumerate().for_each(|(number, shares)| {
        let first = number * batch;
        let rays = first..wave.hits.len().min(first + batch);
        wave.job.piece(rays.len(), || {
            let seen = rays.filter(|&ray| wave.sees(ray));
            let points = seen.map(|ray| (ray, wave.surface_point(ray))).collect();
            let mut batch = Batch { wave, aim, first, points, segments: Vec::new(), owners: Vec::new() };
            for (light, share) in wave.lights().iter().enumerate().zip(shares) {
                batch.light(light, share);
            }
        });
    });
    visibility
}

/// Some surface points, and buffers for their rays to one light.
struct Batch<'a> {
    wave: &'a HostWave<'a>,
    aim: &'a Aim,
    /// The ray that the first share belongs to.
    first: usize,
    points: Vec<(usize, SurfacePoint)>,
    segments: Vec<Ray>,
    /// The share that each segment contributes to.
    owners: Vec<usize>,
}

impl Batch<'_> {
    /// Computes the shares of one light.
    fn light(&mut self, (index, light): (usize, &Light), share: &mut [f32]) {
        let samples = self.aim.samples(light);
        self.segments.clear();
        self.owners.clear();
        for (ray, point) in &self.points {
            let reach = self.wave.scene.geometry.reach(point.origin);
            let targets = Targets::new(self.aim, (index, light), point.origin, reach, self.wave.rays.key(*ray));
            each_shadow_ray(point, &targets, samples, |segment| {
                self.segments.push(segment);
                self.owners.push(ray - self.first);
            });
        }
        Tally::add(&self.wave.job.tally.shadow_rays, self.segments.len() as u64);
        for (&owner, _) in self.owners.iter().zip(hidden(self.wave, &self.segments)).filter(|(_, hidden)| !hidden) {
            share[owner] += 1.0;
        }
        if samples == 1 {
            return;
        }
        let weight = 1.0 / samples as f32;
        for count in share {
            *count *= weight;
            // The product of N and 1/N may differ from 1 by rounding.
            *count = if *count > 1.0 - 0.5 * weight { 1.0 } else { *count };
        }
    }
}
