//! What is done with the triangles that a walk reaches; the same for every structure.

use glam::Vec3;

use super::ray_clamp::ClampedRay;
use super::triangle::RayShear;
use super::{AlphaMask, Hit, ShortSegments, ShortTest, Triangle};

/// Tests triangles and says how far it is still worth walking.
pub trait Visitor {
    /// Tests a triangle; false ends the walk.
    fn triangle(&mut self, triangle: &Triangle) -> bool;

    /// What lies at a larger ray parameter need not be tested.
    fn limit(&self) -> f32;
}

/// Searches for the closest hit.
pub(super) struct Closest<'a> {
    alpha_mask: &'a AlphaMask,
    shear: RayShear,
    t_max: f32,
    limit: f32,
    pub(super) best: Hit,
}

impl<'a> Closest<'a> {
    #[inline(always)]
    pub(super) fn new(ray: &ClampedRay, alpha_mask: &'a AlphaMask) -> Closest<'a> {
        let shear = RayShear::new(ray.origin, ray.direction);
        Closest { alpha_mask, shear, t_max: ray.t_max, limit: ray.t_max, best: Hit::MISS }
    }

    /// Continues with a known hit.
    #[inline(always)]
    pub(super) fn from(ray: &ClampedRay, alpha_mask: &'a AlphaMask, best: Hit) -> Closest<'a> {
        Closest { best, limit: ray.t_max.min(best.t), ..Closest::new(ray, alpha_mask) }
    }
}

impl Visitor for Closest<'_> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        if let Some(hit) = self.shear.hit(triangle, self.t_max)
            && hit.beats(&self.best)
            && self.alpha_mask.has(triangle, &hit)
        {
            self.best = hit;
            self.limit = hit.t;
        }
        true
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }
}

/// Collects all hits.
pub(super) struct All<'a> {
    alpha_mask: &'a AlphaMask,
    shear: RayShear,
    t_max: f32,
    hits: &'a mut Vec<Hit>,
}

impl<'a> All<'a> {
    /// They take the place of what is in `hits`.
    #[inline(always)]
    pub(super) fn new(ray: &ClampedRay, alpha_mask: &'a AlphaMask, hits: &'a mut Vec<Hit>) -> All<'a> {
        hits.clear();
        All { alpha_mask, shear: RayShear::new(ray.origin, ray.direction), t_max: ray.t_max, hits }
    }

    /// Hands over the hits of `ray`, each once and in order, if there are any.
    #[inline]
    pub(super) fn finish(self, ray: &ClampedRay, take: impl FnOnce(&[Hit])) {
        let hits = self.hits;
        if hits.is_empty() {
            return;
        }
        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
        hits.dedup_by_key(|hit| hit.triangle);
        hits.iter_mut().for_each(|hit| *hit = ray.finish(*hit));
        take(hits);
    }
}

impl Visitor for All<'_> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        if let Some(hit) = self.shear.hit(triangle, self.t_max)
            && self.alpha_mask.has(triangle, &hit)
        {
            self.hits.push(hit);
        }
        true
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        self.t_max
    }
}

/// Searches for any hit.
pub(super) struct Any<'a> {
    alpha_mask: &'a AlphaMask,
    shear: RayShear,
    t_max: f32,
    pub(super) hit: bool,
}

impl<'a> Any<'a> {
    #[inline(always)]
    pub(super) fn new(ray: &ClampedRay, alpha_mask: &'a AlphaMask) -> Any<'a> {
        Any { alpha_mask, shear: RayShear::new(ray.origin, ray.direction), t_max: ray.t_max, hit: false }
    }
}

impl Visitor for Any<'_> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        self.hit = self.shear.hit(triangle, self.t_max).is_some_and(|hit| self.alpha_mask.has(triangle, &hit));
        !self.hit
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        self.t_max
    }
}

/// Searches for a triangle that blocks one short segment.
pub(super) struct Short<'a> {
    alpha_mask: &'a AlphaMask,
    test: &'a ShortTest,
    direction: Vec3,
    pub(super) blocked: bool,
}

impl<'a> Short<'a> {
    #[inline(always)]
    pub(super) fn new(segments: &'a ShortSegments, direction: Vec3) -> Short<'a> {
        Short { alpha_mask: segments.alpha_mask, test: &segments.test, direction, blocked: false }
    }
}

impl Visitor for Short<'_> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        let occluder = self.test.occluder(triangle.corners());
        self.blocked = occluder.is_some_and(|occluder| occluder.blocks(self.direction))
            && self.alpha_mask.stops(triangle, self.test.origin, self.direction);
        !self.blocked
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        1.0
    }
}
