//! Lights as they are written.

use glam::Vec3;

use crate::{Light, Scene};

/// The lights that are written: all but those of lamps, which are made again from their surfaces.
pub(super) fn own_lights(scene: &Scene) -> impl Iterator<Item = &Light> {
    scene.lights.iter().filter(|light| !light.lamp)
}

/// The second half side of a rectangle, turned so that u × v is the side to which it shines.
pub(super) fn toward_surface(light: &Light, half_u: Vec3, half_v: Vec3) -> Vec3 {
    let is_turned = light.surface.is_some_and(|normal| half_u.cross(half_v).dot(normal) < 0.0);
    if is_turned { -half_v } else { half_v }
}
