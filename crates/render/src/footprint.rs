//! Footprints: what part of a surface a sample of a pixel sees. Twin: `footprint.cuh`.
//!
//! A *cone* is around a ray: it has a width where the ray begins, and grows by a multiple of the distance (Akenine-Möller, Crassin, Boksansky,
//! Belcour, Panteleev, Wright: *Improved Shader and Texture Level of Detail Using Ray Cones*, JCGT 10(1), 2021). It meets a surface in an
//! ellipse. For a width w, a direction D and a unit normal n its axes are, along the surface,
//!
//! ```text
//! w / |n·D| along D − (n·D) n        w across        (paper: section 5, anisotropic filtering)
//! ```
//!
//! and the texture coordinates change along them as over the triangle, which is linear: nothing is divided by the triangle's area in the
//! texture, so that it may be zero.
//!
//! A mirror continues the cone. A curved one also spreads it. If normals turn by κ per length, H being the mean of κ in all directions, the
//! rays reflected at both ends of the ellipse are apart by 2 κ w / |n·D| in the plane of reflection and by 2 κ w |n·D| across. The cone
//! stays round, with the same solid angle: it spreads by 2 H w. A concave mirror has a negative H, and focuses.
//!
//! Limitations: the ellipse is that of the plane of the hit triangle, however small that is, and cones stay round.

use glam::{Vec2, Vec3};
use lightmesh_layout::constants::{MIN_FOOTPRINT_COSINE, MIN_SMOOTH_SQUARE, MIN_SQUARE};
use lightmesh_scene::Mesh;
use lightmesh_trace::accel::{Hit, Ray};

use crate::surface::smooth_at;

/// A cone around a ray. Without a width, textures are looked up at points.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Cone {
    /// Its width where the ray begins.
    pub width: f32,
    /// By how much it widens per unit of distance; negative if it narrows.
    pub spread: f32,
}

impl Cone {
    /// The cone of one of `samples` samples of a pixel: its share of the area over which they are spread, a square `breadth` pixels wide.
    /// `spacing` is the distance between the surface points of neighbouring pixels: a constant, and a multiple of their distance.
    pub fn of_sample(spacing: [f32; 2], samples: u32, breadth: f32) -> Cone {
        let share = breadth / (samples as f32).sqrt();
        Cone { width: share * spacing[0], spread: share * spacing[1] }
    }

    /// Whether textures are looked up at points.
    #[inline(always)]
    pub fn is_point(&self) -> bool {
        self.width == 0.0 && self.spread == 0.0
    }

    /// The cone after `distance`: behind a focus it widens again.
    #[inline(always)]
    pub fn after(&self, distance: f32) -> Cone {
        let width = self.width + self.spread * distance;
        if width < 0.0 { Cone { width: -width, spread: -self.spread } } else { Cone { width, ..*self } }
    }

    /// The cone that a mirror reflects, with the mean curvature of its normals, from where this one has its width.
    #[inline(always)]
    pub fn reflected(&self, curvature: f32) -> Cone {
        Cone { spread: self.spread + 2.0 * curvature * self.width, ..*self }
    }
}

/// The changes of the weights of a triangle's second and third corner along the surface: scalar products with a step are the changes for
/// it. `None` for a needle.
struct Gradients {
    u: Vec3,
    v: Vec3,
    /// The unit normal on one side.
    normal: Vec3,
}

impl Gradients {
    #[inline(always)]
    fn of([a, b, c]: [Vec3; 3]) -> Option<Gradients> {
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let square = normal.length_squared();
        (square > MIN_SQUARE).then(|| Gradients {
            u: ac.cross(normal) / square,
            v: normal.cross(ab) / square,
            normal: normal / square.sqrt(),
        })
    }
}

/// The axes of the ellipse in which a cone around `direction` meets a triangle where it is `width` wide, in texture coordinates: conjugate
/// diameters of the ellipse there. `uvs` are those of the corners. Zero where there is no telling: on needles.
#[inline(always)]
pub fn axes(direction: Vec3, width: f32, corners: [Vec3; 3], uvs: [Vec2; 3]) -> [Vec2; 2] {
    let Some(gradients) = Gradients::of(corners) else { return [Vec2::ZERO; 2] };
    let normal = gradients.normal;

    // 1. The ellipse along the surface.
    let cosine = normal.dot(direction);
    let along = direction - cosine * normal;
    let square = along.length_squared();
    // Seen from straight above it is a circle, which has no axes of its own.
    let along = if square > MIN_SMOOTH_SQUARE {
        along / square.sqrt()
    } else {
        let edge = corners[1] - corners[0];
        edge / edge.length()
    };
    let across = width * normal.cross(along);
    let along = (width / cosine.abs().max(MIN_FOOTPRINT_COSINE)) * along;

    // 2. In texture coordinates.
    let change = |step: Vec3| {
        let (u, v) = (gradients.u.dot(step), gradients.v.dot(step));
        u * (uvs[1] - uvs[0]) + v * (uvs[2] - uvs[0])
    };
    let axes = [change(along), change(across)];
    if axes[0].is_finite() && axes[1].is_finite() { axes } else { [Vec2::ZERO; 2] }
}

/// The direction in which a surface point is seen along `ray`, or along the ray of another sample of its pixel: these begin at the same
/// point, or are parallel.
#[inline(always)]
pub(crate) fn direction_to(position: Vec3, ray: &Ray, cone: Cone) -> Vec3 {
    if cone.spread > 0.0 {
        let way = position - ray.origin;
        way / way.length()
    } else {
        ray.direction
    }
}

/// The mean curvature of the normals that shading uses, at a hit: how much they turn per unit of length, averaged over all directions.
/// Positive on the outside of a ball; `facing` is the geometric normal on the viewer's side. It is half of the divergence of the normals.
pub fn curvature(mesh: &Mesh, hit: &Hit, corners: [Vec3; 3], facing: Vec3) -> f32 {
    let Some(smooth) = smooth_at(mesh, hit) else { return 0.0 };
    let [a, b, c] = smooth.corners;
    let Some(gradients) = Gradients::of(corners) else { return 0.0 };
    let divergence = (gradients.u.dot(b - a) + gradients.v.dot(c - a)) / smooth.square.sqrt();
    let curvature = if smooth.normal.dot(facing) < 0.0 { -0.5 * divergence } else { 0.5 * divergence };
    if curvature.is_finite() { curvature } else { 0.0 }
}
