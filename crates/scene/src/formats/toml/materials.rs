//! `[[material]]` to materials and their textures.

use std::{collections::HashMap, ops::Range};

use glam::{Affine2, DVec2, Vec2, Vec3};

use super::{
    check::Source,
    schema::{MaterialEntry, TextureScale, TextureWrap, WrapName},
    spanned::Spanned,
    values::{Color, Number, Text},
};
use crate::build::draft::Draft;
use crate::{Dielectric, Facets, LoadError, Material, NormalMap, Opacity, OpacityChannel, TextureUse, Wrap};

/// Adds the file's materials and returns the index of each name.
pub(super) fn read(
    source: &Source,
    entries: &[Spanned<MaterialEntry>],
    draft: &mut Draft,
) -> Result<HashMap<String, u32>, LoadError> {
    let mut names = HashMap::new();
    for entry in entries.iter().map(Spanned::get_ref) {
        if names.insert(entry.name.get_ref().clone(), draft.materials.len() as u32).is_some() {
            let remedy = "give every material a name of its own";
            return Err(source.refuse("name", &entry.name, "is used by an earlier material", remedy));
        }
        let placed = placed(source, entry)?;
        let find = |draft: &mut Draft, file: &Option<Text>| {
            let texture = draft.texture_file(source.path, file.as_ref()?.get_ref())?;
            Some(TextureUse { texture, ..placed })
        };
        let texture = find(draft, &entry.texture);
        let opacity = opacity(source, entry, find(draft, &entry.opacity_texture), draft)?;
        let dielectric = dielectric(source, entry)?;
        let metallic_roughness_texture = find(draft, &entry.metallic_roughness_texture);
        let coefficients = coefficients(source, entry, metallic_roughness_texture.is_some())?;
        let mut material = Material { texture, metallic_roughness_texture, opacity, dielectric, ..coefficients };
        if entry.emission_texture.is_some() {
            material.emission_texture = find(draft, &entry.emission_texture);
            material.emission = match material.emission_texture {
                None => Material::EMISSION_WITHOUT_IMAGE,
                Some(_) if entry.emission.is_none() => Vec3::ONE,
                Some(_) => material.emission,
            };
        }
        let scale = normal_scale(source, entry)?;
        material.normal_texture = find(draft, &entry.normal_texture).map(|uses| NormalMap { uses, scale });
        draft.materials.push(material);
    }
    Ok(names)
}

/// `varied`: whether an image says how rough and metallic it is.
fn coefficients(source: &Source, entry: &MaterialEntry, varied: bool) -> Result<Material, LoadError> {
    let default = Material::default();
    let kd = entry.kd.as_ref().map_or(Ok(default.kd), |kd| source.color("kd", kd))?;
    let shininess = match &entry.shininess {
        Some(shininess) => source.positive("shininess", shininess)? as f32,
        None => default.shininess,
    };
    let facets = facets(source, entry, varied)?;
    let ks = if facets.is_some() { Vec3::splat(Facets::LAYER) } else { default.ks };
    Ok(Material {
        name: entry.name.get_ref().clone(),
        ka: entry.ka.as_ref().map_or(Ok(kd), |ka| source.color("ka", ka))?,
        kd,
        ks: entry.ks.as_ref().map_or(Ok(ks), |ks| source.color("ks", ks))?,
        shininess,
        facets,
        emission: entry.emission.as_ref().map_or(Ok(default.emission), |color| source.color("emission", color))?,
        lamp: true,
        ..default
    })
}

