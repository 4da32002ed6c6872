//! Whether two samples lie on one surface, and whether it mirrors. Twin: `same_surface.cuh`.

use glam::Vec3;
use lightmesh_layout::constants::{
    FAINT_MIRROR, MAX_SHARED, NEAR_COSINE, NEAR_HEIGHT, SAME_COSINE, SAME_FACET_COSINE, SAME_HEIGHT,
};
use lightmesh_scene::Material;
use lightmesh_trace::accel::{Hit, Ray};

use crate::antialiasing::Antialiasing;
use crate::data::rays::RayList;
use crate::prepared::PreparedScene;
use crate::shading::facets::mirrored_share;
use crate::surface::{SurfacePoint, shading_normal};
use crate::textures::facets_of;

/// A piece of a surface, about as large as a pixel.
#[derive(Clone, Copy)]
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
    /// What a ray of a camera sees. `spacing` is the distance between the surface points of neighbouring pixels: a constant, and a multiple
    /// of their distance.
    #[inline(always)]
    pub(crate) fn seen(scene: &PreparedScene, spacing: [f32; 2], ray: &Ray, hit: &Hit) -> Facet {
        Facet::new(scene, ray, hit, spacing[0] + spacing[1] * hit.t)
    }

    /// What a ray sees, where a pixel is about as wide as `width`.
    #[inline(always)]
    pub(crate) fn new(scene: &PreparedScene, ray: &Ray, hit: &Hit, width: f32) -> Facet {
        let point = SurfacePoint::new(ray, hit, &scene.geometry.triangles.at(hit.triangle));
        let mesh = &scene.scene.geometry.mesh;
        Facet {
            smooth: shading_normal(mesh, hit, point.normal),
            point,
            material: mesh.materials[mesh.stored(hit.triangle)],
            width,
        }
    }

    /// Whether two samples of a pixel may be shaded together.
    #[inline(always)]
    pub(crate) fn continues(&self, other: &Facet) -> bool {
        self.smooth.dot(other.smooth) >= SAME_COSINE
            && self.point.normal.dot(other.point.normal) >= SAME_FACET_COSINE
            && self.is_level(other, SAME_HEIGHT)
    }

    /// Whether both look about the same where a rough mirror blurs them.
    #[inline(always)]
    pub(crate) fn resembles(&self, other: &Facet) -> bool {
        self.material == other.material && self.smooth.dot(other.smooth) >= NEAR_COSINE
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

/// Stands for the centre of a pixel in place of a sample's number.
const CENTER: usize = MAX_SHARED as usize;

/// What the samples of a pixel and its centre see.
pub(crate) struct Surfaces<'a> {
    scene: &'a PreparedScene,
    rays: &'a RayList,
    all: &'a Antialiasing,
    center: (&'a Ray, Hit),
    pixel: u32,
    hits: &'a [Hit],
    /// Computed when they are asked for.
    facets: [Option<Facet>; CENTER + 1],
}

impl<'a> Surfaces<'a> {
    /// Those of a pixel whose samples see `hits`; `rays` are a camera's.
    #[inline(always)]
    pub(crate) fn new(
        scene: &'a PreparedScene,
        rays: &'a RayList,
        all: &'a Antialiasing,
        center: (&'a Ray, Hit),
        (pixel, hits): (u32, &'a [Hit]),
    ) -> Surfaces<'a> {
        Surfaces { scene, rays, all, center, pixel, hits, facets: [None; CENTER + 1] }
    }

    /// Whether all samples lie on one surface with the centre.
    #[inline(always)]
    pub(crate) fn is_shared(&mut self) -> bool {
        (0..self.hits.len()).all(|sample| self.is_alike(CENTER, sample))
    }

    /// Adds the owner of each sample: the first one that lies on a surface with it, and is not owned by another.
    pub(crate) fn add_owners(&mut self, owners: &mut Vec<u8>) {
        const NONE: u8 = u8::MAX;
        let start = owners.len();
        owners.resize(start + self.hits.len(), NONE);
        for first in 0..self.hits.len() {
            if owners[start + first] != NONE {
                continue;
            }
            for sample in first..self.hits.len() {
                if owners[start + sample] == NONE && self.is_alike(first, sample) {
                    owners[start + sample] = first as u8;
                }
            }
        }
    }

    /// Whether two of them may be shaded together.
    #[inline(always)]
    fn is_alike(&mut self, a: usize, b: usize) -> bool {
        let (hit_a, hit_b) = (self.hit(a), self.hit(b));
        hit_a.triangle == hit_b.triangle
            || hit_a.is_some() && hit_b.is_some() && self.facet(a).continues(&self.facet(b))
    }

    #[inline(always)]
    fn hit(&self, sample: usize) -> Hit {
        if sample == CENTER { self.center.1 } else { self.hits[sample] }
    }

    fn facet(&mut self, sample: usize) -> Facet {
        let Surfaces { scene, rays, all, center, pixel, .. } = *self;
        let hit = self.hit(sample);
        *self.facets[sample].get_or_insert_with(|| {
            let ray = if sample == CENTER { *center.0 } else { rays.through(all, pixel, sample as u32) };
            Facet::seen(scene, rays.spacing, &ray, &hit)
        })
    }
}

/// Whether the surface at `hit` lets rays through.
#[inline(always)]
pub(crate) fn is_transmissive(scene: &PreparedScene, hit: &Hit) -> bool {
    hit.is_some() && material_at(scene, hit).is_transmissive()
}

/// The largest share that the surface at `hit` may mirror.
#[inline(always)]
pub(crate) fn most_mirrored(scene: &PreparedScene, hit: &Hit) -> f32 {
    let material = material_at(scene, hit);
    match material.faceted() {
        // At grazing incidence, all. An image may make them smooth anywhere.
        Some(facets) => {
            let varies = facets_of(&scene.scene.geometry, material).is_some();
            if varies || mirrored_share(facets.roughness) > 0.0 { 1.0 } else { 0.0 }
        }
        None => (material.ks + material.ks_tinted).max_element(),
    }
}

/// The mirror rays of how many of `count` samples on the surface at `hit` are followed.
pub(crate) fn mirrored_samples(scene: &PreparedScene, all: &Antialiasing, hit: &Hit, count: u32) -> u32 {
    let most = if all.mirrors && hit.is_some() { most_mirrored(scene, hit) } else { 0.0 };
    match most {
        0.0 => 0,
        _ if most <= FAINT_MIRROR => count.div_ceil(2),
        _ => count,
    }
}

fn material_at<'s>(scene: &'s PreparedScene, hit: &Hit) -> &'s Material {
    let geometry = &scene.scene.geometry;
    &geometry.materials[geometry.mesh.materials[geometry.mesh.stored(hit.triangle)] as usize]
}
