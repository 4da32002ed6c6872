//! Tests every triangle: the reference with which the other structures are compared.

use std::sync::Arc;

use fearless_simd::Level;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::deduplicate::deduplicate;
use super::ray_clamp::{ClampedRay, RayClamp};
use super::region_filter::{ChunkSink, RegionFilter};
use super::triangle::RayShear;
use super::visit::{All, Visitor};
use super::{Accelerator, AcceleratorKind, AlphaMask, Hit, Ray, Region, ShortSegments, Triangle};
use crate::simd::dispatch;

/// A list of triangles, all of which are tested.
#[derive(Clone, Debug)]
pub struct BruteForce {
    triangles: Arc<[Triangle]>,
    ray_clamp: RayClamp,
    alpha_mask: AlphaMask,
}

impl BruteForce {
    /// Keeps the usable triangles, one of identical ones.
    pub fn new(triangles: &[Triangle]) -> BruteForce {
        let triangles: Arc<[_]> = deduplicate(triangles).into_iter().map(|at| triangles[at as usize]).collect();
        BruteForce { ray_clamp: RayClamp::around(&triangles), triangles, alpha_mask: AlphaMask::default() }
    }

    /// The opacities of triangles that are cut out.
    #[doc(hidden)]
    pub fn with_alpha_mask(self, alpha_mask: &AlphaMask) -> BruteForce {
        BruteForce { alpha_mask: alpha_mask.clone(), ..self }
    }

    /// The triangles held.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Centre and radius of the sphere of interest.
    pub fn ray_clamp(&self) -> (glam::Vec3, f32) {
        self.ray_clamp.parts()
    }

    fn closest(&self, ray: &ClampedRay) -> Hit {
        let shear = RayShear::new(ray.origin, ray.direction);
        self.triangles.iter().fold(Hit::MISS, |best, triangle| match shear.hit(triangle, ray.t_max) {
            Some(hit) if hit.beats(&best) && self.alpha_mask.has(triangle, &hit) => hit,
            _ => best,
        })
    }

    fn any(&self, ray: &ClampedRay) -> bool {
        let shear = RayShear::new(ray.origin, ray.direction);
        let covers =
            |triangle: &Triangle| shear.hit(triangle, ray.t_max).is_some_and(|hit| self.alpha_mask.has(triangle, &hit));
        self.triangles.iter().any(covers)
    }
}

impl Accelerator for BruteForce {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (hit, ray) in hits.iter_mut().zip(rays) {
            *hit = self.ray_clamp.ray(ray).map_or(Hit::MISS, |near| near.finish(self.closest(&near)));
        }
    }

    fn all_hits(&self, rays: &[Ray], take: &mut dyn FnMut(usize, &[Hit])) {
        let mut hits = Vec::new();
        for (number, ray) in rays.iter().enumerate() {
            let Some(near) = self.ray_clamp.ray(ray) else { continue };
            let mut all = All::new(&near, &self.alpha_mask, &mut hits);
            self.triangles.iter().for_each(|triangle| {
                all.triangle(triangle);
            });
            all.finish(&near, |hits| take(number, hits));
        }
    }

    fn occluded(&self, segments: &[Ray], occluded: &mut [bool]) {
        for (occluded, segment) in occluded.iter_mut().zip(segments) {
            *occluded = self.ray_clamp.ray(segment).is_some_and(|near| self.any(&near));
        }
    }

    fn short_segments(&self, segments: &ShortSegments, blocked: &mut [bool]) {
        segments.ask(self.triangles.iter(), blocked);
    }

    fn search(&self, region: &Region, take: ChunkSink) {
        dispatch!(Level::new(), simd => search(simd, &self.triangles, region, take));
    }

    fn masked_by(&self, alpha_mask: &AlphaMask) -> Box<dyn Accelerator> {
        Box::new(self.clone().with_alpha_mask(alpha_mask))
    }

    fn name(&self) -> &'static str {
        "brute-force"
    }

    fn kind(&self) -> AcceleratorKind<'_> {
        AcceleratorKind::BruteForce(self)
    }

    fn memory(&self) -> usize {
        size_of_val(&*self.triangles)
    }
}

#[simd]
fn search<S: Simd>(simd: S, triangles: &[Triangle], region: &Region, take: ChunkSink) {
    let mut filter = RegionFilter::new(simd, region, take);
    for triangle in triangles {
        if !filter.take(triangle) {
            return;
        }
    }
    filter.finish();
}
