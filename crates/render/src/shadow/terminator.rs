//! Where shadow rays leave smooth-shaded triangles. Twin: `terminator.cuh`.
//!
//! Vertex normals make flat triangles stand for a curved surface. Near its terminator, where a light is low over it, these triangles
//! turn from the light sooner than the surface does, and hide the light from each other: whole facets are dark. There, shadow rays
//! start from the curved surface, and its horizon counts, not that of the triangle (Hanika: *Hacking the Shadow Terminator*, Ray Tracing
//! Gems II, chapter 4; the surface is that of Boubekeur and Alexa: *Phong Tessellation*, SIGGRAPH Asia 2008). Elsewhere triangles are as
//! good, and the shadows of what stands on them stay in contact with it.

use glam::Vec3;
use lightmesh_layout::constants::{LOW_LIGHT, MIN_CURVED_COSINE, SHAPE_FACTOR};
use lightmesh_scene::{Light, LightKind, Mesh};
use lightmesh_trace::accel::{Hit, Triangle};

use super::size;
use crate::data::wave::HostWave;
use crate::prepared::PreparedGeometry;
use crate::sampling::light_center;
use crate::surface::{SurfacePoint, shading_normal};

impl HostWave<'_> {
    /// The surface point that ray number `ray` sees, as shadow rays leave it; the ray must have hit something.
    #[inline(always)]
    pub(crate) fn shadow_point(&self, ray: usize) -> ShadowPoint {
        let point = self.surface_point(ray);
        if !self.rays.probes.is_empty() {
            return ShadowPoint::flat(point);
        }
        let (hit, scene) = (&self.hits[ray], self.scene);
        let triangle = &scene.geometry.triangles.at(hit.triangle);
        ShadowPoint::new(point, &scene.scene.geometry.mesh, hit, triangle)
    }
}

/// A surface point P that casts shadow rays.
#[derive(Clone, Copy, Debug)]
pub struct ShadowPoint {
    /// P on its triangle.
    flat: SurfacePoint,
    /// The way from P to the curved surface, and the normal there.
    curved: Option<(Vec3, Vec3)>,
}

impl ShadowPoint {
    /// A point of a surface that is what it is.
    pub(crate) fn flat(point: SurfacePoint) -> ShadowPoint {
        ShadowPoint { flat: point, curved: None }
    }

    /// A point at `hit` on a triangle of a mesh.
    #[inline(always)]
    pub fn new(point: SurfacePoint, mesh: &Mesh, hit: &Hit, triangle: &Triangle) -> ShadowPoint {
        if mesh.normals.is_empty() {
            return ShadowPoint::flat(point);
        }
        let normals = mesh.corner_normals(hit.triangle);
        let normal = shading_normal(mesh, hit, point.normal);
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        ShadowPoint { flat: point, curved: curved(&point, normal, triangle.corners(), normals, weights) }
    }

    /// Whether it depends on the light where shadow rays start.
    #[inline(always)]
    pub fn is_curved(&self) -> bool {
        self.curved.is_some()
    }

    /// The point from which `light` is looked for.
    #[inline(always)]
    pub fn toward(&self, light: &Light, geometry: &PreparedGeometry) -> SurfacePoint {
        let flat = self.flat;
        let Some((lift, normal)) = self.curved else { return flat };
        let reach = geometry.sun_distance(flat.origin);
        let way = light_center(light, flat.origin, reach) - flat.origin;
        let radius = match light.kind {
            LightKind::Point { spread, .. } => spread,
            _ => size(light, reach),
        };
        // How high the lowest point of the light is above the triangle's horizon: the sine of an angle.
        let lowest = (flat.normal.dot(way) - radius) / way.length().max(f32::MIN_POSITIVE);
        let share = (1.0 - lowest / LOW_LIGHT).clamp(0.0, 1.0);
        if share <= 0.0 {
            return flat;
        }
        let (lift, normal) = (share * lift, flat.normal + share * (normal - flat.normal));
        // Seen from there, a lamp is nearer to the horizon than it is to shading.
        let way = way - lift;
        let tilt = match light.kind {
            LightKind::Directional { .. } => 0.0,
            _ => normal.dot(lift) / way.length_squared().max(f32::MIN_POSITIVE),
        };
        let normal = normal + tilt * way;
        SurfacePoint { origin: flat.origin + lift, normal: normal / normal.length().max(f32::MIN_POSITIVE), ..flat }
    }
}

/// The way from P to the curved surface, and the unit normal there; `None` if the triangle is flat, the surface is bent inwards, or
/// normals are too far from the triangle's to tell a surface.
#[inline(always)]
fn curved(
    point: &SurfacePoint,
    normal: Vec3,
    corners: [Vec3; 3],
    normals: [Vec3; 3],
    weights: [f32; 3],
) -> Option<(Vec3, Vec3)> {
    // Vertex normals are on the side of the viewer, too, or all of them are not.
    let side = if normals[0].dot(point.normal) < 0.0 { -1.0 } else { 1.0 };
    let mut lift = Vec3::ZERO;
    let mut deepest = 0.0_f32;
    for ((corner, vertex), weight) in corners.into_iter().zip(normals).zip(weights) {
        let vertex = side * vertex;
        if vertex.dot(point.normal) < MIN_CURVED_COSINE {
            return None;
        }
        // To the plane through the corner that touches the surface, if P is below it.
        let depth = vertex.dot(corner - point.position).max(0.0);
        lift += SHAPE_FACTOR * weight * depth * vertex;
        deepest = deepest.max(depth);
    }
    (deepest > 0.0).then_some((lift, normal))
}
