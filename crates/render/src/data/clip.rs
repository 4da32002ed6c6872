//! The depths that a camera sees.
//!
//! Depths are distances along the view direction. A camera sees what lies between two planes that are perpendicular to it: its rays begin at
//! the near plane and end at the far one, also those that surfaces let through. Rays that mirrors reflect see everything, and so do shadow rays
//! and those that gather light. Hits count from the ray's own origin, as if nothing were cut away. Twin: `clip.cuh`.

use glam::Vec3;
use lightmesh_trace::accel::{Hit, Ray};

/// The planes between which a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// Where depths are 0.
    pub(crate) origin: Vec3,
    /// The view direction; unit length.
    pub(crate) axis: Vec3,
    /// The depth of the first plane.
    pub(crate) near: f32,
    /// The depth of the other one.
    pub(crate) far: f32,
}

/// The part of a ray on which surfaces are seen, in units of its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    pub(crate) start: f32,
    pub(crate) end: f32,
}

impl Default for Clip {
    /// All depths.
    fn default() -> Clip {
        Clip { origin: Vec3::ZERO, axis: Vec3::ZERO, near: 0.0, far: f32::INFINITY }
    }
}

impl Clip {
    /// Whether some depths are not seen.
    #[inline(always)]
    pub(crate) fn cuts(&self) -> bool {
        self.near > 0.0 || self.far < f32::INFINITY
    }

    /// The limits of a ray with a direction of unit length.
    #[inline(always)]
    pub(crate) fn limits(&self, ray: &Ray) -> Limits {
        let cosine = if self.cuts() { ray.direction.dot(self.axis) } else { 0.0 };
        // What is bent so far by glass that it comes back is not limited.
        if cosine > 0.0 {
            let depth = (ray.origin - self.origin).dot(self.axis);
            Limits { start: ((self.near - depth) / cosine).max(0.0), end: ((self.far - depth) / cosine).max(0.0) }
        } else {
            Limits::NONE
        }
    }
}

impl Limits {
    /// All of the ray.
    pub(crate) const NONE: Limits = Limits { start: 0.0, end: f32::INFINITY };

    /// The ray between its limits.
    #[inline(always)]
    pub(crate) fn between(&self, ray: &Ray) -> Ray {
        let Ray { origin, direction, .. } = *ray;
        let origin = if self.start > 0.0 { origin + self.start * direction } else { origin };
        Ray { origin, direction, t_max: self.end - self.start }
    }

    /// What that hits, as a hit of the ray itself.
    #[inline(always)]
    #[allow(clippy::wrong_self_convention, reason = "the hit counts from the ray's origin; the twin's name")]
    pub(crate) fn from_origin(&self, hit: Hit) -> Hit {
        Hit { t: hit.t + self.start, ..hit }
    }
}
