//! What is done with the triangles that a walk reaches; the same for every structure.

use glam::Vec3;

use super::approach::NearRay;
use super::triangle::RayShear;
use super::{Hit, ShortTest, Triangle};

/// Tests triangles and says how far it is still worth walking.
pub(crate) trait Visitor {
    /// Tests a triangle; false ends the walk.
    fn triangle(&mut self, triangle: &Triangle) -> bool;

    /// What lies at a larger ray parameter need not be tested.
    fn limit(&self) -> f32;
}

/// Searches for the closest hit.
pub(super) struct Closest {
    shear: RayShear,
    t_max: f32,
    limit: f32,
    pub(super) best: Hit,
}

impl Closest {
    #[inline(always)]
    pub(super) fn new(ray: &NearRay) -> Closest {
        let shear = RayShear::new(ray.origin, ray.direction);
        Closest { shear, t_max: ray.t_max, limit: ray.t_max, best: Hit::MISS }
    }

    /// Continues with a known hit.
    #[inline(always)]
    pub(super) fn from(ray: &NearRay, best: Hit) -> Closest {
        Closest { best, limit: ray.t_max.min(best.t), ..Closest::new(ray) }
    }
}

impl Visitor for Closest {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        if let Some(hit) = self.shear.hit(triangle, self.t_max)
            && hit.beats(&self.best)
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

/// Searches for any hit.
pub(super) struct Any {
    shear: RayShear,
    t_max: f32,
    pub(super) hit: bool,
}

impl Any {
    #[inline(always)]
    pub(super) fn new(ray: &NearRay) -> Any {
        Any { shear: RayShear::new(ray.origin, ray.direction), t_max: ray.t_max, hit: false }
    }
}

impl Visitor for Any {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        self.hit = self.shear.hit(triangle, self.t_max).is_some();
        !self.hit
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        self.t_max
    }
}

/// Searches for a triangle that blocks one short segment.
pub(super) struct Short<'a> {
    test: &'a ShortTest,
    direction: Vec3,
    pub(super) blocked: bool,
}

impl<'a> Short<'a> {
    #[inline(always)]
    pub(super) fn new(test: &'a ShortTest, direction: Vec3) -> Short<'a> {
        Short { test, direction, blocked: false }
    }
}

impl Visitor for Short<'_> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        let occluder = self.test.occluder(triangle.corners());
        self.blocked = occluder.is_some_and(|occluder| occluder.blocks(self.direction));
        !self.blocked
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        1.0
    }
}
