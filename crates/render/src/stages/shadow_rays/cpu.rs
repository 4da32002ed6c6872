//! Shadow rays on the CPU.

use glam::Vec3;
use lightmesh_scene::Light;
use rayon::prelude::*;

use super::Visibility;
use crate::accel::{Hit, Ray};
use crate::job::{Job, Tally};
use crate::prepared::PreparedScene;
use crate::sampling::{Pattern, light_center, light_point};
use crate::stages::primary_rays::{RayList, object_point};
use crate::stages::shade::Surface;
use crate::surface::{SurfacePoint, long_segment};

/// Object points that one task takes.
const BATCH: usize = 1024;
/// Most segments that are handed over at once: they stay in a core's cache.
const SEGMENTS: usize = 4 * 1024;

/// One ray from each object point to the middle of each light.
pub(crate) fn shadow_rays(job: &Job, scene: &PreparedScene, list: &RayList, hits: &[Hit]) -> Visibility {
    let lights = &scene.scene.lights;
    let mut share = vec![0.0; hits.len() * lights.len()];
    if lights.is_empty() {
        return Visibility { lights: 0, ..Visibility::default() };
    }
    share.par_chunks_mut(BATCH * lights.len()).enumerate().for_each(|(batch, share)| {
        if job.observer.cancelled() {
            return;
        }
        let first = batch * BATCH;
        let rays = share.len() / lights.len();
        let (mut segments, mut targets) = (Vec::with_capacity(share.len()), Vec::with_capacity(share.len()));
        let seen = (0..rays).filter(|ray| hits[first + ray].is_some());
        let points: Vec<_> = seen.map(|ray| (ray, object_point(scene, list, hits, first + ray))).collect();
        // Light by light: segments towards one light are traced together.
        for (light, target) in lights.iter().enumerate() {
            for (ray, point) in &points {
                let target = light_center(target, point.origin, scene.reach(point.origin));
                if point.normal.dot(target - point.origin) > 0.0 {
                    segments.push(long_segment(point.origin, target));
                    targets.push(ray * lights.len() + light);
                }
            }
        }
        let occluded = trace(job, scene, &segments);
        for (&target, occluded) in targets.iter().zip(occluded) {
            share[target] = f32::from(u8::from(!occluded));
        }
        job.observer.advance(rays as u64);
    });
    Visibility { lights: lights.len(), share, ..Visibility::default() }
}

/// Many rays from each object point to each light, shaded sample by sample.
pub(crate) fn area_shadows(job: &Job, scene: &PreparedScene, list: &RayList, hits: &[Hit]) -> Visibility {
    let lights = scene.scene.lights.len();
    let mut share = vec![0.0; hits.len() * lights];
    let mut direct = vec![Vec3::ZERO; hits.len()];
    let samples = scene.scene.lights.iter().map(|light| sample_count(job, light)).max().unwrap_or(1);
    let batch = (SEGMENTS / samples as usize).clamp(1, BATCH);
    let work = direct.par_chunks_mut(batch).zip(share.par_chunks_mut((batch * lights).max(1))).enumerate();
    work.for_each(|(index, (direct, share))| {
        if job.observer.cancelled() {
            return;
        }
        let (mut segments, mut owners) = (Vec::with_capacity(SEGMENTS), Vec::with_capacity(SEGMENTS));
        for light in 0..lights {
            let light = AreaLight::new(job, scene, list, hits, light);
            light.gather(index * batch, direct, share, &mut segments, &mut owners);
        }
        job.observer.advance(direct.len() as u64);
    });
    Visibility { lights, share, direct, used: Vec::new() }
}

/// Rays that area mode casts to `light`: one where it has no extent.
fn sample_count(job: &Job, light: &Light) -> u32 {
    let spread =
        job.sampling.spread && matches!(light.kind, lightmesh_scene::LightKind::Point { spread, .. } if spread > 0.0);
    if light.has_size() || spread { job.sampling.samples } else { 1 }
}

/// Area shadows of one light for a batch of object points.
struct AreaLight<'a> {
    job: &'a Job<'a>,
    scene: &'a PreparedScene<'a>,
    list: &'a RayList,
    hits: &'a [Hit],
    index: usize,
    light: &'a Light,
    samples: u32,
}

