//! Whether two samples lie on one surface, and whether it mirrors. Twin: `alike.cuh`.

use glam::Vec3;
use lightmesh_layout::constants::{NEAR_COSINE, NEAR_HEIGHT, SAME_COSINE, SAME_FACET_COSINE, SAME_HEIGHT};

use crate::accel::{Hit, Ray};
use crate::antialiasing::Antialiasing;
use crate::prepared::PreparedScene;
use crate::surface::{SurfacePoint, shading_normal};

/// A piece of a surface, about as large as a pixel.
pub(crate) struct Facet {
    pub(crate) point: SurfacePoint,
    /// The normal that shading uses.
    smooth: Vec3,
    /// The number of the material.
    pub(crate) material: u32,
    /// About how wide the pixel is there.
    width: f32,
}

impl Facet {
    /// What a ray sees. `spacing` is the distance between the surface points of neighbouring pixels: a constant, and a multiple of
    /// their distance.
    #[inline(always)]
    pub(crate) fn new(scene: &PreparedScene, spacing: [f32; 2], ray: &Ray, hit: &Hit) -> Facet {
        let point = SurfacePoint::new(ray, hit, &scene.geometry.triangles[hit.triangle as usize]);
        let mesh = &scene.scene.geometry.mesh;
        Facet {
            smooth: shading_normal(mesh, hit, point.normal),
            point,
            material: mesh.materials[hit.triangle as usize],
            width: spacing[0] + spacing[1] * hit.t,
        }
    }

    /// Whether two samples of a pixel may be shaded together.
    #[inline(always)]
    pub(crate) fn continues(&self, other: &Facet) -> bool {
        self.smooth.dot(other.smooth) >= SAME_COSINE
            && self.point.normal.dot(other.point.normal) >= SAME_FACET_COSINE
            && self.is_level(other, SAME_HEIGHT)
    }

    /// Whether the surface of a neighbouring pixel may be compared.
    #[inline(always)]
    pub(crate) fn is_near(&self, other: &Facet) -> bool {
        self.smooth.dot(other.smooth) >= NEAR_COSINE && self.is_level(other, NEAR_HEIGHT)
    }

    /// Whether both have the same material, and neither is farther from the other's tangent plane than `height` times the pixel's
    /// width.
    #[inline(always)]
    fn is_level(&self, other: &Facet, height: f32) -> bool {
        let between = other.point.position - self.point.position;
        self.material == other.material
            && self.point.normal.dot(between).abs() <= height * self.width
            && other.point.normal.dot(between).abs() <= height * other.width
    }
}

/// Whether rays that a mirror reflects are followed from here.
#[inline(always)]
pub(crate) fn mirrors(scene: &PreparedScene, all: &Antialiasing, hit: &Hit) -> bool {
    if !all.mirrors || !hit.is_some() {
        return false;
    }
    let geometry = &scene.scene.geometry;
    let material = &geometry.materials[geometry.mesh.materials[hit.triangle as usize] as usize];
    material.ks != Vec3::ZERO || material.ks_tinted != Vec3::ZERO
}
