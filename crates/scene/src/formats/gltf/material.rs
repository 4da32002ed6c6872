//! Metallic-roughness materials (glTF 2.0, appendix B): the base colour is k_d, and k_s what the layer above reflects at normal incidence,
//! 0.04 unless `KHR_materials_ior` or `KHR_materials_specular` specify another; the rest are [facets](crate::Facets).
//!
//! With `KHR_materials_transmission`, the share of the light that is not scattered goes through, times b, as glass of the index that
//! `KHR_materials_ior` specifies: straight on through thin walls, or bent and absorbed by the body that `KHR_materials_volume` says there is.
//!
//! An unlit material (`KHR_materials_unlit`) shows its base colour, tinted, whatever the lights: k_a = k_d = k_s = 0, and the colour
//! is what the surface emits. It still casts shadows, like everything else.

use std::path::Path;

use glam::{Affine2, Vec3};

use super::{
    container::malformed,
    document::{self, MaterialExtensions, MetallicRoughness, NormalTexture, TextureInfo, Transmission, Volume},
    extras::{self, MaterialExtras, OpacityExtras},
    left_out::LeftOut,
};
use crate::{Dielectric, Facets, LoadError, Material, Opacity, OpacityMode, TextureUse};

/// Above this roughness, what is behind glass is visibly blurred.
const CLEAR: f32 = 0.1;

/// Higher Phong exponents look like mirrors, and cause problems in `f32`.
const SHARPEST: f32 = 10_000.0;

/// The material without its texture, by our own extras if the file has them. `tinted`: whether a texture or vertex colours are going
/// to tint it.
pub(super) fn read(path: &Path, index: usize, of: &document::Material, tinted: bool) -> Result<Material, LoadError> {
    let name = of.name.as_deref().unwrap_or_default().to_owned();
    let own: Option<MaterialExtras> = extras::read(path, &format!("material {index}"), of.extras)?;
    if let Some(own) = own {
        if !(own.shininess > 0.0 && own.shininess.is_finite()) {
            let problem = format!("extras.lightmesh of material {index} has shininess = {}", own.shininess);
            return Err(malformed(path, problem));
        }
        return Ok(own.into_material(name));
    }
    Ok(Material { name, ..translated(of, tinted) })
}

/// How the material places its texture, and those of its emission, of its normals and of its facets, if our own extras specify it.
pub(super) fn texture_transforms(
    path: &Path,
    index: usize,
    of: &document::Material,
) -> Result<[Option<Affine2>; 4], LoadError> {
    let own: Option<MaterialExtras> = extras::read(path, &format!("material {index}"), of.extras)?;
    let columns = own.map_or([None; 4], |own| {
        [own.texture_transform, own.emission_transform, own.normal_transform, own.metallic_roughness_transform]
    });
    Ok(columns.map(|columns| columns.map(|columns| Affine2::from_cols_array(&columns))))
}

/// The image that the emission is multiplied with. What an unlit material emits is its base colour.
pub(super) fn emissive_texture<'a>(of: &'a document::Material) -> Option<&'a TextureInfo> {
    of.emissive_texture.as_ref().filter(|_| !is_unlit(of))
}

/// The image of normals; where nothing is lit, they do not count.
pub(super) fn normal_texture<'a>(of: &'a document::Material) -> Option<&'a NormalTexture> {
    of.normal_texture.as_ref().filter(|_| !is_unlit(of))
}

/// The image of how rough and metallic the facets are, which neither glass nor what is unlit has.
pub(super) fn metallic_roughness_texture<'a>(of: &'a document::Material) -> Option<&'a TextureInfo> {
    let pbr = of.pbr_metallic_roughness.as_deref()?;
    pbr.metallic_roughness_texture.as_ref().filter(|_| !is_unlit(of) && transmission(of).is_none())
}

fn is_unlit(of: &document::Material) -> bool {
    of.extensions.as_deref().is_some_and(|extensions| extensions.unlit.is_some())
}

/// Where the surface is, and what it lets through, if our own extras specify it.
pub(super) fn opacity_extras(
    path: &Path,
    index: usize,
    of: &document::Material,
) -> Result<Option<OpacityExtras>, LoadError> {
    let own: Option<MaterialExtras> = extras::read(path, &format!("material {index}"), of.extras)?;
    Ok(own.and_then(|own| own.opacity))
}

