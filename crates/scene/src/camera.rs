//! Cameras: where the picture is taken from.

use glam::Vec3;

/// The angle a perspective camera sees. The other angle follows from the picture's shape, because pixels are square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fov {
    /// Full vertical angle, degrees.
    Vertical(f32),
    /// Full horizontal angle, degrees.
    Horizontal(f32),
}

impl Fov {
    /// The vertical angle in degrees in a picture that is `aspect` (width / height) times as wide as high.
    pub fn vertical(self, aspect: f32) -> f32 {
        match self {
            Fov::Vertical(degrees) => degrees,
            Fov::Horizontal(degrees) => 2.0 * ((0.5 * degrees.to_radians()).tan() / aspect).atan().to_degrees(),
        }
    }
}

/// How a camera maps directions or points to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays leave the camera's position.
    Perspective(Fov),
    /// All rays are parallel to the view direction.
    Orthographic {
        /// Height of the picture in scene units.
        height: f32,
    },
}

/// A camera in the scene's local frame (see [`Scene::origin`](crate::Scene::origin)).
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name in the file; empty where it has none.
    pub name: String,
    /// The eye, local frame, scene units.
    pub position: Vec3,
    /// The view direction; unit length.
    pub direction: Vec3,
    /// Which way is up; unit length, not parallel to `direction`, not necessarily at a right angle to it.
    pub up: Vec3,
    /// Perspective or orthographic.
    pub projection: Projection,
}

impl Camera {
    /// The camera's axes: right, up and forward, orthonormal. Forward is the view direction.
    pub fn basis(&self) -> (Vec3, Vec3, Vec3) {
        let forward = self.direction.normalize();
        let right = forward.cross(self.up).normalize();
        (right, right.cross(forward), forward)
    }
}
