//! Metallic-roughness materials (glTF 2.0, appendix B), see [`Principled`].
//!
//! An unlit material (`KHR_materials_unlit`) shows its base colour, tinted, whatever the lights: k_a = k_d = k_s = 0, and the colour
//! is what the surface emits. It still casts shadows, like everything else.

use std::path::Path;

use glam::{Affine2, Vec3};

use super::{
    container::malformed,
    document::{self, MaterialExtensions, MetallicRoughness, NormalTexture, TextureInfo, Transmission, Volume},
    extras::{self, MaterialExtras},
    left_out::LeftOut,
};
use crate::{LoadError, Material, Opacity, OpacityMode, Principled, TextureUse};

/// Above this roughness, what is behind glass is visibly blurred.
const CLEAR: f32 = 0.1;

/// The material without its texture, by our own extras if the file has them.
pub(super) fn read(of: &document::Material, own: Option<&MaterialExtras>) -> Material {
    let name = of.name.as_deref().unwrap_or_default().to_owned();
    let material = match own {
        Some(own) => own.clone().into_material(name),
        None => Material { name, ..translated(of) },
    };
    one_sided(material, of)
}

/// What our own extras say of a material, if it has some.
pub(super) fn own_extras(
    path: &Path,
    index: usize,
    of: &document::Material,
) -> Result<Option<MaterialExtras>, LoadError> {
    let own: Option<MaterialExtras> = extras::read(path, &format!("material {index}"), of.extras)?;
    match own {
        Some(own) if !(own.shininess > 0.0 && own.shininess.is_finite()) => {
            let problem = format!("extras.lightmesh of material {index} has shininess = {}", own.shininess);
            Err(malformed(path, problem))
        }
        own => Ok(own),
    }
}

/// Back faces are not seen, says glTF, so that what they emit lights nothing.
fn one_sided(material: Material, of: &document::Material) -> Material {
    let one_sided = !of.double_sided && material.emission != Vec3::ZERO;
    material.with_one_sided(one_sided)
}

/// How the material places its texture, and those of its emission, of its normals and of its facets, if our own extras specify it.
pub(super) fn texture_transforms(own: Option<&MaterialExtras>) -> [Option<Affine2>; 4] {
    let columns = own.map_or([None; 4], |own| {
        [own.texture_transform, own.emission_transform, own.normal_transform, own.metallic_roughness_transform]
    });
    columns.map(|columns| columns.map(|columns| Affine2::from_cols_array(&columns)))
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
    if transmission(of).is_some() {
        return principled(of).material().opacity;
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
pub(super) fn translated(of: &document::Material) -> Material {
    let all = principled(of);
    if is_unlit(of) {
        return unlit(all.base.max(Vec3::ZERO));
    }
    // What it lets through is said apart: by its textures, too.
    Material { opacity: None, ..all.material() }
}

fn principled(of: &document::Material) -> Principled {
    let defaults = MetallicRoughness::default();
    let pbr = of.pbr_metallic_roughness.as_deref().unwrap_or(&defaults);
    let [r, g, b, _] = pbr.base_color_factor;
    let no_extensions = MaterialExtensions::default();
    let extensions = of.extensions.as_deref().unwrap_or(&no_extensions);
    let specular = extensions.specular.as_ref();
    let strength = extensions.emissive_strength.as_ref().map_or(1.0, |strength| strength.emissive_strength);
    let volume = extensions.volume.as_ref().filter(|volume| volume.thickness_factor > 0.0);
    let attenuated =
        |volume: &Volume| volume.attenuation_distance.map(|distance| (volume.attenuation_color.into(), distance));
    Principled {
        base: Vec3::new(r, g, b),
        metallic: pbr.metallic_factor,
        roughness: pbr.roughness_factor,
        ior: extensions.ior.as_ref().map(|ior| ior.ior),
        specular: specular.map_or(1.0, |specular| specular.specular_factor),
        specular_color: specular.map_or(Vec3::ONE, |specular| specular.specular_color_factor.into()),
        transmission: transmission(of).map_or(0.0, |transmission| transmission.transmission_factor),
        thin: volume.is_none(),
        attenuation: volume.and_then(attenuated),
        emission: strength * Vec3::from(of.emissive_factor),
    }
}

/// What is shown as it is, and is no lamp.
fn unlit(base: Vec3) -> Material {
    Material { ka: Vec3::ZERO, kd: Vec3::ZERO, ks: Vec3::ZERO, emission_tinted: base, ..Material::default() }
}
