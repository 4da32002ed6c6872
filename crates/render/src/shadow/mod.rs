//! What all stages that cast shadow rays share: where the rays end, whether anything hides a light, and χ of formula (3). Twin:
//! `shadow.cuh`.

pub(crate) mod cuts;
pub(crate) mod launch;
pub(crate) mod occlusion;
pub(crate) mod projected_light;
pub(crate) mod rows;
pub(crate) mod sample_ray;
pub(crate) mod terminator;
pub(crate) mod weights;

use std::sync::Arc;

use glam::Vec3;
use lightmesh_layout::constants::HORIZON_SAMPLES;
use lightmesh_scene::{Light, LightKind};
use lightmesh_trace::accel::Ray;

use crate::counters::Tally;
use crate::data::wave::{HostWave, Wave};
use crate::render_context::Sampling;
use crate::sampling::{Pattern, before_body, disk_radius, light_center, light_point};
use crate::surface::{SurfacePoint, long_segment};
use rows::Rows;

/// Maximum number of segments passed on at once: they stay in a core's cache.
pub(crate) const SEGMENTS: usize = 4 * 1024;

/// Which points of a light shadow rays are cast to.
#[derive(Clone, Copy, Debug)]
pub enum ShadowTarget {
    /// One ray to the centre.
    Center,
    /// Points distributed over a light that has an extent, with the sampling of the image.
    Area(Sampling),
}

impl<Scene, Rays, Hits> Wave<'_, Scene, Rays, Hits> {
    /// Shadow rays to the samples of each light that a ray of this wave takes.
    pub(crate) fn shadow_target(&self) -> ShadowTarget {
        ShadowTarget::Area(self.sampling())
    }

    /// The rows of the samples that rays are aimed at.
    pub(crate) fn rows(&self, target: &ShadowTarget) -> Arc<Rows> {
        let samples = match target {
            ShadowTarget::Center => 1,
            ShadowTarget::Area(sampling) => sampling.samples,
        };
        self.context.rows.of(samples)
    }
}

impl ShadowTarget {
    /// Whether more than the centre of a light counts.
    #[inline(always)]
    fn is_spread_over(&self, light: &Light) -> bool {
        match self {
            ShadowTarget::Center => false,
            ShadowTarget::Area(sampling) => {
                let spread = matches!(light.kind, LightKind::Point { spread, .. } if spread > 0.0);
                light.has_size() || (sampling.spread && spread && sampling.samples > 1)
            }
        }
    }

    /// Number of shadow rays from a point to a light.
    pub(crate) fn samples(&self, light: &Light) -> u32 {
        match self {
            ShadowTarget::Area(sampling) if self.is_spread_over(light) => sampling.samples,
            _ => 1,
        }
    }
}

/// The points of one light that shadow rays from one point are cast to.
pub(crate) struct Targets<'a> {
    light: &'a Light,
    from: Vec3,
    /// The distance of a directional light.
    reach: f32,
    /// `None`: its centre.
    pattern: Option<Pattern>,
}

impl<'a> Targets<'a> {
    /// Those of light number `index` from `from`; `key` selects the random pattern.
    #[inline(always)]
    pub(crate) fn new(
        target: &ShadowTarget,
        (index, light): (usize, &'a Light),
        from: Vec3,
        reach: f32,
        key: u64,
    ) -> Targets<'a> {
        let pattern = match target {
            ShadowTarget::Area(sampling) if target.is_spread_over(light) => {
                Some(Pattern::new(sampling.seed, key, index))
            }
            _ => None,
        };
        Targets { light, from, reach, pattern }
    }

    /// The target of sample number `sample`.
    #[inline(always)]
    pub(crate) fn get(&self, sample: u32) -> Vec3 {
        match &self.pattern {
            Some(pattern) => light_point(self.light, self.from, self.reach, pattern.point(sample)),
            None => light_center(self.light, self.from, self.reach),
        }
    }
}

