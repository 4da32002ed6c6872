//! The mapping from pixels to rays.

use glam::Vec3;
use lightmesh_layout::geometry as layout;
use lightmesh_scene::{Camera, Projection};

use crate::accel::Ray;

/// A camera and an image size, ready to generate rays.
///
/// A pixel's ray goes through its centre, pixels are square, row 0 is the top.
#[derive(Clone, Copy, Debug)]
pub struct View {
    size: [u32; 2],
    origin: Vec3,
    forward: Vec3,
    /// From one pixel's centre to the next one on the right, on the plane one unit away (perspective) or in scene units.
    right: Vec3,
    /// The same downwards.
    down: Vec3,
    perspective: bool,
}

impl View {
    /// The view of `camera` in an image of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2]) -> View {
        let (right, up, forward) = camera.basis();
        let [width, height] = size.map(|pixels| pixels as f32);
        let (perspective, picture_height) = match camera.projection {
            Projection::Perspective(fov) => (true, 2.0 * (0.5 * fov.vertical(width / height).to_radians()).tan()),
            Projection::Orthographic { height } => (false, height),
        };
        let pixel = picture_height / height;
        View { size, origin: camera.position, forward, right: pixel * right, down: -pixel * up, perspective }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The distance between the surface points of neighbouring pixels that face the camera: a constant, and a multiple of the distance.
    pub(crate) fn spacing(&self) -> [f32; 2] {
        let pixel = self.right.length();
        if self.perspective { [0.0, pixel] } else { [pixel, 0.0] }
    }

    /// The view as a record for kernels.
    pub(crate) fn record(&self) -> layout::View {
        layout::View {
            origin: layout::Vec3::from(self.origin.to_array()),
            forward: layout::Vec3::from(self.forward.to_array()),
            right: layout::Vec3::from(self.right.to_array()),
            down: layout::Vec3::from(self.down.to_array()),
            size: self.size,
            perspective: u32::from(self.perspective),
            spare: 0,
        }
    }

    /// The ray through the centre of pixel `index` = y · width + x; its direction has unit length.
    #[inline(always)]
    pub fn ray(&self, index: u32) -> Ray {
        let [width, height] = self.size;
        let x = (index % width) as f32 + 0.5 - 0.5 * width as f32;
        let y = (index / width) as f32 + 0.5 - 0.5 * height as f32;
        self.ray_towards(x, y)
    }

    /// The ray through the point of pixel `index` that is `aside` from its centre, in pixels.
    #[inline(always)]
    pub(crate) fn ray_beside(&self, index: u32, aside: [f32; 2]) -> Ray {
        let [width, height] = self.size;
        let x = (index % width) as f32 + 0.5 - 0.5 * width as f32;
        let y = (index / width) as f32 + 0.5 - 0.5 * height as f32;
        self.ray_towards(x + aside[0], y + aside[1])
    }

    /// The ray `x` pixels to the right and `y` down from the image's centre.
    #[inline(always)]
    fn ray_towards(&self, x: f32, y: f32) -> Ray {
        let aside = x * self.right + y * self.down;
        let (origin, direction) = if self.perspective {
            let direction = self.forward + aside;
            (self.origin, direction / direction.length())
        } else {
            (self.origin + aside, self.forward)
        };
        Ray { origin, direction, t_max: f32::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use lightmesh_scene::Fov;

    use super::*;

    fn camera(projection: Projection) -> Camera {
        Camera::look_to(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 50.0).unwrap().with_projection(projection)
    }

    #[test]
    fn one_pixel_looks_along_the_axis() {
        for projection in [Projection::Perspective(Fov::Vertical(50.0)), Projection::Orthographic { height: 3.0 }] {
            let ray = View::new(&camera(projection), [1, 1]).ray(0);
            assert_eq!((ray.origin, ray.direction), (Vec3::ZERO, Vec3::NEG_Z));
        }
    }

    #[test]
    fn row_zero_is_the_top_and_column_zero_the_left() {
        let view = View::new(&camera(Projection::Perspective(Fov::Vertical(90.0))), [4, 2]);
        let first = view.ray(0).direction;
        assert!(first.x < 0.0 && first.y > 0.0);
        // 90 degrees: the top border is at y = 1, the first row's centre at 1/2, and pixels are square.
        let first = first / -first.z;
        assert!((first - Vec3::new(-1.5, 0.5, -1.0)).length() < 1e-6, "{first}");
        let last = view.ray(7).direction;
        assert!(last.x > 0.0 && last.y < 0.0);
    }

    #[test]
    fn a_horizontal_angle_fixes_the_width() {
        let view = View::new(&camera(Projection::Perspective(Fov::Horizontal(90.0))), [4, 2]);
        let first = view.ray(0).direction;
        assert!((first.x / first.z - 0.75).abs() < 1e-6);
    }

    #[test]
    fn orthographic_rays_are_parallel_and_span_the_height() {
        let view = View::new(&camera(Projection::Orthographic { height: 4.0 }), [2, 2]);
        assert_eq!(view.ray(0).direction, view.ray(3).direction);
        assert_eq!(view.ray(0).origin - view.ray(2).origin, Vec3::new(0.0, 2.0, 0.0));
    }
}
