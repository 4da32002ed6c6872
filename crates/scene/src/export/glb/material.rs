//! Materials as metallic-roughness, for other programs, with our own coefficients in the extras.

use glam::Vec3;
use serde_json::{Value, json};

use super::pictures::{Pictures, needs_composing};
use crate::formats::gltf::extras::{ColorExtras, DielectricExtras, FacetExtras, MaterialExtras, OpacityExtras};
use crate::{Dielectric, Facets, Material, Opacity, OpacityChannel, OpacityMode};

const EMISSIVE_STRENGTH: &str = "KHR_materials_emissive_strength";
const IOR: &str = "KHR_materials_ior";
const SPECULAR: &str = "KHR_materials_specular";
const TRANSMISSION: &str = "KHR_materials_transmission";
const UNLIT: &str = "KHR_materials_unlit";
const VOLUME: &str = "KHR_materials_volume";
/// The extensions of materials.
pub(super) const EXTENSIONS: [&str; 6] = [EMISSIVE_STRENGTH, IOR, SPECULAR, TRANSMISSION, UNLIT, VOLUME];

/// Metallic-roughness for other programs (the inverse of the lobe in `formats::gltf::material`), our coefficients in the
/// extras.
pub(super) fn material(material: &Material, index: usize, pictures: &Pictures) -> Value {
    let clamped = |color: Vec3| color.clamp(Vec3::ZERO, Vec3::ONE).to_array();
    let [r, g, b] = clamped(if is_unlit(material) { material.emission_tinted } else { material.kd });
    let matt = material.ks == Vec3::ZERO && material.dielectric.is_none();
    let (metallic, roughness) = match material.faceted() {
        Some(facets) => (facets.metallic, facets.roughness),
        None if matt => (0.0, 1.0),
        None if material.dielectric.is_some() => (0.0, 0.0),
        None => (0.0, (2.0 / (material.shininess + 2.0)).powf(0.25)),
    };
    let [texture_transform, emission_transform, normal_transform, metallic_roughness_transform] =
        pictures.exact_transforms(index);
    let extras = MaterialExtras {
        ka: material.ka.to_array(),
        kd: material.kd.to_array(),
        ks: material.ks.to_array(),
        shininess: material.shininess,
        emission: material.emission.to_array(),
        ks_tinted: material.ks_tinted.to_array(),
        emission_tinted: material.emission_tinted.to_array(),
        catcher: material.catcher,
        lamp: material.lamp,
        texture_transform,
        emission_transform,
        normal_transform,
        metallic_roughness_transform,
        color: pictures.apart(index).map(|color| ColorExtras {
            texture: color.map(|(texture, _)| texture as u32),
            transform: color.map(|(_, uses)| uses.transform.to_cols_array()),
        }),
        opacity: material
            .opacity
            .filter(|opacity| !is_standard(opacity, material))
            .map(|it| opacity_extras(&it, index, pictures)),
        dielectric: material.dielectric.map(DielectricExtras::from),
        facets: material.facets.map(FacetExtras::from),
    };
    let shown = shown_emission(material);
    let strength = shown.max_element();
    // A body of glass is seen from within by what is behind it. What is not double-sided emits to one side.
    let is_dark_body = material.dielectric.is_some_and(|glass| !glass.thin) && material.emission == Vec3::ZERO;
    let mut entry = json!({
        "pbrMetallicRoughness":
            {"baseColorFactor": [r, g, b, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness},
        "emissiveFactor": clamped(if strength > 1.0 { shown / strength } else { shown }),
        "doubleSided": !material.one_sided && !is_dark_body,
        "extras": {"lightmesh": extras},
    });
    if !material.name.is_empty() {
        entry["name"] = json!(material.name);
    }
    if strength > 1.0 {
        entry["extensions"] = json!({EMISSIVE_STRENGTH: {"emissiveStrength": strength}});
    }
    if let Some(facets) = material.faceted().filter(|it| it.grazing != 1.0 || material.ks != Vec3::splat(Facets::LAYER))
    {
        let color = material.ks / (Facets::LAYER * facets.grazing.max(f32::MIN_POSITIVE));
        let color = if facets.grazing > 0.0 { color.max(Vec3::ZERO).to_array() } else { [1.0; 3] };
        entry["extensions"][SPECULAR] = json!({"specularFactor": facets.grazing, "specularColorFactor": color});
    }
    if is_unlit(material) {
        entry["extensions"][UNLIT] = json!({});
    } else if matt && material.faceted().is_none() {
        // glTF puts a glossy layer on everything else.
        entry["extensions"][SPECULAR] = json!({"specularFactor": 0.0});
    }
    if let Some(texture) = pictures.of_material(index) {
        entry["pbrMetallicRoughness"]["baseColorTexture"] = texture;
    }
    if let Some(texture) = pictures.roughness_of_material(index) {
        entry["pbrMetallicRoughness"]["metallicRoughnessTexture"] = texture;
    }
    if let Some(texture) = pictures.emission_of_material(index) {
        entry["emissiveTexture"] = texture;
    }
    if let Some((mut texture, map)) = pictures.normals_of_material(index).zip(material.normal_texture) {
        texture["scale"] = json!(map.scale);
        entry["normalTexture"] = texture;
    }
    if let Some(opacity) = material.opacity.filter(|opacity| has_alpha(opacity, material)) {
        match opacity.mode {
            OpacityMode::Mask { cutoff } => {
                entry["alphaMode"] = json!("MASK");
                entry["alphaCutoff"] = json!(cutoff.max(0.0));
            }
            OpacityMode::Blend { .. } => entry["alphaMode"] = json!("BLEND"),
        }
        entry["pbrMetallicRoughness"]["baseColorFactor"][3] = json!(opacity.factor.clamp(0.0, 1.0));
    }
    if let Some((dielectric, opacity)) = material.dielectric.zip(material.opacity) {
        for (name, extension) in transmission(&dielectric, &opacity) {
            entry["extensions"][name] = extension;
        }
        let [r, g, b] = clamped(opacity.filter().unwrap_or(Vec3::ONE));
        entry["pbrMetallicRoughness"]["baseColorFactor"] = json!([r, g, b, 1.0]);
    }
    entry
}

/// Whether it shows its colour and its image as they are, and nothing else.
pub(in crate::export) fn is_unlit(material: &Material) -> bool {
    let rest = [material.kd, material.ks, material.ks_tinted, material.emission];
    let has_images = material.emission_texture.is_some() || material.normal_texture.is_some();
    material.emission_tinted != Vec3::ZERO
        && rest == [Vec3::ZERO; 4]
        && material.emission_tinted.max_element() <= 1.0
        && !has_images
        && material.dielectric.is_none()
}

/// What other programs see it emit.
pub(in crate::export) fn shown_emission(material: &Material) -> Vec3 {
    // What is shown as it is has no image of emitted light that would be multiplied with this.
    if material.texture.is_none() { material.emission + material.emission_tinted } else { material.emission }
}

/// Whether an `alphaMode` says where the surface is, for other programs at least.
pub(in crate::export) fn has_alpha(opacity: &Opacity, material: &Material) -> bool {
    is_standard(opacity, material)
        || (material.dielectric.is_none()
            && (needs_composing(opacity, material) || opacity.texture == material.texture))
}

/// Glass for other programs.
fn transmission(Dielectric { ior, thin, absorption }: &Dielectric, opacity: &Opacity) -> Vec<(&'static str, Value)> {
    let share = (1.0 - opacity.factor).clamp(0.0, 1.0);
    let mut extensions = vec![(IOR, json!({"ior": ior})), (TRANSMISSION, json!({"transmissionFactor": share}))];
    if !thin {
        let left = absorption.map(|channel| (-channel).exp().clamp(0.0, 1.0)).to_array();
        let volume = json!({"thicknessFactor": 1.0, "attenuationColor": left, "attenuationDistance": 1.0});
        extensions.push((VOLUME, volume));
    }
    extensions
}

/// Whether an `alphaMode` says the same.
fn is_standard(opacity: &Opacity, material: &Material) -> bool {
    let alpha = opacity.texture.is_none() || opacity.channel == OpacityChannel::Alpha;
    alpha
        && material.dielectric.is_none()
        && opacity.texture == material.texture
        && opacity.filter().is_none_or(|filter| filter == Vec3::ONE)
}

fn opacity_extras(opacity: &Opacity, index: usize, pictures: &Pictures) -> OpacityExtras {
    let found = pictures.opacity_of_material(index);
    OpacityExtras {
        factor: opacity.factor,
        cutoff: match opacity.mode {
            OpacityMode::Mask { cutoff } => Some(cutoff),
            OpacityMode::Blend { .. } => None,
        },
        filter: opacity.filter().map(|filter| filter.to_array()),
        texture: found.map(|(texture, _)| texture as u32),
        transform: found.map(|(_, uses)| uses.transform.to_cols_array()),
        channel: found.map(|_| opacity.channel.name().to_owned()),
    }
}