/// The shadow ray from `from` to a point of `light`.
#[inline(always)]
pub(crate) fn shadow_segment(light: &Light, from: Vec3, target: Vec3) -> Ray {
    long_segment(from, before_body(light, from, target))
}

/// Whether each of some segments is blocked. Everything that can hide a light is decided here.
pub(crate) fn hidden(wave: &HostWave, segments: &[Ray]) -> Vec<bool> {
    let mut hidden = vec![false; segments.len()];
    for (segments, hidden) in segments.chunks(SEGMENTS).zip(hidden.chunks_mut(SEGMENTS)) {
        wave.scene.geometry.accelerator.occluded(segments, hidden);
    }
    hidden
}

/// Hands the shadow rays from a surface point to a light to `take`. A sample behind the surface is dark without a ray.
#[inline(always)]
pub(crate) fn each_shadow_ray(point: &SurfacePoint, targets: &Targets, samples: u32, mut take: impl FnMut(Ray)) {
    let Targets { light, from, reach, ref pattern } = *targets;
    let mut cast = |target: Vec3| {
        if point.normal.dot(target - point.origin) > 0.0 {
            take(shadow_segment(light, point.origin, target));
        }
    };
    match pattern {
        // Apart from the loop: hard shadows are little more than this.
        None => cast(light_center(light, from, reach)),
        Some(pattern) => (0..samples).for_each(|sample| cast(light_point(light, from, reach, pattern.point(sample)))),
    }
}

/// χ of formula (3) for a light: 1 if it is in front of the surface at `point`, 0 if it is behind.
///
/// An area light may straddle the horizon. Then χ is its share above the horizon, and bounds the visibility: light points higher up
/// see more of the light than the surface can.
#[inline(always)]
pub fn above_horizon(point: &SurfacePoint, light: &Light, reach: f32) -> f32 {
    let height = point.normal.dot(light_center(light, point.origin, reach) - point.origin);
    if height.abs() >= size(light, reach) {
        return if height > 0.0 { 1.0 } else { 0.0 };
    }
    let pattern = Pattern::new(0, 0, 0);
    let above = (0..HORIZON_SAMPLES)
        .map(|index| light_point(light, point.origin, reach, pattern.point(index)))
        .filter(|target| point.normal.dot(target - point.origin) > 0.0)
        .count();
    above as f32 / HORIZON_SAMPLES as f32
}

/// The largest distance of any point of `light` from its centre, for a directional light at the distance `reach`; 0 for lights without an
/// area.
#[inline(always)]
pub(crate) fn size(light: &Light, reach: f32) -> f32 {
    match light.kind {
        LightKind::Sphere { radius, .. } | LightKind::Disk { radius, .. } | LightKind::Spot { radius, .. } => radius,
        LightKind::Rectangle { half_u, half_v, .. } => (half_u.length_squared() + half_v.length_squared()).sqrt(),
        LightKind::Directional { angle, .. } => reach * disk_radius(angle),
        LightKind::Point { .. } => 0.0,
    }
}

/// The visible share of light number `index` from the surface point of `ray`, without χ: the fallback where no light point is used.
pub(crate) fn fallback(wave: &HostWave, ray: usize, point: &SurfacePoint, index: usize) -> f32 {
    let (target, light) = (ShadowTarget::Area(wave.context.sampling.of_light_points()), &wave.lights()[index]);
    let reach = wave.scene.geometry.sun_distance(point.origin);
    let targets = Targets::new(&target, (index, light), point.origin, reach, wave.rays.key(ray));
    let samples = target.samples(light);
    let mut segments = Vec::with_capacity(samples as usize);
    each_shadow_ray(point, &targets, samples, |segment| segments.push(segment));
    Tally::add(&wave.context.tally.shadow_rays, segments.len() as u64);
    let seen = hidden(wave, &segments).into_iter().filter(|hidden| !hidden).count();
    seen as f32 / samples as f32
}
