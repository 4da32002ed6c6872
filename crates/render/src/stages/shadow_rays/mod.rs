//! Shadow rays from the object points themselves: what the light mesh is held against, and what it falls back on.
//!
//! In: rays and hits. Out: [`Visibility`]. Hard-shadow ray tracing casts one ray to the middle of each light; area mode casts
//! many, to points spread over it.

pub(crate) mod cpu;
#[cfg(test)]
mod tests;

use glam::Vec3;
use lightmesh_scene::Light;

use crate::sampling::{Pattern, light_center, light_point};
use crate::surface::SurfacePoint;

/// What each object point sees of each light, with χ: 0 where the light is behind the surface.
#[derive(Clone, Debug, Default)]
pub struct Visibility {
    /// Number of lights.
    pub lights: usize,
    /// Shares in [0, 1], `lights` of them for each ray; 0 for rays that missed.
    pub share: Vec<f32>,
    /// Light points that each ray's object point used; empty where none are used at all.
    pub used: Vec<u32>,
    /// Light that reaches the eye from all lights, by ray, where the stage had to shade sample by sample; empty where
    /// formula (1) with `share` gives it.
    pub direct: Vec<Vec3>,
}

/// χ of formula (3) for a light: whether any part of it is on the outer side of the surface at `point`.
#[inline(always)]
pub(crate) fn faces(point: &SurfacePoint, light: &Light, reach: f32) -> bool {
    let above = |target: Vec3| point.normal.dot(target - point.origin) > 0.0;
    if above(light_center(light, point.origin, reach)) {
        return true;
    }
    // A light with a size may stand out over the horizon; its corners or eight points of it decide.
    light.has_size() && {
        let pattern = Pattern::new(0, 0, 0);
        (0..8).any(|index| above(light_point(light, point.origin, reach, pattern.point(index))))
    }
}
