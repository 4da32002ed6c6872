//! Textures, vertex colours and opacities: the coefficients of formula (1) at a surface point.
//!
//! ```text
//! t = texture(A · uv) · colour      α k_a t      α k_d t      α (k_s + k_s' t)      goes through: (1 − α) filter
//! e = emission texture(A' · uv)     emitted: α (L e + L' t)
//! m = metallic-roughness texture(A'' · uv)      of facets: roughness · m_green      metallic · m_blue
//! ```
//!
//! Texture coordinates and colours are interpolated barycentrically. Of the texture, the mean over the [footprint](crate::footprint) of a
//! sample counts; without one, at a single sample of a pixel, it is the colour at a point, and minified textures flicker.

use glam::Vec3;
use lightmesh_scene::{Dielectric, Geometry, Material, Mesh};
use lightmesh_trace::accel::{Hit, Ray};

use super::dielectric::{Boundary, left_straight_on};
use super::normal_map::{mirroring, normal_at};
use super::texel::texel_at;
use crate::footprint::Cone;
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;
use crate::textures::{Image, images_of};

/// The coefficients of formula (1) at a surface point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Ambient reflectance.
    pub ka: Vec3,
    /// Diffuse reflectance.
    pub kd: Vec3,
    /// Specular reflectance.
    pub ks: Vec3,
    /// What it emits.
    pub emission: Vec3,
    /// What is left of light that goes straight on.
    pub transmittance: Vec3,
    /// How opaque a surface with facets is, whose other coefficients do not know.
    pub opacity: f32,
    /// How rough its facets are.
    pub roughness: f32,
    /// How metallic its facets are.
    pub metallic: f32,
    /// What is reflected of light from all sides, where it is gathered.
    pub all: Vec3,
    /// What is mirrored.
    pub mirrored: Vec3,
}

impl Coefficients {
    /// Those of `material` where `ray` with a cone hits it.
    #[inline(always)]
    pub fn at(scene: &PreparedScene, material: &Material, ray: &Ray, cone: Cone, hit: &Hit) -> Coefficients {
        match is_tinted(&scene.scene.geometry, material) {
            true => {
                let own = Coefficients::tinted(material, colors(scene, material, ray, cone, hit), opacity(scene, hit));
                match material.boundary() {
                    Some(glass) => own.at_boundary(&boundary(scene, material, glass, (ray, cone), hit)),
                    None => own,
                }
            }
            false => Coefficients::untinted(material),
        }
    }

    /// The mean of those at some hits of the samples of the pixel that `ray` belongs to; `None` without any.
    pub(crate) fn mean<'h>(
        scene: &PreparedScene,
        material: &Material,
        ray: &Ray,
        cone: Cone,
        hits: impl Iterator<Item = &'h Hit>,
    ) -> Option<Coefficients> {
        let nothing = Colors { tint: Vec3::ZERO, glow: Vec3::ZERO, facets: Vec3::ZERO };
        let (mut sum, mut opacities, mut count) = (nothing, 0.0, 0.0);
        for hit in hits {
            let own = colors(scene, material, ray, cone, hit);
            sum = Colors { tint: sum.tint + own.tint, glow: sum.glow + own.glow, facets: sum.facets + own.facets };
            opacities += opacity(scene, hit);
            count += 1.0;
        }
        let mean = || Colors { tint: sum.tint / count, glow: sum.glow / count, facets: sum.facets / count };
        (count > 0.0).then(|| Coefficients::tinted(material, mean(), opacities / count))
    }

    /// Those of a material that is the same everywhere.
    #[inline(always)]
    pub fn untinted(material: &Material) -> Coefficients {
        let ks = material.ks + material.ks_tinted;
        let [roughness, metallic] = shares_of_facets(material, Vec3::ONE);
        Coefficients {
            ka: material.ka,
            kd: material.kd,
            ks,
            emission: material.emission + material.emission_tinted,
            transmittance: Vec3::ZERO,
            opacity: 1.0,
            roughness,
            metallic,
            all: material.kd,
            mirrored: ks,
        }
    }

    fn tinted(material: &Material, Colors { tint, glow, facets }: Colors, opacity: f32) -> Coefficients {
        let filter = material.opacity.and_then(|opacity| opacity.filter()).unwrap_or(Vec3::ZERO);
        // Of facets, these are what they are made of.
        let there = if material.faceted().is_some() { 1.0 } else { opacity };
        let kd = there * (material.kd * tint);
        let ks = there * (material.ks + material.ks_tinted * tint);
        let [roughness, metallic] = shares_of_facets(material, facets);
        Coefficients {
            ka: there * (material.ka * tint),
            kd,
            ks,
            emission: opacity * (material.emission * glow + material.emission_tinted * tint),
            transmittance: (1.0 - opacity) * filter,
            opacity,
            roughness,
            metallic,
            all: kd,
            mirrored: ks,
        }
    }

    /// The same where a dielectric begins or ends.
    fn at_boundary(self, boundary: &Boundary) -> Coefficients {
        let (mirrored, left) = (boundary.mirrored(), boundary.left);
        let (kd, ks) = (left * self.kd, mirrored * left);
        Coefficients {
            ka: left * self.ka,
            kd,
            ks,
            emission: left * self.emission,
            transmittance: (1.0 - mirrored) * left * self.transmittance,
            all: kd,
            mirrored: ks,
            ..self
        }
    }
}

