//! The triangle tests. Everything that is decided about a triangle is decided here, for every structure alike; `triangle.cuh` gives
//! the same bits.
//!
//! * [`RayShear::intersect`]: rays and long segments. Watertight (Woop, Benthin, Wald: *Watertight Ray/Triangle
//!   Intersection*, JCGT 2013): a ray cannot slip between two triangles that share an edge or a corner.
//! * [`ShortTest`]: the short test of formula (2). All segments of a surface point leave one origin, so three vectors and a
//!   scalar per triangle decide every one of them, without a division.

use glam::{Vec3, Vec4};
use lightmesh_scene::Bounds;

use super::Hit;

/// The corners of a triangle as the structures store them: three `float4`, the index in the mesh as bits of the first `w`, those of the second
/// the number of a triangle that is cut out (`alpha_mask`), and those of the third the number of an instance that a structure holds in its place.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(16))]
pub struct Triangle {
    corners: [[f32; 4]; 3],
}

impl Triangle {
    /// A triangle with its index in the scene's mesh.
    #[inline]
    pub fn new(corners: [Vec3; 3], index: u32) -> Triangle {
        let mut packed = corners.map(|corner| Vec4::from((corner, 0.0)).to_array());
        packed[0][3] = f32::from_bits(index);
        Triangle { corners: packed }
    }

    /// The same triangle, cut out: `number` is that of its opacities, from 1; 0 if it is opaque.
    #[must_use]
    #[doc(hidden)]
    #[inline]
    pub fn alpha_tested(mut self, number: u32) -> Triangle {
        self.corners[1][3] = f32::from_bits(number);
        self
    }

    /// The number of its opacities; 0 if it is opaque.
    #[inline(always)]
    #[doc(hidden)]
    pub fn cut(&self) -> u32 {
        self.corners[1][3].to_bits()
    }

    /// What a structure holds in place of the triangles of an instance: the box around it.
    #[inline]
    pub(super) fn holder(bounds: &Bounds, instance: u32) -> Triangle {
        let mut holder = Triangle::new([bounds.min, bounds.max, bounds.min], u32::MAX);
        holder.corners[2][3] = f32::from_bits(instance + 1);
        holder
    }

    /// The number of the instance that this stands for.
    #[inline(always)]
    pub(super) fn instance(&self) -> Option<usize> {
        (self.corners[2][3].to_bits() as usize).checked_sub(1)
    }

    /// Index in the scene's mesh.
    #[inline(always)]
    pub fn index(&self) -> u32 {
        self.corners[0][3].to_bits()
    }

    /// Whether the structures accept it: all coordinates finite and within ±[`Triangle::MAX_COORDINATE`], and no two corners equal.
    /// Others are never hit.
    #[inline]
    pub fn is_usable(&self) -> bool {
        let [a, b, c] = self.corners();
        let in_range = |corner: Vec3| corner.abs().cmple(Vec3::splat(Triangle::MAX_COORDINATE)).all();
        in_range(a) && in_range(b) && in_range(c) && a != b && b != c && c != a
    }

    /// The largest usable coordinate, 2⁴⁰: beyond it, products of three would leave the range of `f32`.
    pub const MAX_COORDINATE: f32 = (1u64 << 40) as f32;

    /// The box around the corners.
    #[inline]
    pub fn bounds(&self) -> Bounds {
        Bounds::around(self.corners())
    }

    /// The corners as they lie in memory.
    #[inline(always)]
    pub(super) fn packed(&self) -> &[[f32; 4]; 3] {
        &self.corners
    }

    /// The three corners.
    #[inline(always)]
    pub fn corners(&self) -> [Vec3; 3] {
        let corner = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        let [a, b, c] = self.corners;
        [corner(a), corner(b), corner(c)]
    }
}

/// A ray prepared for the watertight test: the axes permuted so that `z` is the dominant one of its direction, and the shear
/// that turns the ray into the z axis.
#[derive(Clone, Copy, Debug)]
pub struct RayShear {
    axes: [usize; 3],
    origin: [f32; 3],
    shear: [f32; 2],
    depth: f32,
}

/// The axis of a direction's largest component; of equal ones the first.
#[inline(always)]
pub(super) fn largest_axis(direction: Vec3) -> usize {
    let size = direction.abs();
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}

impl RayShear {
    /// Prepares the ray from `origin` along `direction`, which must not be zero.
    #[inline(always)]
    pub fn new(origin: Vec3, direction: Vec3) -> RayShear {
        let z = largest_axis(direction);
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let depth = direction[z];
        let shear = [direction[axes[0]] / depth, direction[axes[1]] / depth];
        let origin = [origin[axes[0]], origin[axes[1]], origin[axes[2]]];
        RayShear { axes, origin, shear, depth }
    }

