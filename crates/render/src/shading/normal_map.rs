//! Images of normals: where a surface would face if it had the relief that an image stands for. Twin: `normal_map.cuh`.
//!
//! ```text
//! m = (255 c − 128) / 127      n ∝ m_z N + s σ (m_x T + m_y B)      T ∝ ∂P/∂u − (N·∂P/∂u) N      B = ± N × T, to the image's top
//! ```
//!
//! c are the values of the image, so that code 128 is exactly 0; s is the material's scale, N the normal without the image, σ = −1 on the back,
//! where bumps are dents. T and B follow from the texture coordinates over the triangle, as the image is placed, whichever way round it is.
//! The mean over a footprint is that of m; what is shaded together takes the mean of n.
//!
//! Only shading uses n. Three things keep it from being seen that there is no relief:
//!
//! 1. A normal that faces away from the viewer is turned as far as it may still be seen: relief that faces away is hidden.
//! 2. What is mirrored into the surface is mirrored just above it. Fresnel's equations and refraction have the normal that does that.
//! 3. A light that is low above the surface, which goes out when it sinks below the horizon, fades out before: see [`Relief::softened`].

use glam::{Vec2, Vec3};
use lightmesh_layout::constants::{
    LOW_LIGHT, MIN_MIRRORED_COSINE, MIN_SMOOTH_SQUARE, NORMAL_CODE_ONE, NORMAL_CODE_ZERO,
};
use lightmesh_scene::{Geometry, Material};
use lightmesh_trace::accel::{Hit, Ray};

use super::texel::{texel_at, uvs_of};
use crate::footprint::Cone;
use crate::prepared::PreparedScene;
use crate::surface::{SurfacePoint, shading_normal, smooth_at};
use crate::textures::{Image, normals_of};

/// What the shading of a surface with an image of normals needs besides its normal.
#[derive(Clone, Copy)]
pub struct Relief {
    /// The normal without the image.
    pub smooth: Vec3,
}

impl Relief {
    /// The cosine of light along `direction`, which is `cosine` by the image. Where the light is lower than 6° above the surface without relief, what
    /// the relief adds fades to nothing at the horizon. Else whole bumps would be dark at once when the light sinks.
    pub fn softened(&self, direction: Vec3, cosine: f32) -> f32 {
        let plain = self.smooth.dot(direction);
        if cosine <= plain || plain >= LOW_LIGHT {
            return cosine;
        }
        let (least, high) = (plain.max(0.0), plain.max(0.0) / LOW_LIGHT);
        least + high * high * (3.0 - 2.0 * high) * (cosine - least)
    }
}

/// The normal that shading uses, where `ray` with a cone hits a surface at `point`, and its relief if it has one.
#[inline(always)]
pub(super) fn normal_at(
    scene: &PreparedScene,
    material: &Material,
    (ray, cone): (&Ray, Cone),
    hit: &Hit,
    point: &SurfacePoint,
) -> (Vec3, Option<Relief>) {
    let geometry = &scene.scene.geometry;
    let smooth = shading_normal(&geometry.mesh, hit, point.normal);
    if !has_relief(geometry, material) {
        return (smooth, None);
    }
    (mapped_normal(scene, material, (ray, cone), hit, smooth), Some(Relief { smooth }))
}

/// Whether the normals of a material have an image that can be looked up.
#[inline(always)]
pub(super) fn has_relief(geometry: &Geometry, material: &Material) -> bool {
    material.normal_texture.is_some() && !material.catcher && normals_of(geometry, material).is_some()
}

/// The mean over some hits of the samples of the pixel that `ray` belongs to; `own` without any.
#[inline(never)]
pub(super) fn mean_normal<'h>(
    scene: &PreparedScene,
    material: &Material,
    (ray, cone): (&Ray, Cone),
    hits: impl Iterator<Item = &'h Hit>,
    own: Vec3,
) -> Vec3 {
    let mesh = &scene.scene.geometry.mesh;
    let mut sum = Vec3::ZERO;
    for hit in hits {
        let point = SurfacePoint::new(ray, hit, &scene.geometry.triangles.at(hit.triangle));
        sum += mapped_normal(scene, material, (ray, cone), hit, shading_normal(mesh, hit, point.normal));
    }
    let square = sum.length_squared();
    if square > MIN_SMOOTH_SQUARE { sum / square.sqrt() } else { own }
}

