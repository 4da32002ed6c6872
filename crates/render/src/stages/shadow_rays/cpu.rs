//! Shadow rays on the CPU: batch by batch of surface points, light by light, so that segments towards one light are traced together.

use lightmesh_trace::accel::Ray;
use rayon::prelude::*;

use crate::counters::Tally;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shadow::projected_light::Emitter;
use crate::shadow::terminator::ShadowPoint;
use crate::shadow::{SEGMENTS, ShadowTarget, hidden};
use crate::steps::spread_out;
use crate::surface::long_segment;

/// Maximum number of surface points per task.
const BATCH: usize = 1024;

/// The visible share of each light, by shadow rays from each surface point.
pub(crate) fn shadow_rays(wave: &HostWave, target: &ShadowTarget) -> Visibility {
    let rows = wave.rows(target);
    let emitters = Emitter::all(wave, target, &rows);
    let most = wave.lights().iter().map(|light| target.samples(light)).max().unwrap_or(1);
    let batch = (SEGMENTS / most as usize).clamp(1, BATCH);
    let mut visibility = Visibility::dark(wave.group(), wave.hits.len());
    spread_out(visibility.parts(batch)).for_each(|(number, shares)| {
        let first = number * batch;
        let rays = first..wave.hits.len().min(first + batch);
        wave.context.piece(rays.len(), || {
            let mut batch = Batch::new(wave);
            batch.take(rays);
            for (emitter, share) in emitters.iter().zip(shares) {
                batch.shares(emitter, |ray, seen| share[ray - first] = seen);
            }
        });
    });
    visibility
}

/// Some surface points, and buffers for their rays to one light.
pub(crate) struct Batch<'a> {
    wave: &'a HostWave<'a>,
    /// Rays and the surface points that they see.
    points: Vec<(usize, ShadowPoint)>,
    segments: Vec<Ray>,
    /// The number of the surface point that each segment belongs to.
    owners: Vec<usize>,
    /// The number of samples that each of them sees.
    seen: Vec<u32>,
}

impl<'a> Batch<'a> {
    /// An empty batch.
    pub(crate) fn new(wave: &'a HostWave<'a>) -> Batch<'a> {
        Batch { wave, points: Vec::new(), segments: Vec::new(), owners: Vec::new(), seen: Vec::new() }
    }

    /// Replaces the surface points by those of `rays`.
    pub(crate) fn take(&mut self, rays: impl Iterator<Item = usize>) {
        let wave = self.wave;
        self.points.clear();
        self.points.extend(rays.filter(|&ray| wave.sees(ray)).map(|ray| (ray, wave.shadow_point(ray))));
    }

    /// Hands the share of a light that each surface point sees to `put`, with its ray.
    pub(crate) fn shares(&mut self, emitter: &Emitter, mut put: impl FnMut(usize, f32)) {
        self.segments.clear();
        self.owners.clear();
        for (owner, (ray, point)) in self.points.iter().enumerate() {
            let point = emitter.seen_from(&self.wave.scene.geometry, point);
            emitter.each_target(self.wave, *ray, &point, |target| {
                if point.normal.dot(target - point.origin) > 0.0 {
                    self.segments.push(long_segment(point.origin, target));
                    self.owners.push(owner);
                }
            });
        }
        Tally::add(&self.wave.context.tally.shadow_rays, self.segments.len() as u64);
        self.seen.clear();
        self.seen.resize(self.points.len(), 0);
        for (&owner, hidden) in self.owners.iter().zip(hidden(self.wave, &self.segments)) {
            self.seen[owner] += u32::from(!hidden);
        }
        self.points.iter().zip(&self.seen).for_each(|((ray, _), &seen)| put(*ray, emitter.share(seen)));
    }
}
