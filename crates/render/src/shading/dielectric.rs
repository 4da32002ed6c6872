//! Where light meets glass and the like: Fresnel's equations, Snell's law, absorption on the way through a body. Twin: `dielectric.cuh`.
//!
//! ```text
//! η = n₁/n₂      cos θ₂ = √(1 − η² (1 − cos² θ₁))      F = ½ [(η c₁ − c₂)² / (η c₁ + c₂)² + (η c₂ − c₁)² / (η c₂ + c₁)²]
//! ```
//!
//! (Born and Wolf, *Principles of Optics*, 1.5.) What is not reflected goes on: bent towards η D + (η c₁ − c₂) N, or straight on through a thin
//! wall, which reflects 2 F / (1 + F) for all the reflections between its two sides. Where a body reflects everything, what is reflected is
//! what goes on.

use glam::Vec3;
use lightmesh_layout::constants::{EXP_2, EXP_3, EXP_4, EXP_5, EXP_6, LARGEST_EXPONENT, LN_2_HIGH, LN_2_LOW, LOG2_E};
use lightmesh_scene::Dielectric;
use lightmesh_trace::accel::{Hit, Ray, Triangle};

use crate::prepared::PreparedScene;
use crate::surface::{SurfacePoint, shading_normal};

/// Where a ray meets a dielectric.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Boundary {
    /// n₁/n₂, from the side that the ray comes from to the other.
    eta: f32,
    /// Whether it is that of a wall.
    thin: bool,
    /// The cosine of the angle at which the ray arrives.
    cosine: f32,
    /// What is left of light that came through the body up to here; all of it outside.
    pub(crate) left: Vec3,
}

impl Boundary {
    /// Where `ray` meets a dielectric at `hit`, whatever images of normals say.
    pub(crate) fn met(scene: &PreparedScene, glass: &Dielectric, ray: &Ray, hit: &Hit) -> Boundary {
        let point = SurfacePoint::new(ray, hit, &scene.geometry.triangles.at(hit.triangle));
        Boundary::about(shading_normal(&scene.scene.geometry.mesh, hit, point.normal), scene, glass, ray, hit)
    }

    /// The same with this normal.
    pub(super) fn about(normal: Vec3, scene: &PreparedScene, glass: &Dielectric, ray: &Ray, hit: &Hit) -> Boundary {
        let triangle = &scene.geometry.triangles.at(hit.triangle);
        let length = ray.direction.length();
        let inside = is_inside(glass, ray, triangle);
        Boundary {
            eta: if inside { glass.ior } else { 1.0 / glass.ior },
            thin: glass.thin,
            cosine: (-(normal.dot(ray.direction) / length)).clamp(0.0, 1.0),
            left: if inside { (hit.t * length * glass.absorption).map(exp_of_minus) } else { Vec3::ONE },
        }
    }

    /// The share of the light that is mirrored, apart from what goes on where a body reflects everything.
    pub(crate) fn mirrored(&self) -> f32 {
        let all = !self.thin && cosine_beyond(self.cosine, self.eta).is_none();
        if all { 0.0 } else { self.reflectance() }
    }

    /// The share of the light that is reflected.
    fn reflectance(&self) -> f32 {
        let once = fresnel(self.cosine, self.eta);
        if self.thin { 2.0 * once / (1.0 + once) } else { once }
    }
}

/// Whether `ray` meets the surface from inside of a body.
fn is_inside(glass: &Dielectric, ray: &Ray, triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.corners();
    !glass.thin && (b - a).cross(c - a).dot(ray.direction) > 0.0
}

/// n₁/n₂, from the side that `ray` comes from to the other, of a body; `None` of a wall.
pub(crate) fn eta_seen(glass: &Dielectric, ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let eta = if is_inside(glass, ray, triangle) { glass.ior } else { 1.0 / glass.ior };
    (!glass.thin).then_some(eta)
}

/// What a dielectric leaves of light that goes straight on along `ray`, as if its two sides were parallel.
pub(crate) fn left_straight_on(scene: &PreparedScene, glass: &Dielectric, ray: &Ray, hit: &Hit) -> Vec3 {
    let boundary = Boundary { eta: 1.0 / glass.ior, ..Boundary::met(scene, glass, ray, hit) };
    (1.0 - boundary.reflectance()) * boundary.left
}

/// The unit direction of light that comes along the unit vector `direction` and goes on through a boundary; `None` if all of it is reflected.
pub fn refracted(direction: Vec3, normal: Vec3, eta: f32) -> Option<Vec3> {
    let cosine = (-normal.dot(direction)).clamp(0.0, 1.0);
    let beyond = cosine_beyond(cosine, eta)?;
    Some((eta * direction + (eta * cosine - beyond) * normal).normalize())
}

/// The share of unpolarised light that a boundary reflects.
pub fn fresnel(cosine: f32, eta: f32) -> f32 {
    let Some(beyond) = cosine_beyond(cosine, eta) else { return 1.0 };
    let across = (eta * cosine - beyond) / (eta * cosine + beyond);
    let along = (eta * beyond - cosine) / (eta * beyond + cosine);
    0.5 * (across * across + along * along)
}

/// The cosine of the angle beyond the boundary; `None` if all light is reflected.
fn cosine_beyond(cosine: f32, eta: f32) -> Option<f32> {
    let square = 1.0 - eta * eta * (1.0 - cosine * cosine);
    (square > 0.0).then(|| square.sqrt())
}

/// exp(−x) for x ≥ 0, to two units in the last place, with the same bits everywhere: the libraries of CPUs and GPUs differ.
pub fn exp_of_minus(x: f32) -> f32 {
    if x > LARGEST_EXPONENT {
        return 0.0;
    }
    let whole = (-x * LOG2_E).round_ties_even();
    let rest = (-x - whole * LN_2_HIGH) - whole * LN_2_LOW;
    let sum = ((((EXP_6 * rest + EXP_5) * rest + EXP_4) * rest + EXP_3) * rest + EXP_2) * rest * rest + rest + 1.0;
    sum * f32::from_bits(((whole as i32 + 127) as u32) << 23)
}