/// Counts the properties of the material that are not shown.
pub(super) fn count_left_out(of: &document::Material, left_out: &mut LeftOut) {
    let pbr = of.pbr_metallic_roughness.as_deref();
    let specular = of.extensions.as_deref().and_then(|extensions| extensions.specular.as_ref());
    let alpha_mode = of.alpha_mode.as_deref().unwrap_or("OPAQUE");
    left_out.unknown_alpha_modes += usize::from(!matches!(alpha_mode, "OPAQUE" | "MASK" | "BLEND"));
    left_out.occlusion_textures += usize::from(of.occlusion_texture.is_some());
    if let Some(transmission) = transmission(of) {
        left_out.transmission_textures += usize::from(transmission.transmission_texture.is_some());
        left_out.glass_textures += usize::from(pbr.is_some_and(|pbr| pbr.metallic_roughness_texture.is_some()));
        left_out.frosted += usize::from(pbr.is_none_or(|pbr| pbr.roughness_factor > CLEAR));
    }
    left_out.specular_textures += usize::from(
        specular
            .is_some_and(|specular| specular.specular_texture.is_some() || specular.specular_color_texture.is_some()),
    );
}

/// What lets light through, if anything does.
fn transmission<'a>(of: &'a document::Material) -> Option<&'a Transmission> {
    let transmission = of.extensions.as_deref()?.transmission.as_ref()?;
    (transmission.transmission_factor > 0.0).then_some(transmission)
}

/// What is transmitted; else what an `alphaMode` other than OPAQUE says, by the alpha of its base colour and `texture`. A cutoff or
/// factor that is no number, or negative, counts as 0.
pub(super) fn opacity(of: &document::Material, texture: Option<TextureUse>) -> Option<Opacity> {
    if let Some(transmission) = transmission(of) {
        let defaults = MetallicRoughness::default();
        let pbr = of.pbr_metallic_roughness.as_deref().unwrap_or(&defaults);
        let [r, g, b, _] = pbr.base_color_factor;
        let share = transmission.transmission_factor.min(1.0) * (1.0 - pbr.metallic_factor.clamp(0.0, 1.0));
        return Some(Opacity::blend(1.0 - share).with_filter(Vec3::new(r, g, b).clamp(Vec3::ZERO, Vec3::ONE)));
    }
    let mode = match of.alpha_mode.as_deref()? {
        "MASK" => OpacityMode::Mask { cutoff: of.alpha_cutoff.unwrap_or(Opacity::CUTOFF).max(0.0) },
        "BLEND" => OpacityMode::Blend { filter: Vec3::ONE },
        _ => return None,
    };
    let factor = of.pbr_metallic_roughness.as_deref().map_or(1.0, |pbr| pbr.base_color_factor[3]).max(0.0);
    Some(Opacity { texture, factor, mode, ..Opacity::default() })
}

/// The material in glTF's own terms.
pub(super) fn translated(of: &document::Material, tinted: bool) -> Material {
    let defaults = MetallicRoughness::default();
    let pbr = of.pbr_metallic_roughness.as_deref().unwrap_or(&defaults);
    let [r, g, b, _] = pbr.base_color_factor;
    let base = Vec3::new(r, g, b).max(Vec3::ZERO);
    let extensions = of.extensions.as_deref();
    if is_unlit(of) {
        return unlit(base, tinted);
    }
    let mut material = match transmission(of) {
        None => faceted(base, pbr.metallic_factor, pbr.roughness_factor, extensions),
        // What glass reflects is Fresnel's.
        Some(_) => Material {
            shininess: shininess(pbr.roughness_factor),
            dielectric: Some(boundary(extensions)),
            ..Material::matt(base)
        },
    };
    let strength = extensions.and_then(|extensions| extensions.emissive_strength.as_ref());
    let strength = strength.map_or(1.0, |strength| strength.emissive_strength);
    material.emission = (strength * Vec3::from(of.emissive_factor)).max(Vec3::ZERO);
    material.lamp = true;
    material
}

fn faceted(base: Vec3, metallic: f32, roughness: f32, extensions: Option<&MaterialExtensions>) -> Material {
    let share = |factor: f32| factor.clamp(0.0, 1.0);
    let (layer, grazing) = reflectance(extensions);
    let facets = Facets::new(share(roughness)).with_metallic(share(metallic)).with_grazing(grazing);
    Material::matt(base).with_ks(layer).with_facets(facets)
}

