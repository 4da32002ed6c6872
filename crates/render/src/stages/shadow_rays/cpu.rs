//! Shadow rays on the CPU: batch by batch of surface points, light by light, so that segments towards one light are traced together.

use rayon::prelude::*;

use crate::accel::Ray;
use crate::counters::Tally;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shadow::rows::Rows;
use crate::shadow::sight::Emitter;
use crate::shadow::{Aim, SEGMENTS, hidden};
use crate::surface::{SurfacePoint, long_segment};

/// Maximum number of surface points per task.
const BATCH: usize = 1024;

/// The visible share of each light, by shadow rays from each surface point.
pub(crate) fn shadow_rays(wave: &HostWave, aim: &Aim) -> Visibility {
    let rows = Rows::of(aim);
    let emitters = Emitter::all(wave, aim, &rows);
    let most = wave.lights().iter().map(|light| aim.samples(light)).max().unwrap_or(1);
    let batch = (SEGMENTS / most as usize).clamp(1, BATCH);
    let mut visibility = Visibility::dark(wave.lights().len(), wave.hits.len());
    visibility.parts(batch).into_par_iter().enumerate().for_each(|(number, shares)| {
        let first = number * batch;
        let rays = first..wave.hits.len().min(first + batch);
        wave.job.piece(rays.len(), || {
            let seen = rays.filter(|&ray| wave.sees(ray));
            let points = seen.map(|ray| (ray, wave.surface_point(ray))).collect();
            let mut batch = Batch { wave, first, points, segments: Vec::new(), owners: Vec::new() };
            for (emitter, share) in emitters.iter().zip(shares) {
                batch.light(emitter, share);
            }
        });
    });
    visibility
}

/// Some surface points, and buffers for their rays to one light.
struct Batch<'a> {
    wave: &'a HostWave<'a>,
    /// The ray that the first share belongs to.
    first: usize,
    points: Vec<(usize, SurfacePoint)>,
    segments: Vec<Ray>,
    /// The share that each segment contributes to.
    owners: Vec<usize>,
}

impl Batch<'_> {
    /// Computes the shares of one light.
    fn light(&mut self, emitter: &Emitter, share: &mut [f32]) {
        self.segments.clear();
        self.owners.clear();
        for (ray, point) in &self.points {
            emitter.each_target(self.wave, *ray, point, |target| {
                if point.normal.dot(target - point.origin) > 0.0 {
                    self.segments.push(long_segment(point.origin, target));
                    self.owners.push(ray - self.first);
                }
            });
        }
        Tally::add(&self.wave.job.tally.shadow_rays, self.segments.len() as u64);
        for (&owner, _) in self.owners.iter().zip(hidden(self.wave, &self.segments)).filter(|(_, hidden)| !hidden) {
            share[owner] += 1.0;
        }
        share.iter_mut().for_each(|share| *share = emitter.share(*share as u32));
    }
}