/// How rough and metallic the surface is, if that is said. An image whose factor is not given counts as it is; one that is not available does
/// not make a metal.
fn facets(source: &Source, entry: &MaterialEntry, varied: bool) -> Result<Option<Facets>, LoadError> {
    let share =
        |key, value: &Option<Number>| value.as_ref().map(|value| source.between(key, value, 0.0, 1.0)).transpose();
    let (roughness, metallic) = (share("roughness", &entry.roughness)?, share("metallic", &entry.metallic)?);
    if roughness.is_none() && metallic.is_none() && entry.metallic_roughness_texture.is_none() {
        return Ok(None);
    }
    if let Some(shininess) = &entry.shininess {
        let remedy = match entry.metallic_roughness_texture {
            None => "remove it, or `roughness` and `metallic`",
            Some(_) => "remove it, or `roughness`, `metallic` and `metallic_roughness_texture`",
        };
        return Err(source.refuse("shininess", shininess, "has no effect on facets", remedy));
    }
    if let Some(ior) = &entry.ior {
        let remedy = match entry.metallic_roughness_texture {
            None => "remove `roughness` and `metallic`, or write `ks` in place of `ior`",
            Some(_) => "remove it, or `roughness`, `metallic` and `metallic_roughness_texture`",
        };
        return Err(source.refuse("ior", ior, "makes the surface glass, which has no facets", remedy));
    }
    let unsaid = if varied { 1.0 } else { 0.0 };
    let [roughness, metallic] = [roughness.unwrap_or(1.0), metallic.unwrap_or(unsaid)].map(|share| share as f32);
    Ok(Some(Facets::new(roughness).with_metallic(metallic)))
}

/// How the material's textures are placed. Fails if there are none to be placed.
fn placed(source: &Source, entry: &MaterialEntry) -> Result<TextureUse, LoadError> {
    let wrap = entry.texture_wrap.as_ref().map_or([Wrap::Repeat; 2], |wrap| match *wrap.get_ref() {
        TextureWrap::Both(word) => [word.into(); 2],
        TextureWrap::Each(words) => words.map(Wrap::from),
    });
    let transform = transform(source, entry)?;
    let colors = [&entry.texture, &entry.emission_texture];
    let images = [&entry.normal_texture, &entry.metallic_roughness_texture, &entry.opacity_texture];
    let mut images = colors.into_iter().chain(images);
    if let (true, Some((key, line))) = (images.all(|image| image.is_none()), without_texture(entry)) {
        return Err(source.refuse(key, &line, "has no effect without a texture", "add `texture = \"FILE\"`"));
    }
    Ok(TextureUse { wrap, transform, ..TextureUse::new(0) })
}

/// What slopes of the image of normals are multiplied with.
fn normal_scale(source: &Source, entry: &MaterialEntry) -> Result<f32, LoadError> {
    let Some(scale) = &entry.normal_scale else { return Ok(1.0) };
    if entry.normal_texture.is_none() {
        let remedy = "add `normal_texture = \"FILE\"`";
        return Err(source.refuse("normal_scale", scale, "has no effect without an image of normals", remedy));
    }
    Ok(source.number("normal_scale", scale)? as f32)
}

/// What the surface lets through; else where it is, if its opacity has a texture and that is available.
fn opacity(
    source: &Source,
    entry: &MaterialEntry,
    texture: Option<TextureUse>,
    draft: &Draft,
) -> Result<Option<Opacity>, LoadError> {
    let by_texture = texture.map(|uses| {
        let channel = OpacityChannel::suggested_by(&draft.textures[uses.texture as usize]);
        Opacity::by(uses, channel)
    });
    let mask = entry.opacity_cutoff.as_ref().map(|value| cutoff(source, entry, value)).transpose()?;
    let filter = entry.filter.as_ref().map(|filter| passive_filter(source, entry, filter)).transpose()?;
    if entry.opacity.is_none() && filter.is_none() && entry.ior.is_none() {
        return Ok(by_texture.map(|opacity| opacity.with_cutoff(mask.unwrap_or(Opacity::CUTOFF))));
    }
    let unsaid = if entry.ior.is_some() && entry.opacity_texture.is_none() { 0.0 } else { 1.0 };
    let opacity = entry.opacity.as_ref().map(|value| source.between("opacity", value, 0.0, 1.0)).transpose()?;
    let factor = opacity.unwrap_or(unsaid) as f32;
    Ok(Some(by_texture.unwrap_or_default().with_factor(factor).with_filter(filter.unwrap_or(Vec3::ONE))))
}

/// The cutoff, if there is something to cut out.
fn cutoff(source: &Source, entry: &MaterialEntry, value: &Number) -> Result<f32, LoadError> {
    let refuse = |fault, remedy| Err(source.refuse("opacity_cutoff", value, fault, remedy));
    if entry.opacity_texture.is_none() {
        return refuse("has no effect without an opacity texture", "add `opacity_texture = \"FILE\"`");
    }
    if entry.opacity.is_some() || entry.filter.is_some() || entry.ior.is_some() {
        return refuse("has no effect where light goes through", "remove it, or `opacity`, `filter` and `ior`");
    }
    Ok(source.between("opacity_cutoff", value, 0.0, 1.0)? as f32)
}

