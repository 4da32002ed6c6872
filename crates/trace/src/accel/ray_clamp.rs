//! Moves a ray close to the triangles before it is traced.
//!
//! A ray that starts a thousand scene sizes away would hit a triangle with the rounding errors of a thousand scene sizes. So
//! every structure first moves such an origin along the ray, in double precision, to just in front of the sphere around the
//! triangles, and scales extreme directions. Afterwards all coordinates relative to an origin are below [`REACH`] + 1 radii,
//! which bounds every rounding error in a walk.

use glam::{DVec3, Vec3};
use lightmesh_layout::constants::{LARGEST_DIRECTION, REACH};
use lightmesh_scene::Bounds;

use super::{Hit, Ray, Triangle};

/// Directions whose largest component lies outside these powers of two are scaled.
const DIRECTION_RANGE: std::ops::RangeInclusive<f32> = 1.0 / LARGEST_DIRECTION..=LARGEST_DIRECTION;

/// The sphere of interest, which contains the triangles of a structure.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayClamp {
    center: Vec3,
    /// Half the longest edge of the box around the triangles; never zero.
    radius: f32,
}

/// A ray close to the triangles, and how its parameter relates to that of the original ray: `t = start + t' · scale`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClampedRay {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    pub(super) t_max: f32,
    start: f64,
    scale: f64,
}

impl RayClamp {
    /// For triangles within `bounds`.
    #[inline]
    pub(super) fn new(bounds: &Bounds) -> RayClamp {
        if bounds.is_empty() {
            return RayClamp { center: Vec3::ZERO, radius: 1.0 };
        }
        let center = bounds.center();
        // The floor keeps the rounding of the coordinates themselves below the radius.
        let floor = (center.abs().max_element() * f32::EPSILON).max(f32::MIN_POSITIVE);
        RayClamp { center, radius: (0.5 * bounds.extent().max_element()).max(floor) }
    }

    #[inline]
    pub(super) fn around(triangles: &[Triangle]) -> RayClamp {
        RayClamp::new(&bounds(triangles))
    }

    /// Centre and radius.
    #[inline]
    pub(super) fn parts(&self) -> (Vec3, f32) {
        (self.center, self.radius)
    }

    /// Half the longest edge of the box around the triangles.
    #[inline]
    pub(super) fn radius(&self) -> f32 {
        self.radius
    }

    /// Whether a ray is traced as it is.
    #[inline(always)]
    pub(super) fn is_near(&self, ray: &Ray) -> bool {
        let Ray { origin, direction, t_max } = *ray;
        let near = (origin - self.center).abs().cmple(Vec3::splat(REACH * self.radius)).all();
        near && DIRECTION_RANGE.contains(&direction.abs().max_element()) && direction.is_finite() && t_max > 0.0
    }

    /// The ray to trace; `None` if it cannot hit anything.
    #[inline(always)]
    pub(super) fn ray(&self, ray: &Ray) -> Option<ClampedRay> {
        let Ray { origin, direction, t_max } = *ray;
        if self.is_near(ray) {
            return Some(ClampedRay { origin, direction, t_max, start: 0.0, scale: 1.0 });
        }
        self.far_ray(ray)
    }

    #[cold]
    #[inline(never)]
    fn far_ray(&self, ray: &Ray) -> Option<ClampedRay> {
        let (origin, center) = (ray.origin.as_dvec3(), self.center.as_dvec3());
        let largest = f64::from(ray.direction.abs().max_element());
        let usable = ray.origin.is_finite() && ray.direction.is_finite() && largest > 0.0 && ray.t_max > 0.0;
        if !usable {
            return None;
        }
        // A power of two: the scaled direction has the same bits except for its exponent.
        let scale = largest.log2().floor().exp2().recip();
        let direction = ray.direction.as_dvec3() * scale;
        let start = self.start(origin - center, direction)?;
        let t_max = (f64::from(ray.t_max) / scale - start) as f32;
        (t_max > 0.0).then(|| ClampedRay {
            origin: (origin + start * direction).as_vec3(),
            direction: direction.as_vec3(),
            t_max,
            start: start * scale,
            scale,
        })
    }

    /// Where along the ray to begin; `None` if it misses the triangles or points away from them.
    fn start(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let radius = f64::from(self.radius);
        if origin.abs().max_element() <= f64::from(REACH) * radius {
            return Some(0.0);
        }
        let nearest = -origin.dot(direction) / direction.length_squared();
        // The box lies in a sphere of √3 radii; 2 leaves room for rounding.
        let sphere = 2.0 * radius;
        let passes_by = (origin + nearest * direction).length() > sphere;
        (nearest > 0.0 && !passes_by).then(|| nearest - 2.0 * sphere / direction.length())
    }
}

impl ClampedRay {
    /// Converts a hit of this ray to a hit of the original ray.
    #[inline(always)]
    pub(super) fn finish(&self, mut hit: Hit) -> Hit {
        if self.start != 0.0 || self.scale != 1.0 {
            hit.t = (self.start + f64::from(hit.t) * self.scale) as f32;
        }
        hit
    }
}

/// The box around `triangles`.
#[inline]
pub(super) fn bounds(triangles: &[Triangle]) -> Bounds {
    Bounds::around(triangles.iter().flat_map(|triangle| triangle.corners()))
}

/// Whether two closed boxes have a point in common.
#[inline]
pub(super) fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}