impl<'a> AreaLight<'a> {
    fn new(job: &'a Job, scene: &'a PreparedScene, list: &'a RayList, hits: &'a [Hit], index: usize) -> AreaLight<'a> {
        let light = &scene.scene.lights[index];
        AreaLight { job, scene, list, hits, index, light, samples: sample_count(job, light) }
    }

    /// Adds this light to the object points from `first` on. `share` is interleaved by light. `segments` and `owners` are room for the
    /// rays, and for the object point and the target of each.
    fn gather(
        &self,
        first: usize,
        direct: &mut [Vec3],
        share: &mut [f32],
        segments: &mut Vec<Ray>,
        owners: &mut Vec<(usize, Vec3)>,
    ) {
        let lights = self.scene.scene.lights.len();
        let weight = 1.0 / self.samples as f32;
        segments.clear();
        owners.clear();
        for ray in (0..direct.len()).filter(|ray| self.hits[first + ray].is_some()) {
            let point = object_point(self.scene, self.list, self.hits, first + ray);
            for target in self.targets(first + ray, &point) {
                // A sample behind the surface is dark without a ray.
                if point.normal.dot(target - point.origin) > 0.0 {
                    segments.push(long_segment(point.origin, target));
                    owners.push((ray, target));
                }
            }
        }
        let occluded = trace(self.job, self.scene, segments);
        let mut surface: Option<(usize, Surface)> = None;
        for (&(ray, target), _) in owners.iter().zip(occluded).filter(|(_, occluded)| !occluded) {
            share[ray * lights + self.index] += 1.0;
            let (_, surface) = match &mut surface {
                Some(known) if known.0 == ray => known,
                stale => stale.insert((ray, Surface::new(self.scene, self.list, self.hits, first + ray))),
            };
            direct[ray] += weight * surface.reflected(self.light, target);
        }
        for ray in 0..direct.len() {
            let count = &mut share[ray * lights + self.index];
            *count *= weight;
            // The product of N and 1/N may miss 1 by a rounding.
            *count = if *count > 1.0 - 0.5 * weight { 1.0 } else { *count };
        }
    }

    /// The points of the light that the object point of `ray` looks at.
    fn targets(&self, ray: usize, point: &SurfacePoint) -> impl Iterator<Item = Vec3> + use<'a> {
        let (light, origin, reach) = (self.light, point.origin, self.scene.reach(point.origin));
        let pattern = Pattern::new(self.job.sampling.seed, ray_key(self.list, ray), self.index);
        let single = self.samples == 1 && !light.has_size();
        (0..self.samples).map(move |sample| {
            if single {
                light_center(light, origin, reach)
            } else {
                light_point(light, origin, reach, pattern.point(sample))
            }
        })
    }
}

/// What tells the random patterns of two object points apart: the pixel, and whether it is seen in a mirror.
pub(crate) fn ray_key(list: &RayList, ray: usize) -> u64 {
    u64::from(list.pixels[ray]) << 1 | u64::from(!list.from_camera())
}

fn trace(job: &Job, scene: &PreparedScene, segments: &[Ray]) -> Vec<bool> {
    let mut occluded = vec![false; segments.len()];
    for (segments, occluded) in segments.chunks(SEGMENTS).zip(occluded.chunks_mut(SEGMENTS)) {
        scene.accelerator.occluded(segments, occluded);
    }
    Tally::add(&job.tally.shadow_rays, segments.len() as u64);
    occluded
}

/// The visible share of one light from one object point, without χ: the fallback where no light point is used.
pub(crate) fn fallback(job: &Job, scene: &PreparedScene, key: u64, point: &SurfacePoint, index: usize) -> f32 {
    let light = &scene.scene.lights[index];
    let reach = scene.reach(point.origin);
    let samples = if light.has_size() { job.sampling.samples } else { 1 };
    let pattern = Pattern::new(job.sampling.seed, key, index);
    let segments: Vec<Ray> = (0..samples)
        .map(|sample| match light.has_size() {
            true => light_point(light, point.origin, reach, pattern.point(sample)),
            false => light_center(light, point.origin, reach),
        })
        .filter(|&target| point.normal.dot(target - point.origin) > 0.0)
        .map(|target| long_segment(point.origin, target))
        .collect();
    let seen = trace(job, scene, &segments).into_iter().filter(|occluded| !occluded).count();
    seen as f32 / samples as f32
}
