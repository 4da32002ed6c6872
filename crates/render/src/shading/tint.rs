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

use super::dielectric::{Boundary, left_straight_on};
use super::normal_map::{mirroring, normal_at};
use super::texel::texel_at;
use crate::accel::{Hit, Ray};
use crate::footprint::Cone;
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;
use crate::textures::{Image, images_of};

/// The coefficients of formula (1) at a surface point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coefficients {
    pub(crate) ka: Vec3,
    pub(crate) kd: Vec3,
    pub(crate) ks: Vec3,
    pub(crate) emission: Vec3,
    /// What is left of light that goes straight on.
    pub(crate) transmittance: Vec3,
    /// How opaque a surface with [facets](super::facets) is, whose other coefficients do not know.
    pub(crate) opacity: f32,
    /// How rough and metallic its facets are.
    pub(crate) roughness: f32,
    pub(crate) metallic: f32,
    /// What is reflected of light from all sides, where it is gathered.
    pub(crate) all: Vec3,
    /// What is mirrored.
    pub(crate) mirrored: Vec3,
}

impl Coefficients {
    /// Those of `material` where `ray` with a cone hits it.
    #[inline(always)]
    pub(crate) fn at(scene: &PreparedScene, material: &Material, ray: &Ray, cone: Cone, hit: &Hit) -> Coefficients {
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
    pub(crate) fn untinted(material: &Material) -> Coefficients {
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
    let differs = material.lets_through() || material.faceted().is_some();
    !material.catcher && (differs || !geometry.mesh.colors.is_empty() || has_texture())
}

/// What is left of light that goes straight on along `ray` at `hit`.
pub(crate) fn transmittance(scene: &PreparedScene, ray: &Ray, hit: &Hit) -> Vec3 {
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
    scene.geometry.coverage.opacity(&scene.geometry.triangles.at(hit.triangle), hit)
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

#[cfg(test)]
mod tests {
    use glam::{Affine2, Vec2};
    use lightmesh_scene::{Facets, Scene, Texture, TextureUse};

    use super::*;
    use crate::observer::Unobserved;
    use crate::settings::Acceleration;

    fn texture(size: [u32; 2], texels: &[[u8; 3]]) -> Texture {
        Texture { name: String::new(), size, texels: texels.iter().map(|&[r, g, b]| [r, g, b, 255]).collect() }
    }

    /// A triangle with corners of all kinds, hit in the middle of its first edge.
    fn scene(colors: bool) -> (Scene, Hit) {
        let positions = [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y];
        let uvs = [Vec2::ZERO, Vec2::new(0.5, 0.0), Vec2::Y];
        let colors = if colors { &[Vec3::X, Vec3::Y, Vec3::Z][..] } else { &[] };
        let part = lightmesh_scene::MeshPart {
            positions: &positions,
            uvs: &uvs,
            colors,
            triangles: &[[0, 1, 2]],
            ..Default::default()
        };
        let mut builder = lightmesh_scene::SceneBuilder::new();
        builder.add(part, &glam::DMat4::IDENTITY, |_| 0).unwrap();
        let mut scene = builder.finish_scene("triangle");
        scene.geometry_mut().textures.push(texture([2, 1], &[[255, 255, 0], [0, 255, 255]]));
        (scene, Hit { t: 1.0, u: 0.5, v: 0.0, triangle: 0 })
    }

    /// The coefficients of `material` in a scene, seen with a cone from straight above.
    fn seen(scene: &Scene, material: &Material, cone: Cone, hit: &Hit) -> Coefficients {
        let mut scene = scene.clone();
        scene.geometry_mut().materials = vec![material.clone()];
        let scene = PreparedScene::new(&scene, &Acceleration::BruteForce, &Unobserved).unwrap();
        let ray = Ray { origin: Vec3::new(0.5, 0.0, 1.0), direction: Vec3::NEG_Z, t_max: f32::INFINITY };
        Coefficients::at(&scene, material, &ray, cone, hit)
    }

    #[test]
    fn every_coefficient_takes_its_part_of_the_tint() {
        let (mut scene, hit) = scene(true);
        let (ka, kd, ks) = (Vec3::splat(0.25), Vec3::splat(0.5), Vec3::splat(0.125));
        let shift = Affine2::from_translation(Vec2::new(0.5, 0.0));
        let material =
            Material::matt(kd).with_ka(ka).with_ks(ks).with_ks_tinted(1.5 * kd).with_emission_tinted(4.0 * kd);
        let material = material.with_texture(TextureUse { transform: shift, ..TextureUse::new(0) });
        // The texture's right half, and half red half green.
        let tint = Vec3::new(0.0, 1.0, 1.0) * Vec3::new(0.5, 0.5, 0.0);
        let coefficients = seen(&scene, &material, Cone::default(), &hit);
        let expected = Coefficients {
            ka: ka * tint,
            kd: kd * tint,
            ks: ks + 1.5 * kd * tint,
            emission: 4.0 * kd * tint,
            transmittance: Vec3::ZERO,
            opacity: 1.0,
            roughness: 0.0,
            metallic: 0.0,
            all: kd * tint,
            mirrored: ks + 1.5 * kd * tint,
        };
        assert_eq!(coefficients, expected);
        scene.geometry_mut().mesh.colors.clear();
        assert_eq!(seen(&scene, &material, Cone::default(), &hit).kd, kd * Vec3::new(0.0, 1.0, 1.0));
    }

    #[test]
    fn what_is_emitted_has_an_image_of_its_own() {
        let (mut scene, hit) = scene(true);
        scene.geometry_mut().textures.push(texture([1, 1], &[[0, 0, 255]]));
        let material = Material::matt(Vec3::ONE).with_emission([2.0, 3.0, 4.0]).with_emission_tinted([1.0; 3]);
        let material = material.with_texture(TextureUse::new(0)).with_emission_texture(TextureUse::new(1));
        let found = seen(&scene, &material, Cone::default(), &hit);
        assert_eq!(found.emission, Vec3::new(0.0, 0.0, 4.0) + found.kd, "the tint belongs to the other part");
        scene.geometry_mut().mesh.colors.clear();
        let mut alone = material;
        alone.texture = None;
        assert_eq!(seen(&scene, &alone, Cone::default(), &hit).emission, Vec3::new(1.0, 1.0, 5.0));
    }

    #[test]
    fn facets_are_as_rough_and_metallic_as_an_image_says() {
        let (mut scene, hit) = scene(false);
        scene.geometry_mut().textures.push(texture([1, 1], &[[9, 51, 204]]));
        let facets = Facets::new(0.5).with_metallic(0.25);
        let material = Material::matt(Vec3::ONE).with_metallic_roughness_texture(TextureUse::new(1));
        let shares = |material: &Material| {
            let found = seen(&scene, material, Cone::default(), &hit);
            assert_eq!(found.kd, Vec3::ONE);
            [found.roughness, found.metallic]
        };
        assert_eq!(shares(&material), [0.0; 2], "no facets");
        let [roughness, metallic] = shares(&material.clone().with_facets(facets));
        assert!((roughness - 0.1).abs() < 1e-6 && (metallic - 0.2).abs() < 1e-6, "{roughness} {metallic}");
        let gone = material.with_facets(facets).with_metallic_roughness_texture(TextureUse::new(7));
        assert_eq!(shares(&gone), [0.5, 0.25]);
    }

    #[test]
    fn a_texture_that_cannot_be_looked_up_is_none() {
        let (mut scene, hit) = scene(false);
        let material = Material::default().with_texture(TextureUse::new(0)).with_ks_tinted(Vec3::X);
        let untinted = Coefficients::untinted(&material);
        assert_eq!(untinted.ks, Vec3::X);
        assert_ne!(seen(&scene, &material, Cone::default(), &hit), untinted);
        let other = material.clone().with_texture(TextureUse::new(7));
        assert_eq!(seen(&scene, &other, Cone::default(), &hit), untinted);
        scene.geometry_mut().textures[0].texels.pop();
        assert_eq!(seen(&scene, &material, Cone::default(), &hit), untinted);
        scene.geometry_mut().textures[0] = texture([0, 1], &[]);
        assert_eq!(seen(&scene, &material, Cone::default(), &hit), untinted);
    }

    #[test]
    fn a_cone_sees_the_mean_of_its_footprint() {
        let (scene, hit) = scene(false);
        // The border between the texels, and one texel's middle.
        for (shift, point) in [(0.25, Vec3::new(0.5, 1.0, 0.5)), (0.5, Vec3::new(0.0, 1.0, 1.0))] {
            let shift = Affine2::from_translation(Vec2::new(shift, 0.0));
            let material =
                Material::matt(Vec3::ONE).with_texture(TextureUse { transform: shift, ..TextureUse::new(0) });
            let seen = |cone| seen(&scene, &material, cone, &hit).kd;
            assert_eq!(seen(Cone { width: 0.0, spread: 0.0 }), point);
            // Half of the image is as wide as the triangle's edge: a texel is as wide as it, too.
            assert_eq!(seen(Cone { width: 1.0, spread: 0.0 }), point, "magnified");
            assert_eq!(seen(Cone { width: 0.0, spread: 2.0 }), Vec3::new(0.5, 1.0, 0.5), "twice as wide: all of it");
        }
    }
}
