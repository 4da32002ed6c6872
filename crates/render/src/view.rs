//! The mapping from pixels to rays.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use glam::Vec3;
use lightmesh_layout::constants::{OUTSIDE, OUTSIDE_BITS};
use lightmesh_layout::geometry as layout;
use lightmesh_scene::{Camera, Projection};
use lightmesh_trace::accel::Ray;
use lightmesh_trace::simd::{Axes, LANES, dot, scaled, splat, sum};

use crate::data::clip::Clip;

/// A rectangle of an image's pixels.
///
/// Pixels are indexed within it, y · width + x. What is random is keyed by their numbers in the image, so that it does not depend on the
/// window. It may extend beyond the image: pixels of the image do not depend on those that do not belong to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Column and row of its first pixel in the image; negative to the left of it and above.
    pub first: [i32; 2],
    /// Width and height of the image.
    pub whole: [u32; 2],
}

impl Window {
    /// A whole image.
    pub fn all(size: [u32; 2]) -> Window {
        Window { size, first: [0; 2], whole: size }
    }

    /// With `margin` pixels more on each side: of a part of the image, as far as the image goes.
    pub fn grown(&self, margin: u32) -> Window {
        let leaves = self.leaves_image();
        let side = |axis: usize| {
            let first = i64::from(self.first[axis]) - i64::from(margin);
            let end = i64::from(self.first[axis]) + i64::from(self.size[axis]) + i64::from(margin);
            let (first, end) = if leaves { (first, end) } else { (first.max(0), end.min(self.whole[axis].into())) };
            (first as i32, (end - first) as u32)
        };
        let [(x, width), (y, height)] = [side(0), side(1)];
        Window { size: [width, height], first: [x, y], ..*self }
    }

    /// Column and row in the image of the pixel with this index; negative to the left of it and above.
    #[inline(always)]
    pub(crate) fn place(&self, index: u32) -> [i32; 2] {
        let width = self.size[0];
        [(index % width) as i32 + self.first[0], (index / width) as i32 + self.first[1]]
    }

    /// Whether a place is in the image.
    #[inline(always)]
    fn is_in_image(&self, [x, y]: [i32; 2]) -> bool {
        (x as u32) < self.whole[0] && (y as u32) < self.whole[1]
    }

    /// Whether some of its pixels are not.
    pub(crate) fn leaves_image(&self) -> bool {
        let last = [0, 1].map(|axis| self.first[axis] + self.size[axis] as i32 - 1);
        !(self.is_in_image(self.first) && self.is_in_image(last))
    }

    /// Whether a pixel is in the image and another one is not: the first does not depend on it.
    #[inline(always)]
    pub(crate) fn is_beyond(&self, index: u32, other: u32) -> bool {
        self.is_in_image(self.place(index)) && !self.is_in_image(self.place(other))
    }

    /// The number in the image of the pixel with this index. Outside of the image, rows have 65536 numbers, far from those of the image: pixels
    /// that share one are far apart.
    #[inline(always)]
    pub fn number(&self, index: u32) -> u32 {
        let Window { size, first, whole } = *self;
        // All of an image. Given points have none.
        if first == [0; 2] && size[0] == whole[0] && size[1] <= whole[1] {
            return index;
        }
        let [x, y] = self.place(index);
        if self.is_in_image([x, y]) {
            return y as u32 * whole[0] + x as u32;
        }
        OUTSIDE.wrapping_add((y as u32) << OUTSIDE_BITS).wrapping_add(x as u32)
    }
}

/// A camera and an image size, ready to generate rays.
///
/// A pixel's ray goes through its centre, pixels are square, row 0 is the top.
#[derive(Clone, Copy, Debug)]
pub struct View {
    window: Window,
    origin: Vec3,
    /// From there to the middle of the plane one unit away (perspective), or the direction of all rays.
    forward: Vec3,
    /// From one pixel's centre to the next one on the right, on the plane one unit away (perspective) or in scene units.
    right: Vec3,
    /// The same downwards.
    down: Vec3,
    perspective: bool,
    clip: Clip,
}

