//! Textures: images that colour surfaces, turn their normals, or say how rough they are.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use glam::Affine2;
use serde::{Deserialize, Serialize};

/// An image in memory.
///
/// Eight bits per channel: colours encoded as sRGB, or the data of a [`NormalMap`] or of
/// [facets](crate::Material::metallic_roughness_texture); row 0 is the top, texture coordinate (0, 0) its upper left corner, as in glTF.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Texture {
    /// For display: the file's name, or its index in the file that contains it.
    pub name: String,
    /// Width and height in texels, at least 1.
    pub size: [u32; 2],
    /// Red, green, blue and alpha, row by row. Alpha counts where a material is [cut out](crate::Opacity) by it.
    #[serde(with = "super::packed")]
    pub texels: Vec<[u8; 4]>,
}

/// The textures of a geometry: a list that clones share until one of them is changed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Textures(Arc<Vec<Texture>>);

impl Textures {
    /// Whether both are the same list in memory.
    pub fn are_shared_with(&self, other: &Textures) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Deref for Textures {
    type Target = Vec<Texture>;

    fn deref(&self) -> &Vec<Texture> {
        &self.0
    }
}

impl DerefMut for Textures {
    fn deref_mut(&mut self) -> &mut Vec<Texture> {
        Arc::make_mut(&mut self.0)
    }
}

impl From<Vec<Texture>> for Textures {
    fn from(textures: Vec<Texture>) -> Textures {
        Textures(textures.into())
    }
}

/// How a texture continues beyond its edge, along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Wrap {
    /// Repeated.
    #[default]
    Repeat,
    /// Repeated, mirrored every other time.
    Mirror,
    /// The outermost texels.
    Clamp,
}

/// A texture on a material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TextureUse {
    /// Index of the texture in the scene.
    pub texture: u32,
    /// Wrapping beyond the edge, horizontally and vertically.
    pub wrap: [Wrap; 2],
    /// The transform from texture coordinates to those of the image.
    pub transform: Affine2,
}

impl TextureUse {
    /// The texture without a transform, repeated.
    pub fn new(texture: u32) -> TextureUse {
        TextureUse { texture, wrap: [Wrap::Repeat; 2], transform: Affine2::IDENTITY }
    }
}

/// An image of normals on a material: of directions in which the surface would face if it had the relief that the image stands for.
///
/// Red is the direction in which the image goes on to the right, green that to its top, and blue that of the surface, as in glTF: 128 is 0
/// and 255 is 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NormalMap {
    /// The image, and how it is placed.
    pub uses: TextureUse,
    /// What slopes are multiplied with: 0 is flat, negative numbers make dents of bumps.
    pub scale: f32,
}

impl NormalMap {
    /// An image with the slopes that it has.
    pub fn new(uses: TextureUse) -> NormalMap {
        NormalMap { uses, scale: 1.0 }
    }

    /// The same with slopes multiplied by `scale`.
    pub fn with_scale(self, scale: f32) -> NormalMap {
        NormalMap { scale, ..self }
    }
}