/// How light is reflected and bent.
fn dielectric(source: &Source, entry: &MaterialEntry) -> Result<Option<Dielectric>, LoadError> {
    let thin = entry.thin.as_ref().is_some_and(|thin| *thin.get_ref());
    let Some(ior) = &entry.ior else {
        let keys = [
            ("thin", entry.thin.as_ref().map(Spanned::span)),
            ("absorption", entry.absorption.as_ref().map(Spanned::span)),
        ];
        let Some((key, place)) = present(keys) else { return Ok(None) };
        return Err(source.refuse(key, &place, "has no effect without an index of refraction", "add `ior = 1.5`"));
    };
    let glass = Dielectric::new(source.positive("ior", ior)? as f32).with_thin(thin);
    match &entry.absorption {
        Some(absorption) if thin => {
            let remedy = "remove it, or `thin`";
            Err(source.refuse("absorption", absorption, "has no effect in a wall without thickness", remedy))
        }
        Some(absorption) => Ok(Some(glass.with_absorption(source.color("absorption", absorption)?))),
        None => Ok(Some(glass)),
    }
}

/// What is left of light that goes through, if any does.
fn passive_filter(source: &Source, entry: &MaterialEntry, value: &Spanned<Color>) -> Result<Vec3, LoadError> {
    let filter = source.color("filter", value)?;
    if filter.max_element() > 1.0 {
        return Err(source.refuse("filter", value, "adds light that is not there", "write numbers from 0 to 1"));
    }
    if entry.opacity.is_none() && entry.opacity_texture.is_none() && entry.ior.is_none() {
        return Err(source.refuse("filter", value, "has no effect on an opaque surface", "add `opacity = 0`"));
    }
    Ok(filter)
}

/// A key that requires a texture, if it is present without one.
fn without_texture(entry: &MaterialEntry) -> Option<(&'static str, Spanned<()>)> {
    let keys = [
        ("texture_wrap", entry.texture_wrap.as_ref().map(Spanned::span)),
        ("texture_scale", entry.texture_scale.as_ref().map(Spanned::span)),
        ("texture_rotate", entry.texture_rotate.as_ref().map(Spanned::span)),
        ("texture_offset", entry.texture_offset.as_ref().map(Spanned::span)),
    ];
    present(keys)
}

/// The first key that is present.
fn present<const N: usize>(keys: [(&'static str, Option<Range<usize>>); N]) -> Option<(&'static str, Spanned<()>)> {
    keys.into_iter().find_map(|(key, span)| Some((key, Spanned::new(span?, ()))))
}

/// Scaled, then rotated, then translated: the order of KHR_texture_transform.
fn transform(source: &Source, entry: &MaterialEntry) -> Result<Affine2, LoadError> {
    let mut scale = Vec2::ONE;
    if let Some(value) = &entry.texture_scale {
        let factors = match *value.get_ref() {
            TextureScale::Both(factor) => [factor; 2],
            TextureScale::Each(factors) => factors,
        };
        source.all_finite("texture_scale", value, &factors)?;
        scale = DVec2::from(factors).as_vec2();
    }
    let turn = entry.texture_rotate.as_ref().map_or(Ok(0.0), |turn| source.number("texture_rotate", turn))?;
    let mut offset = Vec2::ZERO;
    if let Some(value) = &entry.texture_offset {
        source.all_finite("texture_offset", value, value.get_ref())?;
        offset = DVec2::from(*value.get_ref()).as_vec2();
    }
    Ok(Affine2::from_scale_angle_translation(scale, turn.to_radians() as f32, offset))
}

impl From<WrapName> for Wrap {
    fn from(name: WrapName) -> Wrap {
        match name {
            WrapName::Repeat => Wrap::Repeat,
            WrapName::Mirror => Wrap::Mirror,
            WrapName::Clamp => Wrap::Clamp,
        }
    }
}