/// The lobe of a body's highlights, which is Phong's: as wide as facets of this roughness are (Walter et al. 2007).
fn shininess(roughness: f32) -> f32 {
    (2.0 / roughness.clamp(0.0, 1.0).powi(4) - 2.0).clamp(1.0, SHARPEST)
}

fn unlit(base: Vec3, tinted: bool) -> Material {
    let (emission, emission_tinted) = if tinted { (Vec3::ZERO, base) } else { (base, Vec3::ZERO) };
    Material { ka: Vec3::ZERO, kd: Vec3::ZERO, ks: Vec3::ZERO, emission, emission_tinted, ..Material::default() }
}

/// The boundary of what transmits light.
fn boundary(extensions: Option<&MaterialExtensions>) -> Dielectric {
    let ior =
        extensions.and_then(|extensions| extensions.ior.as_ref()).map_or(Dielectric::GLASS, |ior| ior.ior.max(1.0));
    let volume = extensions.and_then(|extensions| extensions.volume.as_ref());
    let glass = Dielectric::new(ior);
    match volume.filter(|volume| volume.thickness_factor > 0.0) {
        None => glass.with_thin(true),
        Some(Volume { attenuation_color, attenuation_distance, .. }) => match attenuation_distance {
            Some(distance) if *distance > 0.0 => glass.with_attenuation(*attenuation_color, *distance),
            _ => glass,
        },
    }
}

/// What the layer reflects at normal and at grazing incidence, apart from a metal.
fn reflectance(extensions: Option<&MaterialExtensions>) -> (Vec3, f32) {
    let ior = extensions.and_then(|extensions| extensions.ior.as_ref()).map_or(Facets::LAYER, |ior| match ior.ior {
        // As defined by the extension: a surface that reflects everything.
        0.0 => 1.0,
        ior => ((ior.max(1.0) - 1.0) / (ior.max(1.0) + 1.0)).powi(2),
    });
    let (factor, color) = extensions
        .and_then(|extensions| extensions.specular.as_ref())
        .map_or((1.0, Vec3::ONE), |specular| (specular.specular_factor, specular.specular_color_factor.into()));
    let factor = factor.clamp(0.0, 1.0);
    ((ior * color).clamp(Vec3::ZERO, Vec3::ONE) * factor, factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COPPER: Vec3 = Vec3::new(0.95, 0.64, 0.54);

    fn plain(metallic: f32, roughness: f32) -> Material {
        faceted(COPPER, metallic, roughness, None)
    }

    #[test]
    fn factors_are_facets_of_the_base_colour() {
        let copper = plain(0.75, 0.5);
        assert_eq!((copper.kd, copper.ks), (COPPER, Vec3::splat(0.04)));
        assert_eq!(copper.facets, Some(Facets { roughness: 0.5, metallic: 0.75, grazing: 1.0 }));
    }

    #[test]
    fn the_lobe_of_glass_is_as_wide_as_its_roughness_says() {
        assert!((shininess(0.5) - 30.0).abs() < 1e-4);
        assert_eq!((shininess(0.0), shininess(1.0)), (SHARPEST, 1.0));
    }

    #[test]
    fn factors_out_of_range_are_brought_back() {
        assert_eq!(plain(7.0, -1.0), plain(1.0, 0.0));
        assert_eq!(plain(-1.0, 3.0), plain(0.0, 1.0));
    }

    #[test]
    fn the_index_of_refraction_and_the_specular_factor_set_the_reflectance() {
        let of = |extensions: &str| reflectance(Some(&serde_json::from_str(extensions).unwrap()));
        let near = |(found, grazing): (Vec3, f32), expected: [f32; 3], end: f32| {
            (found - Vec3::from(expected)).length() < 1e-6 && grazing == end
        };
        assert!(near(of(r#"{"KHR_materials_ior": {}}"#), [0.04; 3], 1.0));
        assert!(near(of(r#"{"KHR_materials_ior": {"ior": 2}}"#), [1.0 / 9.0; 3], 1.0));
        assert!(near(of(r#"{"KHR_materials_ior": {"ior": 1}}"#), [0.0; 3], 1.0));
        let halved = r#"{"KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0, 100]}}"#;
        assert!(near(of(halved), [0.02, 0.0, 0.5], 0.5));
    }
}
