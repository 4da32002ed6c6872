//! The course of a flight, and what all of its frames have in common.

use lightmesh::Settings;
use lightmesh::glam::Quat;
use lightmesh::render::PreparedScene;
use lightmesh::scene::Camera;

use crate::suites::subjects::Subject;
use crate::{Key, Plan};

/// Pixels along the width, and in the short version; the height is three quarters of it.
const WIDTHS: [u32; 2] = [640, 192];
/// Frames: ten seconds, and in the short version.
const FRAMES: [u32; 2] = [240, 24];
/// How far the camera goes from frame to frame, relative to the scene's diagonal.
const WAY: f32 = 1.0 / 2400.0;
/// How far it turns, in degrees.
const TURN: f32 = 0.1;

/// Frames of a flight.
pub(super) fn frames(plan: &Plan) -> u32 {
    plan.frames.unwrap_or(FRAMES[usize::from(plan.quick)]).max(2)
}

/// What all frames have in common.
pub(super) fn settings(plan: &Plan) -> Settings {
    let width = plan.side_or(WIDTHS);
    Settings::default().with_size([width, (3 * width / 4).max(1)]).with_aa(1).with_layers(true)
}

/// The keys of its rows.
pub(super) fn keys(plan: &Plan, subject: &Subject, scene: &PreparedScene) -> Vec<(&'static str, Key)> {
    vec![
        ("scene", subject.name.as_str().into()),
        ("size", f64::from(plan.side_or(WIDTHS)).into()),
        ("frames", f64::from(frames(plan)).into()),
        ("accel", scene.geometry.accelerator.name().into()),
    ]
}

/// The first frames of some pairs, all along the way.
pub(super) fn pairs(frames: u32, wanted: u32) -> Vec<u32> {
    let pairs = wanted.min(frames - 1);
    (0..pairs).map(|pair| (2 * pair + 1) * (frames - 1) / (2 * pairs)).collect()
}

/// Where the camera is in a frame: ahead at constant height, turned to its left.
pub(super) fn camera(scene: &PreparedScene, number: u32) -> Camera {
    let mut camera = scene.scene.cameras[0].clone();
    let (along, up) = (number as f32, camera.up.normalize());
    let ahead = (camera.direction - camera.direction.dot(up) * up).normalize_or_zero();
    let position = camera.position + along * WAY * scene.geometry.bounds.diagonal() * ahead;
    camera.direction = Quat::from_axis_angle(up, (along * TURN).to_radians()) * camera.direction;
    camera.with_position(position)
}

/// The mean, if there are values.
pub(super) fn mean(values: impl Iterator<Item = f64> + Clone) -> Option<f64> {
    let count = values.clone().count();
    (count > 0).then(|| values.sum::<f64>() / count as f64)
}