/// How rough and metallic the facets of a material are where their image has this value; 0 without facets.
#[inline(always)]
fn shares_of_facets(material: &Material, texel: Vec3) -> [f32; 2] {
    material.faceted().map_or([0.0; 2], |facets| [facets.roughness * texel.y, facets.metallic * texel.z])
}

/// Where `ray` with a cone meets a dielectric.
fn boundary(
    scene: &PreparedScene,
    material: &Material,
    glass: &Dielectric,
    (ray, cone): (&Ray, Cone),
    hit: &Hit,
) -> Boundary {
    let point = SurfacePoint::new(ray, hit, &scene.geometry.triangles.at(hit.triangle));
    let (normal, relief) = normal_at(scene, material, (ray, cone), hit, &point);
    let turned = relief.map_or(normal, |_| mirroring(normal, point.normal, -ray.direction));
    Boundary::about(turned, scene, glass, ray, hit)
}

/// Whether surface points of `material` may differ in their coefficients or relief.
#[inline(always)]
pub(crate) fn is_tinted(geometry: &Geometry, material: &Material) -> bool {
    let has_texture = || images_of(geometry, material).iter().any(Option::is_some);
    let differs = material.is_transmissive() || material.faceted().is_some();
    !material.catcher && (differs || !geometry.mesh.colors.is_empty() || has_texture())
}

/// What is left of light that goes straight on along `ray` at `hit`.
pub(crate) fn transmittance_at(scene: &PreparedScene, ray: &Ray, hit: &Hit) -> Vec3 {
    let geometry = &scene.scene.geometry;
    let material = &geometry.materials[geometry.mesh.materials[geometry.mesh.stored(hit.triangle)] as usize];
    let filter = material.opacity.and_then(|opacity| opacity.filter()).unwrap_or(Vec3::ZERO);
    let through = (1.0 - opacity(scene, hit)) * filter;
    match material.boundary() {
        Some(glass) => left_straight_on(scene, glass, ray, hit) * through,
        None => through,
    }
}

/// How opaque the surface is at `hit`.
fn opacity(scene: &PreparedScene, hit: &Hit) -> f32 {
    scene.geometry.alpha_mask.opacity(&scene.geometry.triangles.at(hit.triangle), hit)
}

/// The values of images at a surface point.
#[derive(Clone, Copy)]
struct Colors {
    /// The product of texture and vertex colour.
    tint: Vec3,
    /// The texture of what is emitted.
    glow: Vec3,
    /// The texture of how rough (y) and metallic (z) facets are.
    facets: Vec3,
}

#[inline(never)]
fn colors(scene: &PreparedScene, material: &Material, ray: &Ray, cone: Cone, hit: &Hit) -> Colors {
    let geometry = &scene.scene.geometry;
    let texel = |found: Option<Image>| found.map_or(Vec3::ONE, |image| texel_at(scene, &image, ray, cone, hit));
    let [tint, glow, _, facets] = images_of(geometry, material);
    let [tint, glow, facets] = [tint, glow, facets].map(texel);
    let tint = if geometry.mesh.colors.is_empty() { tint } else { tint * color_at(&geometry.mesh, hit) };
    Colors { tint, glow, facets }
}

fn color_at(mesh: &Mesh, hit: &Hit) -> Vec3 {
    let [a, b, c] = mesh.triangles[mesh.stored(hit.triangle)].map(|vertex| mesh.colors[vertex as usize]);
    (1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c
}