    /// Where the ray meets the triangle: `(t, u, v)` with barycentric weights of the second and third corner. Both sides count. The
    /// caller checks `t` against the ray's ends (it may be infinite or NaN if it leaves the range of `f32`).
    ///
    /// # Precision
    ///
    /// Let ε = 2⁻²⁴ and S the largest coordinate of a corner relative to the origin. The point at the computed `t` lies within
    /// 9 ε S, on every axis, of a point of the triangle: shearing moves a corner by at most 6 ε S; the sheared corners then decide
    /// exactly; and `t` adds 3 ε S. All box tests rely on this bound.
    #[inline(always)]
    pub fn intersect(&self, triangle: &Triangle) -> Option<(f32, f32, f32)> {
        // 1. Corners relative to the origin, sheared so that the ray is the z axis.
        let [a, b, c] = &triangle.corners;
        let (a, b, c) = (self.sheared(a), self.sheared(b), self.sheared(c));

        // 2. Signs of the edge functions. Rounding is monotonic: it can turn a value to zero, but never past it.
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        self.meet(a, b, c)
    }

    /// The hit, if the ray meets the triangle at a `t` in `(0, t_max)`.
    #[inline(always)]
    pub fn hit(&self, triangle: &Triangle, t_max: f32) -> Option<Hit> {
        let (t, u, v) = self.intersect(triangle)?;
        (t > 0.0 && t < t_max).then(|| Hit { t, u, v, triangle: triangle.index() })
    }

    #[inline(always)]
    fn sheared(&self, corner: &[f32; 4]) -> [f32; 3] {
        // The mask tells the compiler that the index is in range.
        let x = corner[self.axes[0] & 3] - self.origin[0];
        let y = corner[self.axes[1] & 3] - self.origin[1];
        let z = corner[self.axes[2] & 3] - self.origin[2];
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }

    /// The decision and the distance, from sheared corners. In double precision products of `f32` are exact and so is their
    /// difference if it cancels: the weights are right to the last bits even for a triangle seen edge-on.
    #[inline(never)]
    fn meet(&self, a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> Option<(f32, f32, f32)> {
        let [a, b, c] = [a, b, c].map(|corner| corner.map(f64::from));
        // 3. Scaled barycentric coordinates: all of one sign if the triangle is hit.
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let det = u + v + w;
        if det == 0.0 {
            return None;
        }
        // 4. Distance and barycentric coordinates.
        let t = (u * a[2] + v * b[2] + w * c[2]) / (det * f64::from(self.depth));
        Some((t as f32, (v / det) as f32, (w / det) as f32))
    }
}

/// The short test, set up for one surface point: does a triangle stand between it and a light point?
#[derive(Clone, Copy, Debug)]
pub struct ShortTest {
    /// Where the segments start: the surface point, moved off its surface.
    pub origin: Vec3,
    /// Geometric normal on the viewer's side; every segment leaves on this side.
    pub normal: Vec3,
    /// A triangle whose plane passes this close to the origin is edge-on: it hides nothing, because rounding would decide whether it does.
    pub edge_on: f32,
}

/// One triangle as seen from the origin of a [`ShortTest`]: the plane form of the test.
#[derive(Clone, Copy, Debug)]
pub struct Occluder {
    /// Normals of the three planes through the origin and an edge, pointing inwards.
    pub sides: [Vec3; 3],
    /// Six times the volume between origin and triangle: a direction that reaches the triangle's plane has a larger sum of
    /// the three side products.
    pub volume: f32,
}

impl ShortTest {
    /// Prepares a triangle; `None` if it can block nothing: wholly on or behind the tangent plane, or edge-on.
    #[inline(always)]
    pub fn occluder(&self, [a, b, c]: [Vec3; 3]) -> Option<Occluder> {
        let (a, b, c) = (a - self.origin, b - self.origin, c - self.origin);
        if self.normal.dot(a) <= 0.0 && self.normal.dot(b) <= 0.0 && self.normal.dot(c) <= 0.0 {
            return None;
        }
        let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
        let volume = a.dot(bc);
        let area = (b - a).cross(c - a);
        if volume * volume <= self.edge_on * self.edge_on * area.length_squared() {
            return None;
        }
        let sign = if volume < 0.0 { -1.0 } else { 1.0 };
        Some(Occluder { sides: [sign * bc, sign * ca, sign * ab], volume: sign * volume })
    }
}

/// The inner product with the term of x added last: on a line along x the others are summed once. Every comparison of formula (2)
/// uses it, on every device, so that all masks have the same bits.
#[inline(always)]
pub fn dot_along_x(a: Vec3, b: Vec3) -> f32 {
    (a.z * b.z + a.y * b.y) + a.x * b.x
}

impl Occluder {
    /// Whether the triangle meets the segment from the origin along `direction` (the segment's end minus the origin).
    #[inline(always)]
    pub fn blocks(&self, direction: Vec3) -> bool {
        let [a, b, c] = self.sides;
        let (u, v, w) = (dot_along_x(a, direction), dot_along_x(b, direction), dot_along_x(c, direction));
        u >= 0.0 && v >= 0.0 && w >= 0.0 && u + v + w > self.volume
    }
}
