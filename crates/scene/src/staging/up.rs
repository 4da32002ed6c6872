//! The up axis, if the scene does not define it by a camera.

use glam::Vec3;
use serde::Serialize;

use crate::{Scene, Up};

/// The up axis, and what indicates it.
#[derive(Clone, Debug, Serialize, PartialEq, Eq)]
pub struct UpInfo {
    /// y or z.
    pub axis: &'static str,
    /// What indicates it.
    pub reason: String,
}

/// Maximum thickness of a ground, as a share of the scene's height.
const GROUND: f32 = 1e-3;
/// Minimum share of the box's base that a ground covers.
const MIN_GROUND: f32 = 0.01;
/// How much larger it must be than the flat bottom along the other axis.
const CLEARLY: f32 = 2.0;
/// How closely a model that stands at height 0 begins there, and is centred on the other axis, as a share of its size there.
const NEARLY: f64 = 1e-3;

impl Scene {
    /// The up axis according to the scene's cameras, to the ground that it stands on, or to where it lies: at height 0, and centred on
    /// the other axis. `None` if nothing indicates it.
    pub fn suggested_up(&self) -> Option<UpInfo> {
        let by = |up: Up, reason: &str| Some(UpInfo { axis: up.name(), reason: reason.to_owned() });
        let upper: Vec3 = self.cameras.iter().map(|camera| camera.up).sum();
        if !self.cameras.is_empty() && upper.y.abs() != upper.z.abs() {
            return by(if upper.y > upper.z { Up::Y } else { Up::Z }, "its cameras are oriented that way");
        }
        let [y, z] = [Up::Y, Up::Z].map(|up| self.ground(up));
        match (y.max(z) >= MIN_GROUND, y > CLEARLY * z, z > CLEARLY * y) {
            (true, true, _) => by(Up::Y, "it has a flat ground at its lowest y"),
            (true, _, true) => by(Up::Z, "it has a flat ground at its lowest z"),
            _ => match [Up::Y, Up::Z].map(|up| self.starts_at_zero(up)) {
                [true, false] => by(Up::Y, "it begins at y = 0, and is centred on z"),
                [false, true] => by(Up::Z, "it begins at z = 0, and is centred on y"),
                _ => None,
            },
        }
    }

    /// Whether the scene begins at height 0, and is centred on the other axis that may point up.
    fn starts_at_zero(&self, up: Up) -> bool {
        let bounds = self.geometry.mesh.bounds();
        if bounds.is_empty() {
            return false;
        }
        let (min, max) = (self.geometry.to_world(bounds.min), self.geometry.to_world(bounds.max));
        let along = |up: Up| {
            let axis = up.axis().as_dvec3();
            (min.dot(axis), max.dot(axis))
        };
        let other = if up == Up::Y { Up::Z } else { Up::Y };
        let ((low, high), (near, far)) = (along(up), along(other));
        let begins = high > 0.0 && low.abs() <= NEARLY * high;
        begins && far > 0.0 && (near + far).abs() <= NEARLY * far
    }

    /// Area of the triangles at the very bottom, as a share of the box's base.
    fn ground(&self, up: Up) -> f32 {
        let (bounds, axis) = (self.geometry.mesh.bounds(), up.axis());
        let extent = bounds.extent();
        let height = extent.dot(axis);
        let base = extent.x * (extent.y + extent.z - height);
        let top = bounds.min.dot(axis) + GROUND * height;
        if bounds.is_empty() || height <= 0.0 || base <= 0.0 {
            return 0.0;
        }
        let low = |corners: &[Vec3; 3]| corners.iter().all(|corner| corner.dot(axis) <= top);
        let area = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(c - a).length();
        // Shapes in many places are no ground.
        self.geometry
            .mesh
            .own_triangles()
            .map(|index| self.geometry.mesh.corners(index))
            .filter(low)
            .map(area)
            .sum::<f32>()
            / base
    }
}
