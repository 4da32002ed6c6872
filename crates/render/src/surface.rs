//! From a hit to the surface point that all further steps start from.

use glam::Vec3;
use lightmesh_layout::constants::{GAMMA_32, MIN_SMOOTH_SQUARE, MIN_SQUARE, MIN_STEEPNESS};
use lightmesh_scene::Mesh;
use lightmesh_trace::accel::{Hit, Ray, Triangle};

/// A surface point P.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfacePoint {
    /// P itself, interpolated from the triangle's corners: more accurate than `origin + t · direction`.
    pub position: Vec3,
    /// Where segments that leave P start: offset from the surface along the normal by a bound on all rounding.
    pub origin: Vec3,
    /// Geometric normal n, unit length, on the viewer's side.
    pub normal: Vec3,
}

/// The unit normal of a tiny triangle, or of one so narrow that single precision sees no area; if double precision sees none
/// either, the direction to the viewer.
#[cold]
#[inline(never)]
fn needle_normal(triangle: &Triangle, ray: &Ray) -> Vec3 {
    let [a, b, c] = triangle.corners();
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
    if normal == Vec3::ZERO { -ray.direction.normalize_or_zero() } else { normal }
}

impl SurfacePoint {
    /// The surface point that `ray` sees at `hit` on `triangle`.
    #[inline(always)]
    pub fn new(ray: &Ray, hit: &Hit, triangle: &Triangle) -> SurfacePoint {
        let [a, b, c] = triangle.corners();
        let position = (1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
        let outward = (b - a).cross(c - a);
        let square = outward.length_squared();
        let outward = if square > MIN_SQUARE { outward / square.sqrt() } else { needle_normal(triangle, ray) };
        let normal = if outward.dot(ray.direction) > 0.0 { -outward } else { outward };

        // The interpolated point errs by γ(7) of the corners (Pharr, Jakob, Humphreys: *Physically Based Rendering*, 3.9). The
        // ray that leaves it meets its own triangle up to 9 ε S off, S being the largest coordinate of the corners relative
        // to the origin, whatever the axis: a floor at height 0 errs by its width. S is at most twice the largest corner
        // coordinate. The sum of the corners, three times a typical one, with γ(32) bounds both with room for the move itself.
        let error = GAMMA_32 * (a.abs() + b.abs() + c.abs()).max_element();
        let origin = position + error * normal;
        SurfacePoint { position, origin, normal }
    }

    /// Where a ray goes on that the surface lets through.
    pub(crate) fn behind(&self) -> Vec3 {
        2.0 * self.position - self.origin
    }
}

/// How far behind a hit other surfaces count that a straight ray meets, in units of its parameter: both halves of a quadrangle may be hit at
/// their common edge, and rounding moves a hit as much as [`SurfacePoint::behind`] does, along the normal. Rays that graze a surface are taken to
/// be a little steeper, lest they skip what is far behind it.
pub(crate) fn gap_behind(ray: &Ray, hit: &Hit, triangle: &Triangle) -> f32 {
    let [a, b, c] = triangle.corners();
    let error = GAMMA_32 * (a.abs() + b.abs() + c.abs()).max_element();
    let steep = SurfacePoint::new(ray, hit, triangle).normal.dot(ray.direction).abs();
    error / steep.max(MIN_STEEPNESS * ray.direction.length())
}

/// The normals of a triangle's corners, and what they are between them.
pub(crate) struct Smooth {
    pub(crate) corners: [Vec3; 3],
    /// Interpolated; not of unit length.
    pub(crate) normal: Vec3,
    /// The square of its length.
    pub(crate) square: f32,
}

/// The normals at a hit. `None` on flat triangles: those with a corner without a normal, and where normals cancel out.
#[inline(always)]
pub(crate) fn smooth_at(mesh: &Mesh, hit: &Hit) -> Option<Smooth> {
    if mesh.normals.is_empty() {
        return None;
    }
    let corners = mesh.corner_normals(hit.triangle);
    let [a, b, c] = corners;
    let normal = (1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
    let square = normal.length_squared();
    let is_flat = corners.contains(&Vec3::ZERO) || square < MIN_SMOOTH_SQUARE;
    (!is_flat).then_some(Smooth { corners, normal, square })
}

/// The unit normal that shading uses: interpolated if the mesh has normals, else geometric; always on the side of the geometric
/// normal `facing`.
#[inline(always)]
pub fn shading_normal(mesh: &Mesh, hit: &Hit, facing: Vec3) -> Vec3 {
    let Some(smooth) = smooth_at(mesh, hit) else { return facing };
    let normal = smooth.normal / smooth.square.sqrt();
    if normal.dot(facing) < 0.0 { -normal } else { normal }
}

/// The segment from `origin` to `target` for a long test, shortened at its far end.
///
/// A light may lie exactly in a surface (a lamp in a ceiling). The hit on that surface has `t` = 1 give or take the rounding of
/// both ends; the segment stops that much earlier.
#[inline(always)]
pub fn long_segment(origin: Vec3, target: Vec3) -> Ray {
    let direction = target - origin;
    let length = direction.abs().max_element();
    let error = GAMMA_32 * origin.abs().max(target.abs()).max_element();
    let spared = if error < 0.5 * length { error / length } else { 0.5 };
    Ray { origin, direction, t_max: 1.0 - spared }
}
