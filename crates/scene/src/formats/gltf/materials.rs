//! Adds the materials of a file to the draft, with their textures, and chooses those of primitives.

use std::path::Path;

use glam::Affine2;

use super::{
    document::{self, Document, Primitive, TextureInfo},
    extras::{ColorExtras, OpacityExtras},
    left_out::LeftOut,
    material,
    picture::Pictures,
};
use crate::build::draft::Draft;
use crate::build::placement::Placement;
use crate::{LoadError, Material, NormalMap, Opacity, OpacityChannel, OpacityMode, TextureUse};

/// Materials by their number in the file.
#[derive(Default)]
pub(super) struct Materials {
    /// Replaces all materials of the file.
    replacement: Option<u32>,
    read: Vec<Read>,
    /// Index of glTF's own default material, once a primitive has used it.
    default: Option<u32>,
}

/// The image of our own extras, with the set of texture coordinates.
fn color(own: &ColorExtras, pictures: &mut Pictures, draft: &mut Draft) -> Option<(TextureUse, u32)> {
    let (uses, set) = pictures.find(&TextureInfo { index: own.texture?, tex_coord: 0, extensions: None }, draft)?;
    let transform = own.transform.map_or(Affine2::IDENTITY, |columns| Affine2::from_cols_array(&columns));
    Some((TextureUse { transform, ..uses }, set))
}

/// What our own extras say.
fn opacity(own: &OpacityExtras, pictures: &mut Pictures, draft: &mut Draft) -> Opacity {
    let info = own.texture.map(|index| TextureInfo { index, tex_coord: 0, extensions: None });
    let found = info.and_then(|info| pictures.find(&info, draft));
    let transform = own.transform.map_or(Affine2::IDENTITY, |columns| Affine2::from_cols_array(&columns));
    let channel = OpacityChannel::ALL.iter().find(|channel| own.channel.as_deref() == Some(channel.name()));
    Opacity {
        texture: found.map(|(uses, _)| TextureUse { transform, ..uses }),
        channel: channel.copied().unwrap_or_default(),
        factor: own.factor,
        mode: match own.filter {
            Some(filter) => OpacityMode::Blend { filter: filter.into() },
            None => OpacityMode::Mask { cutoff: own.cutoff.unwrap_or(Opacity::CUTOFF) },
        },
    }
}

/// A further image of a material. It must have the `set` of texture coordinates of those before, if there are any: a vertex has one pair.
/// Else it is counted.
fn further(
    info: &TextureInfo,
    set: &mut Option<u32>,
    misplaced: &mut usize,
    pictures: &mut Pictures,
    draft: &mut Draft,
) -> Option<TextureUse> {
    let (uses, own) = pictures.find(info, draft)?;
    if set.is_some_and(|set| set != own) {
        *misplaced += 1;
        return None;
    }
    *set = Some(own);
    Some(uses)
}

/// A material of the file.
#[derive(Clone, Copy, PartialEq)]
struct Read {
    /// Index in the draft.
    material: u32,
    /// The set of texture coordinates that its texture needs.
    set: Option<u32>,
    /// Whether the alpha of vertex colours counts.
    opacity: bool,
}

/// The material of a primitive, and the attributes it needs.
pub(super) struct Chosen {
    /// Index in the draft.
    pub(super) material: u32,
    /// Accessor of the texture coordinates.
    pub(super) uvs: Option<u32>,
    /// Accessor of the vertex colours.
    pub(super) colors: Option<u32>,
    /// The same if their alpha counts.
    pub(super) opacities: Option<u32>,
}

impl Materials {
    /// Adds the document's materials to the draft, in its order, unless the placement replaces them.
    pub(super) fn read(
        path: &Path,
        document: &Document,
        mut pictures: Pictures,
        placement: &Placement,
        left_out: &mut LeftOut,
        draft: &mut Draft,
    ) -> Result<Materials, LoadError> {
        let mut materials = Materials { replacement: placement.material, ..Materials::default() };
        if placement.material.is_some() {
            return Ok(materials);
        }
        for (index, entry) in document.materials.iter().enumerate() {
            material::count_left_out(entry, left_out);
            let info = entry.pbr_metallic_roughness.as_deref().and_then(|pbr| pbr.base_color_texture.as_ref());
            let own = material::own_extras(path, index, entry)?;
            let own = own.as_ref();
            let found = match own.and_then(|own| own.color.as_ref()) {
                Some(own) => color(own, &mut pictures, draft),
                None => info.and_then(|info| pictures.find(info, draft)),
            };
            let material = material::read(entry, own);
            let (mut texture, mut set) = found.unzip();
            let (mut emission, mut emission_texture) = (material.emission, None);
            if let Some(info) = material::emissive_texture(entry) {
                emission_texture = further(info, &mut set, &mut left_out.emissive_textures, &mut pictures, draft);
                if emission_texture.is_none() {
                    emission = Material::EMISSION_WITHOUT_IMAGE;
                }
            }
            let (normals, misplaced) = (material::normal_texture(entry), &mut left_out.normal_textures);
            let mut normal_texture = normals.and_then(|normals| {
                let uses = further(&normals.info, &mut set, misplaced, &mut pictures, draft)?;
                Some(NormalMap { uses, scale: normals.scale })
            });
            let misplaced = &mut left_out.roughness_textures;
            let mut metallic_roughness_texture = material::metallic_roughness_texture(entry)
                .and_then(|info| further(info, &mut set, misplaced, &mut pictures, draft));
            let exact = material::texture_transforms(own);
            let normals = normal_texture.as_mut().map(|map| &mut map.uses);
            let textures = [texture.as_mut(), emission_texture.as_mut(), normals, metallic_roughness_texture.as_mut()];
            for (texture, exact) in textures.into_iter().zip(exact) {
                if let (Some(texture), Some(exact)) = (texture, exact) {
                    texture.transform = exact;
                }
            }
            let opacity = match own.and_then(|own| own.opacity.as_ref()) {
                Some(own) => Some(opacity(own, &mut pictures, draft)),
                None => material::opacity(entry, texture),
            };
            materials.read.push(Read { material: draft.materials.len() as u32, set, opacity: opacity.is_some() });
            draft.materials.push(Material {
                texture,
                emission,
                emission_texture,
                normal_texture,
                metallic_roughness_texture,
                opacity,
                ..material
            });
        }
        left_out.missing_textures += pictures.missing;
        Ok(materials)
    }

    /// The material of a primitive, and which of its attributes the material needs.
    pub(super) fn choose(&mut self, primitive: &Primitive, left_out: &mut LeftOut, draft: &mut Draft) -> Chosen {
        let attributes = &primitive.attributes;
        let (first, colors) = (attributes.texcoord_0, attributes.color_0);
        if let Some(material) = self.replacement {
            // Vertex colours belong to the file, as its materials do.
            return Chosen { material, uvs: first, colors: None, opacities: None };
        }
        let named = primitive.material.map(|material| self.read.get(material as usize));
        left_out.missing_materials += usize::from(named == Some(None));
        let Read { material, set, opacity } = match named.flatten() {
            Some(&found) => found,
            None => Read { material: self.default_material(draft), set: None, opacity: false },
        };
        let uvs = match set {
            None | Some(0) => first,
            Some(1) => attributes.texcoord_1,
            Some(_) => None,
        };
        Chosen { material, uvs, colors, opacities: colors.filter(|_| opacity) }
    }

    fn default_material(&mut self, draft: &mut Draft) -> u32 {
        *self.default.get_or_insert_with(|| {
            draft.materials.push(material::translated(&document::Material::default()));
            draft.materials.len() as u32 - 1
        })
    }
}
