//! The first ray from a surface point to a light. Twin: `first.cuh`.

use glam::Vec3;
use lightmesh_layout::constants::{ANSWER_STRADDLES, AROUND, FIRST_TARGETS, NEIGHBORHOOD};
use lightmesh_scene::{Light, LightKind};

use crate::sampling::seen_center;
use crate::shadow::ShadowTarget;
use crate::shadow::projected_light::{Emitter, Shape, disc_of};
use crate::surface::SurfacePoint;

/// Whether no light has a size: then there is one ray to each, and nothing to disagree on.
pub(super) fn all_are_points(target: &ShadowTarget, lights: &[Light]) -> bool {
    lights.iter().all(|light| Shape::of(target, light) == Shape::Point)
}

/// The outermost points that first rays are cast to, as a part of a light's half width. Shadows that hide less than what lies beyond
/// would rarely hide a sample.
pub const RIM: f32 = 0.9;

/// Points of a light that first rays are cast to, for discs, then for rectangles: coordinates in [−1, 1].
pub(super) type Places = [[[f32; 2]; FIRST_TARGETS as usize]; 2];

/// A lattice in the square, and the same mapped to the disc, line by line.
pub fn places() -> Places {
    let [mut discs, mut rectangles] = [[[0.0; 2]; FIRST_TARGETS as usize]; 2];
    for (number, (disc, rectangle)) in (0..).zip(discs.iter_mut().zip(&mut rectangles)) {
        let coordinate = |line: u32| (line as f32 - AROUND as f32) / AROUND as f32;
        let (x, y) = (coordinate(number % NEIGHBORHOOD), coordinate(number / NEIGHBORHOOD));
        *rectangle = [RIM * x, RIM * y];
        *disc = [RIM * x * (1.0 - 0.5 * y * y).sqrt(), RIM * y * (1.0 - 0.5 * x * x).sqrt()];
    }
    [discs, rectangles]
}

/// The place of the ray of a pixel in column `x` and row `y` of the image, or outside of it.
#[inline(always)]
pub fn place_of(place: [i32; 2]) -> u32 {
    let [x, y] = place.map(|place| place.rem_euclid(NEIGHBORHOOD as i32) as u32);
    y * NEIGHBORHOOD + x
}

/// A light as a surface point sees it: its points are at `center + x · u + y · v`.
pub(super) struct Extent {
    shape: Shape,
    center: Vec3,
    u: Vec3,
    v: Vec3,
}

impl Extent {
    /// `reach` is the distance of a directional light.
    #[inline(always)]
    pub(super) fn new(emitter: &Emitter, point: &SurfacePoint, reach: f32) -> Extent {
        let (light, shape) = emitter.light();
        let center = seen_center(light, point.origin, reach) - point.origin;
        let (u, v) = match light.kind {
            LightKind::Rectangle { half_u, half_v, .. } => (half_u, half_v),
            _ => {
                let (tangent, bitangent, radius) = disc_of(light, center, reach);
                (radius * tangent, radius * bitangent)
            }
        };
        Extent { shape, center, u, v }
    }

    /// What is known before any ray: nothing, that the light straddles the horizon, or `None` if all of it is behind the surface.
    #[inline(always)]
    pub(super) fn at_horizon(&self, normal: Vec3) -> Option<u32> {
        let (height, a, b) = (normal.dot(self.center), normal.dot(self.u), normal.dot(self.v));
        let half = if self.shape == Shape::Rectangle { a.abs() + b.abs() } else { (a * a + b * b).sqrt() };
        if height <= -half {
            return None;
        }
        Some(if height < half { ANSWER_STRADDLES } else { 0 })
    }

    /// The point of the light at place number `place`.
    #[inline(always)]
    pub(super) fn target(&self, origin: Vec3, places: &Places, place: u32) -> Vec3 {
        let [x, y] = places[usize::from(self.shape == Shape::Rectangle)][place as usize];
        origin + (self.center + x * self.u + y * self.v)
    }
}