/// The unit normal by the image, where `smooth` is that without it.
#[inline(never)]
pub(super) fn mapped_normal(
    scene: &PreparedScene,
    material: &Material,
    (ray, cone): (&Ray, Cone),
    hit: &Hit,
    smooth: Vec3,
) -> Vec3 {
    let geometry = &scene.scene.geometry;
    let (Some(map), Some(image)) = (material.normal_texture, normals_of(geometry, material)) else { return smooth };

    // 1. What the image says.
    let texel = texel_at(scene, &image, ray, cone, hit);
    let [x, y, z] = texel.to_array().map(|value| (255.0 * value - NORMAL_CODE_ZERO) / NORMAL_CODE_ONE);
    let (x, y, z) = (map.scale * x, map.scale * y, z.max(0.0));

    if x == 0.0 && y == 0.0 {
        return smooth;
    }

    // 2. In the frame of the image on the surface.
    let Some([right, top]) = frame(scene, &image, hit, smooth) else { return smooth };
    let side = if shows_back(scene, ray, hit) { -1.0 } else { 1.0 };
    let normal = z * smooth + side * (x * right + y * top);
    let square = normal.length_squared();
    if !(square > MIN_SMOOTH_SQUARE && square.is_finite()) {
        return smooth;
    }
    let normal = normal / square.sqrt();

    // 3. Turned to the viewer, as far as the normal without the image is.
    let view = -ray.direction;
    let excess = normal.dot(view) - smooth.dot(view).min(0.0);
    if excess >= 0.0 {
        return normal;
    }
    let seen = normal - excess * view;
    seen / seen.length().max(f32::MIN_POSITIVE)
}

/// Unit vectors along the surface to the right of the image and to its top, across `smooth`. `None` where the image has no area.
fn frame(scene: &PreparedScene, image: &Image, hit: &Hit, smooth: Vec3) -> Option<[Vec3; 2]> {
    let [a, b, c] = scene.geometry.triangles.at(hit.triangle).corners();
    let uvs = uvs_of(scene, hit);
    let [p, q]: [Vec2; 2] = [uvs[1] - uvs[0], uvs[2] - uvs[0]].map(|step| image.uses.transform.matrix2 * step);
    let (ab, ac) = (b - a, c - a);
    let area = p.x * q.y - p.y * q.x;
    let along = if area < 0.0 { p.y * ac - q.y * ab } else { q.y * ab - p.y * ac };
    let along = along / along.abs().max_element();
    let across = along - smooth.dot(along) * smooth;
    let square = across.length_squared();
    // Also where there are no numbers.
    if !(area != 0.0 && square > MIN_SMOOTH_SQUARE) {
        return None;
    }
    let right = across / square.sqrt();
    let other = smooth.cross(right);
    let is_mirrored = (smooth.dot(ab.cross(ac)) < 0.0) != (area < 0.0);
    Some([right, if is_mirrored { other } else { -other }])
}

/// Whether `ray` sees the back of a surface: vertex normals say which side it is, without them the order of the corners.
fn shows_back(scene: &PreparedScene, ray: &Ray, hit: &Hit) -> bool {
    let triangle = &scene.geometry.triangles.at(hit.triangle);
    let facing = SurfacePoint::new(ray, hit, triangle).normal;
    let [a, b, c] = triangle.corners();
    let outward = smooth_at(&scene.scene.geometry.mesh, hit).map_or((b - a).cross(c - a), |smooth| smooth.normal);
    outward.dot(facing) < 0.0
}

/// The normal nearest to `normal` about which `view` is mirrored to directions above the surface with the geometric normal `facing`: half-way
/// between both.
pub fn mirroring(normal: Vec3, facing: Vec3, view: Vec3) -> Vec3 {
    let direction = 2.0 * normal.dot(view) * normal - view;
    let least = MIN_MIRRORED_COSINE.min(0.5 * facing.dot(view));
    let height = facing.dot(direction);
    if height >= least {
        return normal;
    }
    let raised = direction + (least - height) * facing;
    let middle = raised / raised.length().max(f32::MIN_POSITIVE) + view;
    let square = middle.length_squared();
    if square > MIN_SMOOTH_SQUARE { middle / square.sqrt() } else { facing }
}
