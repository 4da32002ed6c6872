//! Shadow rays from the object points themselves: what the light mesh is held against, and what it falls back on.
//!
//! In: rays and hits. Out: [`Visibility`]. Hard-shadow ray tracing casts one ray to the middle of each light; area mode casts
//! many, to points spread over it.

pub(crate) mod cpu;
pub(crate) mod cuda;
#[cfg(test)]
mod tests;

use glam::Vec3;
use lightmesh_layout::constants::HORIZON_SAMPLES;
use lightmesh_scene::{Light, LightKind};

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

/// χ of formula (3) for a light: 1 where it is on the outer side of the surface at `point`, 0 where it is behind.
///
/// A light with a size may stand across the horizon. Then χ is the share of it above, and bounds the visibility: light points
/// higher up see more of the light than the surface can.
#[inline(always)]
pub(crate) fn above_horizon(point: &SurfacePoint, light: &Light, reach: f32) -> f32 {
    let height = point.normal.dot(light_center(light, point.origin, reach) - point.origin);
    if height.abs() >= size(light) {
        return if height > 0.0 { 1.0 } else { 0.0 };
    }
    let pattern = Pattern::new(0, 0, 0);
    let above = (0..HORIZON_SAMPLES)
        .map(|index| light_point(light, point.origin, reach, pattern.point(index)))
        .filter(|target| point.normal.dot(target - point.origin) > 0.0)
        .count();
    above as f32 / HORIZON_SAMPLES as f32
}

/// The farthest that any point of `light` lies from its middle; 0 for all that have no size.
#[inline(always)]
pub(crate) fn size(light: &Light) -> f32 {
    match light.kind {
        LightKind::Sphere { radius, .. } | LightKind::Disk { radius, .. } => radius,
        LightKind::Rectangle { half_u, half_v, .. } => (half_u.length_squared() + half_v.length_squared()).sqrt(),
        LightKind::Point { .. } | LightKind::Directional { .. } | LightKind::Spot { .. } => 0.0,
    }
}
