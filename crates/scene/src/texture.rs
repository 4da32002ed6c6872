//! Textures: images that colour surfaces.

mod decode;
mod files;
mod missing_uvs;

use glam::Affine2;

pub(crate) use decode::decode;
pub(crate) use files::TextureFiles;
pub(crate) use missing_uvs::untextured;

/// An image in memory.
///
/// Eight bits a channel, encoded as sRGB; row 0 is the top, texture coordinate (0, 0) its left upper corner, as in glTF.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// For people: the file's name, or its number in the file that holds it.
    pub name: String,
    /// Width and height in texels, at least 1.
    pub size: [u32; 2],
    /// Red, green, blue and coverage, row by row. Coverage is kept for export; surfaces are opaque.
    pub texels: Vec<[u8; 4]>,
}

/// What a texture shows beyond its edge, on one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The same again.
    #[default]
    Repeat,
    /// The same again, every other time mirrored.
    Mirror,
    /// Its outermost texels.
    Clamp,
}

/// A texture on a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index of the texture in the scene.
    pub texture: u32,
    /// Beyond the edge, horizontally and vertically.
    pub wrap: [Wrap; 2],
    /// From texture coordinates to those of the image.
    pub transform: Affine2,
}

impl TextureUse {
    /// The texture as it is, repeated.
    pub fn new(texture: u32) -> TextureUse {
        TextureUse { texture, wrap: [Wrap::Repeat; 2], transform: Affine2::IDENTITY }
    }
}
