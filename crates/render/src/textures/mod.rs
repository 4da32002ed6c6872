//! Textures at all sizes: mip levels, and what a footprint of any size sees.
//!
//! ```text
//! level 0        the image: 8 bits per channel, sRGB or linear data
//! level k + 1    half as many texels along each axis, rounded up; each is the mean of the area of level k that it covers, of linear values
//! ```
//!
//! Levels are built once, with the acceleration structure ([`MipLevels`]). A footprint, the ellipse of the texture that a sample of a pixel
//! sees ([`footprint`](crate::footprint)), is averaged by [`filtered`]. Twin of the lookups: `lookup.cuh`.

pub(crate) mod encoding;
pub(crate) mod levels;
pub(crate) mod lookup;

pub(crate) use encoding::Encoding;
pub(crate) use levels::{AllLevels, Level, MipLevels};
pub(crate) use lookup::{between, bilinear, filtered, level_of};

use lightmesh_scene::{Geometry, Material, Texture, TextureUse};
use lightmesh_trace::textures::usable;

/// An image of a material that can be looked up.
#[derive(Clone, Copy, Debug)]
pub struct Image<'s> {
    /// Which texture it is, and how it is laid out.
    pub uses: TextureUse,
    /// Its texels.
    pub texture: &'s Texture,
    /// What its texels mean.
    pub encoding: Encoding,
}

impl<'s> Image<'s> {
    fn new(geometry: &'s Geometry, uses: TextureUse, encoding: Encoding) -> Option<Image<'s>> {
        let (uses, texture) = usable(geometry, uses)?;
        Some(Image { uses, texture, encoding })
    }
}

/// The images of a material, except that of its opacity: of its colour, of what it emits, of its normals, and of its facets.
pub(crate) fn images_of<'s>(geometry: &'s Geometry, material: &Material) -> [Option<Image<'s>>; 4] {
    let [color, glow] =
        [material.texture, material.emission_texture].map(|uses| Image::new(geometry, uses?, Encoding::Color));
    [color, glow, normals_of(geometry, material), facets_of(geometry, material)]
}

/// The image of a material's normals.
pub(crate) fn normals_of<'s>(geometry: &'s Geometry, material: &Material) -> Option<Image<'s>> {
    Image::new(geometry, material.normal_texture?.uses, Encoding::Data)
}

/// The image of how rough and metallic a material's facets are.
pub(crate) fn facets_of<'s>(geometry: &'s Geometry, material: &Material) -> Option<Image<'s>> {
    material.faceted()?;
    Image::new(geometry, material.metallic_roughness_texture?, Encoding::Data)
}
