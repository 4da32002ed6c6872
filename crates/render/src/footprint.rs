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
use lightmesh_layout::constants::{LEAST_FOOTPRINT_COSINE, LEAST_SMOOTH_SQUARE, LEAST_SQUARE};
use lightmesh_scene::Mesh;

use crate::accel::{Hit, Ray};
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
    pub(crate) fn of_sample(spacing: [f32; 2], samples: u32, breadth: f32) -> Cone {
        let share = breadth / (samples as f32).sqrt();
        Cone { width: share * spacing[0], spread: share * spacing[1] }
    }

    /// Whether textures are looked up at points.
    #[inline(always)]
    pub(crate) fn is_point(&self) -> bool {
        self.width == 0.0 && self.spread == 0.0
    }

    /// The cone after `distance`: behind a focus it widens again.
    #[inline(always)]
    pub(crate) fn after(&self, distance: f32) -> Cone {
        let width = self.width + self.spread * distance;
        if width < 0.0 { Cone { width: -width, spread: -self.spread } } else { Cone { width, ..*self } }
    }

    /// The cone that a mirror reflects, with the mean curvature of its normals, from where this one has its width.
    #[inline(always)]
    pub(crate) fn reflected(&self, curvature: f32) -> Cone {
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
        (square > LEAST_SQUARE).then(|| Gradients {
            u: ac.cross(normal) / square,
            v: normal.cross(ab) / square,
            normal: normal / square.sqrt(),
        })
    }
}

