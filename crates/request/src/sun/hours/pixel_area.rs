//! The area of the surface that a pixel shows.

use glam::Vec3;
use lightmesh_scene::{Camera, Projection};

/// Surfaces that are seen from the side show more than can be told from the middle of a pixel: smaller cosines count as this.
const MIN_COSINE: f32 = 0.02;

/// The pixels of an image of some size.
pub(super) struct PixelGrid {
    /// The camera's axes.
    right: Vec3,
    up: Vec3,
    /// To the middle of the image, one unit before the camera.
    forward: Vec3,
    /// From one pixel to the next, one unit before the camera or anywhere.
    pitch: f32,
    is_perspective: bool,
    /// Column and row of the middle of the image.
    middle: [f32; 2],
}

impl PixelGrid {
    pub(super) fn new(camera: &Camera, [width, height]: [u32; 2]) -> PixelGrid {
        let (right, up, _) = camera.basis();
        let [width, height] = [width, height].map(|side| side as f32);
        let (_, forward) = camera.middle(width / height);
        let (whole, is_perspective) = match camera.projection {
            Projection::Perspective(fov) => (fov.height(width / height), true),
            Projection::Orthographic { height } => (height, false),
        };
        let middle = [0.5 * width - 0.5, 0.5 * height - 0.5];
        PixelGrid { right, up, forward, pitch: whole / height, is_perspective, middle }
    }

    /// The side of a pixel at some distance, across the view.
    pub(super) fn side(&self, depth: f32) -> f32 {
        if self.is_perspective { self.pitch * depth } else { self.pitch }
    }

    /// The area of a surface with this `normal` at this `depth` along the ray of the pixel in this column and row of the image: the square of
    /// the distance times the solid angle of the pixel, or its area if rays are parallel, over the cosine.
    pub(super) fn area(&self, [column, row]: [i32; 2], depth: f32, normal: Vec3) -> f32 {
        let across = self.pitch * self.pitch;
        if !self.is_perspective {
            return across / normal.dot(self.forward).abs().max(MIN_COSINE);
        }
        let [x, y] = [column as f32 - self.middle[0], self.middle[1] - row as f32];
        let way = self.forward + self.pitch * (x * self.right + y * self.up);
        let length = way.length();
        let solid_angle = across / (length * length * length);
        depth * depth * solid_angle / (normal.dot(way).abs() / length).max(MIN_COSINE)
    }
}
