//! Directions of a scene by azimuth and elevation, and as places on a panorama.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::Up;

/// The direction of the middle of a texel, column and row, of a panorama of this size.
pub(super) fn direction(frame: [Vec3; 3], size: [u32; 2], [column, row]: [u32; 2]) -> Vec3 {
    let [width, height] = size.map(|side| side as f32);
    let azimuth = TAU * ((column as f32 + 0.5) / width - 0.5);
    from_angles(frame, azimuth, PI * (0.5 - (row as f32 + 0.5) / height))
}

/// The direction with this azimuth, clockwise from north, and elevation, both in radians.
pub fn from_angles([east, up, north]: [Vec3; 3], azimuth: f32, elevation: f32) -> Vec3 {
    elevation.cos() * (azimuth.sin() * east + azimuth.cos() * north) + elevation.sin() * up
}

/// East, up and north of a scene.
pub(super) fn frame(up: Up) -> [Vec3; 3] {
    match up {
        Up::Y => [Vec3::X, Vec3::Y, Vec3::NEG_Z],
        Up::Z => [Vec3::X, Vec3::Z, Vec3::Y],
    }
}