/// The axes of the ellipse in which a cone around `direction` meets a triangle where it is `width` wide, in texture coordinates: conjugate
/// diameters of the ellipse there. `uvs` are those of the corners. Zero where there is no telling: on needles.
#[inline(always)]
pub(crate) fn axes(direction: Vec3, width: f32, corners: [Vec3; 3], uvs: [Vec2; 3]) -> [Vec2; 2] {
    let Some(gradients) = Gradients::of(corners) else { return [Vec2::ZERO; 2] };
    let normal = gradients.normal;

    // 1. The ellipse along the surface.
    let cosine = normal.dot(direction);
    let along = direction - cosine * normal;
    let square = along.length_squared();
    // Seen from straight above it is a circle, which has no axes of its own.
    let along = if square > LEAST_SMOOTH_SQUARE {
        along / square.sqrt()
    } else {
        let edge = corners[1] - corners[0];
        edge / edge.length()
    };
    let across = width * normal.cross(along);
    let along = (width / cosine.abs().max(LEAST_FOOTPRINT_COSINE)) * along;

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
pub(crate) fn curvature(mesh: &Mesh, hit: &Hit, corners: [Vec3; 3], facing: Vec3) -> f32 {
    let Some(smooth) = smooth_at(mesh, hit) else { return 0.0 };
    let [a, b, c] = smooth.corners;
    let Some(gradients) = Gradients::of(corners) else { return 0.0 };
    let divergence = (gradients.u.dot(b - a) + gradients.v.dot(c - a)) / smooth.square.sqrt();
    let curvature = if smooth.normal.dot(facing) < 0.0 { -0.5 * divergence } else { 0.5 * divergence };
    if curvature.is_finite() { curvature } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Vec3; 3] = [Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 0.0, -4.0)];
    const UVS: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];

    /// The lengths of the axes, the longer one first.
    fn lengths(direction: Vec3, width: f32) -> [f32; 2] {
        let [a, b] = axes(direction, width, CORNERS, UVS).map(Vec2::length);
        [a.max(b), a.min(b)]
    }

    #[test]
    fn from_above_a_circle_is_seen_and_stretched_as_the_texture_is() {
        // u is as long as 2, v as 4.
        assert_eq!(axes(Vec3::NEG_Y, 0.5, CORNERS, UVS), [Vec2::new(0.25, 0.0), Vec2::new(0.0, 0.125)]);
        assert_eq!(axes(Vec3::Y, 0.5, CORNERS, UVS)[0], Vec2::new(0.25, 0.0), "from below, too");
    }

    #[test]
    fn a_slanted_view_stretches_the_ellipse_along_itself() {
        // At 30 degrees above the floor, along u: 1 / sin 30°.
        let direction = Vec3::new(0.75f32.sqrt(), -0.5, 0.0);
        let [along, across] = axes(direction, 0.5, CORNERS, UVS);
        assert!((along - Vec2::new(0.5, 0.0)).length() < 1e-6, "{along}");
        assert!((across.abs() - Vec2::new(0.0, 0.125)).length() < 1e-6, "{across}");
        // Along the surface, the ellipse is as long as can be counted.
        let [long, _] = lengths(Vec3::X, 0.5);
        assert!((long - 0.25 / LEAST_FOOTPRINT_COSINE).abs() < 1e-3 * long, "{long}");
    }

    #[test]
    fn needles_and_textures_without_area_have_what_can_be_told() {
        let needle = [Vec3::ZERO, Vec3::X, 2.0 * Vec3::X];
        assert_eq!(axes(Vec3::NEG_Y, 0.5, needle, UVS), [Vec2::ZERO; 2]);
        assert_eq!(axes(Vec3::NEG_Y, 0.5, CORNERS, [Vec2::ONE; 3]), [Vec2::ZERO; 2]);
        let line = axes(Vec3::NEG_Y, 0.5, CORNERS, [Vec2::ZERO, Vec2::X, Vec2::ZERO]);
        assert_eq!(line, [Vec2::new(0.25, 0.0), Vec2::ZERO]);
        let endless = [Vec2::ZERO, Vec2::new(f32::INFINITY, 0.0), Vec2::ZERO];
        assert_eq!(axes(Vec3::NEG_Y, 0.5, CORNERS, endless), [Vec2::ZERO; 2]);
        assert!(axes(Vec3::NAN, 0.5, CORNERS, UVS).iter().all(|axis| axis.is_finite()));
    }

    #[test]
    fn samples_share_the_area_of_their_pixel() {
        assert_eq!(Cone::of_sample([0.0, 0.5], 4, 1.0), Cone { width: 0.0, spread: 0.25 });
        assert_eq!(Cone::of_sample([3.0, 0.0], 9, 2.0), Cone { width: 2.0, spread: 0.0 });
    }

    #[test]
    fn cones_grow_and_have_a_focus() {
        let cone = Cone { width: 1.0, spread: -0.25 };
        assert_eq!(cone.after(2.0), Cone { width: 0.5, spread: -0.25 });
        assert_eq!(cone.after(6.0), Cone { width: 0.5, spread: 0.25 });
        assert!(Cone::default().after(7.0).reflected(3.0).is_point());
    }

    /// A triangle on a ball around the origin, with its normals.
    fn ball(radius: f32, inside: bool) -> (Mesh, [Vec3; 3]) {
        let ways = [Vec3::new(-0.01, 0.0, 1.0), Vec3::new(0.02, -0.01, 1.0), Vec3::new(0.0, 0.02, 1.0)];
        let corners = ways.map(|way| radius * way.normalize());
        let normals = ways.map(|way| if inside { -way.normalize() } else { way.normalize() }).to_vec();
        (Mesh { normals, triangles: vec![[0, 1, 2]], positions: corners.to_vec(), ..Mesh::default() }, corners)
    }

    #[test]
    fn a_ball_has_the_curvature_of_its_radius() {
        let hit = Hit { t: 1.0, u: 0.3, v: 0.3, triangle: 0 };
        let (mesh, corners) = ball(4.0, false);
        assert!((curvature(&mesh, &hit, corners, Vec3::Z) - 0.25).abs() < 1e-3, "from outside");
        assert!((curvature(&mesh, &hit, corners, Vec3::NEG_Z) + 0.25).abs() < 1e-3, "from inside");
        let (mesh, corners) = ball(4.0, true);
        assert!((curvature(&mesh, &hit, corners, Vec3::NEG_Z) + 0.25).abs() < 1e-3, "with normals to the inside");
        let mut flat = mesh.clone();
        flat.normals = vec![Vec3::Z; 3];
        assert_eq!(curvature(&flat, &hit, corners, Vec3::Z), 0.0);
        flat.normals[1] = Vec3::ZERO;
        assert_eq!(curvature(&flat, &hit, corners, Vec3::Z), 0.0);
        flat.normals.clear();
        assert_eq!(curvature(&flat, &hit, corners, Vec3::Z), 0.0);
    }

    #[test]
    fn a_ball_spreads_what_it_reflects_as_a_mirror_formula_says() {
        // A convex mirror of radius R has its focus R / 2 behind it: parallel rays seem to come from there.
        let cone = Cone { width: 0.1, spread: 0.0 }.reflected(0.25);
        assert!((cone.after(2.0).width - 0.2).abs() < 1e-6, "twice as wide at the distance of the focus");
        // A concave one focuses there.
        assert!(Cone { width: 0.1, spread: 0.0 }.reflected(-0.25).after(2.0).width.abs() < 1e-6);
    }
}