impl View {
    /// The view of `camera` in an image of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2]) -> View {
        let (right, up, axis) = camera.basis();
        let [width, height] = size.map(|pixels| pixels as f32);
        let (origin, forward) = camera.middle(width / height);
        let (perspective, picture_height) = match camera.projection {
            Projection::Perspective(fov) => (true, fov.height(width / height)),
            Projection::Orthographic { height } => (false, height),
        };
        let pixel = picture_height / height;
        let window = Window::all(size);
        let clip = Clip { origin, axis, near: camera.near, far: camera.far };
        View { window, origin, forward, right: pixel * right, down: -pixel * up, perspective, clip }
    }

    /// The same camera for the pixels of a window alone.
    pub fn with_window(self, window: Window) -> View {
        View { window, ..self }
    }

    /// The pixels that are rendered.
    pub fn window(&self) -> Window {
        self.window
    }

    /// Width and height of the window in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.window.size
    }

    /// The distance between the surface points of neighbouring pixels that face the camera: a constant, and a multiple of the distance.
    pub fn spacing(&self) -> [f32; 2] {
        let pixel = self.right.length();
        if self.perspective { [0.0, pixel] } else { [pixel, 0.0] }
    }

    /// Where the camera is; the middle of an orthographic image.
    pub(crate) fn origin(&self) -> Vec3 {
        self.origin
    }

    /// The depths that are seen.
    pub(crate) fn clip(&self) -> Clip {
        self.clip
    }

    /// The view as a record for kernels.
    pub(crate) fn record(&self) -> layout::View {
        layout::View {
            origin: layout::Vec3::from(self.origin.to_array()),
            forward: layout::Vec3::from(self.forward.to_array()),
            right: layout::Vec3::from(self.right.to_array()),
            down: layout::Vec3::from(self.down.to_array()),
            axis: layout::Vec3::from(self.clip.axis.to_array()),
            size: self.window.size,
            first: self.window.first,
            whole: self.window.whole,
            near: self.clip.near,
            far: self.clip.far,
            clips: u32::from(self.clip.cuts()),
            perspective: u32::from(self.perspective),
            spare: 0,
        }
    }

    /// The ray through the centre of pixel `index` = y · width + x of the window; its direction has unit length.
    #[inline(always)]
    pub fn ray(&self, index: u32) -> Ray {
        let [x, y] = self.center(index);
        self.ray_towards(x, y)
    }

    /// The ray through the point of pixel `index` that is `aside` from its centre, in pixels.
    #[inline(always)]
    pub(crate) fn ray_beside(&self, index: u32, aside: [f32; 2]) -> Ray {
        let [x, y] = self.center(index);
        self.ray_towards(x + aside[0], y + aside[1])
    }

    /// The centre of a pixel, in pixels from that of the image: to the right and down.
    #[inline(always)]
    fn center(&self, index: u32) -> [f32; 2] {
        let ([x, y], [width, height]) = (self.window.place(index), self.window.whole);
        [x as f32 + 0.5 - 0.5 * width as f32, y as f32 + 0.5 - 0.5 * height as f32]
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

    /// The rays through points of pixel `index` that are `aside` from its centre, in pixels; the same bits as [`View::ray_beside`].
    #[inline(always)]
    pub(crate) fn rays_beside<S: Simd>(&self, simd: S, index: u32, aside: [f32x8<S>; 2]) -> [Ray; LANES] {
        let [x, y] = self.center(index);
        let (x, y) = (f32x8::splat(simd, x) + aside[0], f32x8::splat(simd, y) + aside[1]);
        let aside = sum(scaled(x, splat(simd, self.right)), scaled(y, splat(simd, self.down)));
        let (origin, direction) = if self.perspective {
            let direction = sum(splat(simd, self.forward), aside);
            let length = dot(direction, direction).sqrt();
            (splat(simd, self.origin), [direction[0] / length, direction[1] / length, direction[2] / length])
        } else {
            (sum(splat(simd, self.origin), aside), splat(simd, self.forward))
        };
        let (origin, direction) = (lanes_of(origin), lanes_of(direction));
        std::array::from_fn(|lane| {
            let of = |axes: &[[f32; LANES]; 3]| Vec3::new(axes[0][lane], axes[1][lane], axes[2][lane]);
            Ray { origin: of(&origin), direction: of(&direction), t_max: f32::INFINITY }
        })
    }
}

#[inline(always)]
fn lanes_of<S: Simd>([x, y, z]: Axes<S>) -> [[f32; LANES]; 3] {
    [x.into(), y.into(), z.into()]
}
