//! Textures at all sizes: mip levels, and what a footprint of any size sees.
//!
//! ```text
//! level 0        the image: 8-bit sRGB texels
//! level k + 1    half as many texels along each axis, rounded up; each is the mean of the area of level k that it covers, in linear light
//! ```
//!
//! Levels are built once, with the acceleration structure ([`MipLevels`]). A footprint, the ellipse of the texture that a sample of a pixel
//! sees ([`footprint`](crate::footprint)), is averaged by [`filtered`]. Twin of the lookups: `lookup.cuh`.

mod levels;
mod lookup;
mod neighbours;

pub(crate) use levels::{Level, MipLevels};
pub(crate) use lookup::{between, bilinear, filtered, level_of};
pub(crate) use neighbours::neighbours;

use lightmesh_scene::{Geometry, Material, Texture, TextureUse};

/// The images that colour a material and what it emits, those that can be looked up.
pub(crate) fn images_of<'s>(geometry: &'s Geometry, material: &Material) -> [Option<(TextureUse, &'s Texture)>; 2] {
    [material.texture, material.emission_texture].map(|uses| usable(geometry, uses?))
}

/// A texture that is used like this, if it can be looked up.
pub(crate) fn usable(geometry: &Geometry, uses: TextureUse) -> Option<(TextureUse, &Texture)> {
    if geometry.mesh.uvs.is_empty() {
        return None;
    }
    let texture = geometry.textures.get(uses.texture as usize)?;
    let count = u64::from(texture.size[0]) * u64::from(texture.size[1]);
    (count > 0 && texture.texels.len() as u64 == count).then_some((uses, texture))
}
