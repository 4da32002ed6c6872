//! Rays by which scenes are judged: all over an image, and all around a point.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use crate::{Camera, Fov, Projection};

/// Rays per axis of an image.
const RAYS: usize = 16;
/// Number of directions around a point.
pub(super) const AROUND: usize = 96;

/// Directions all around, evenly spread on a spiral.
pub(super) fn directions() -> [Vec3; AROUND] {
    let golden = PI * (3.0 - 5.0f32.sqrt());
    std::array::from_fn(|index| {
        let height = 1.0 - (2 * index + 1) as f32 / AROUND as f32;
        let (sin, cos) = (golden * index as f32).sin_cos();
        let radius = (1.0 - height * height).sqrt();
        Vec3::new(radius * cos, height, radius * sin)
    })
}

/// Origins and unit directions of some rays all over a square image.
pub(super) fn sparse_rays(camera: &Camera) -> Vec<[Vec3; 2]> {
    let (right, up, forward) = camera.basis();
    let at = |number: usize| (2 * number + 1) as f32 / RAYS as f32 - 1.0;
    let ray = |number: usize| {
        // Half the image is a unit.
        let place = Vec2::new(at(number % RAYS), at(number / RAYS)) + 2.0 * camera.shift;
        let aside = place.x * right + place.y * up;
        match camera.projection {
            Projection::Perspective(fov) => [camera.position, (forward + tangent(fov) * aside).normalize()],
            Projection::Orthographic { height } => [camera.position + 0.5 * height * aside, forward],
        }
    };
    (0..RAYS * RAYS).map(ray).collect()
}

/// Of half the field of view.
fn tangent(fov: Fov) -> f32 {
    (0.5 * fov.vertical(1.0)).to_radians().tan()
}
