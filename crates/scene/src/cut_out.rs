//! Cut-outs: surfaces that are only where their opacity says so, such as leaves and fences on a few triangles.

use crate::{Texture, TextureUse};

/// Which part of a texel is its opacity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum OpacityChannel {
    /// Alpha.
    #[default]
    Alpha,
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// The weighted mean of the colours, as they are encoded.
    Luminance,
}

impl OpacityChannel {
    /// All channels.
    pub const ALL: &'static [OpacityChannel] = &[
        OpacityChannel::Alpha,
        OpacityChannel::Red,
        OpacityChannel::Green,
        OpacityChannel::Blue,
        OpacityChannel::Luminance,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            OpacityChannel::Alpha => "alpha",
            OpacityChannel::Red => "red",
            OpacityChannel::Green => "green",
            OpacityChannel::Blue => "blue",
            OpacityChannel::Luminance => "luminance",
        }
    }

    /// The opacity of a texel, from 0 to 255.
    pub fn of([r, g, b, a]: [u8; 4], channel: OpacityChannel) -> u8 {
        match channel {
            OpacityChannel::Alpha => a,
            OpacityChannel::Red => r,
            OpacityChannel::Green => g,
            OpacityChannel::Blue => b,
            // The weights of ITU-R BT.709 in 256ths; greys stay what they are.
            OpacityChannel::Luminance => {
                ((54 * u32::from(r) + 183 * u32::from(g) + 19 * u32::from(b) + 128) >> 8) as u8
            }
        }
    }

    /// That of an image of which nothing is said: alpha if there is any, else luminance.
    pub(crate) fn suggested_by(texture: &Texture) -> OpacityChannel {
        let opaque = texture.texels.iter().all(|&[.., alpha]| alpha == u8::MAX);
        if opaque { OpacityChannel::Luminance } else { OpacityChannel::Alpha }
    }
}

/// Where a surface is: nowhere that its opacity is below a cutoff. Opacity is the product of `factor`, the texture's channel and the
/// [opacity of vertices](crate::Mesh::opacities), all from 0 to 1. Where there is no surface, nothing is hit, hidden or shaded.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CutOut {
    /// The image; without one its part is 1.
    pub texture: Option<TextureUse>,
    /// What of the image counts.
    pub channel: OpacityChannel,
    /// Opacity of the whole surface.
    pub factor: f32,
    /// The least opacity at which there is a surface. At 0 it is everywhere.
    pub cutoff: f32,
}

impl Default for CutOut {
    /// Nothing is cut out; the cutoff is 0.5.
    fn default() -> CutOut {
        CutOut { texture: None, channel: OpacityChannel::Alpha, factor: 1.0, cutoff: CutOut::CUTOFF }
    }
}

impl CutOut {
    /// The cutoff where none is given.
    pub const CUTOFF: f32 = 0.5;

    /// By a channel of a texture.
    pub fn by(texture: TextureUse, channel: OpacityChannel) -> CutOut {
        CutOut { texture: Some(texture), channel, ..CutOut::default() }
    }

    /// With another cutoff.
    pub fn with_cutoff(self, cutoff: f32) -> CutOut {
        CutOut { cutoff, ..self }
    }

    /// With another opacity of the whole surface.
    pub fn with_factor(self, factor: f32) -> CutOut {
        CutOut { factor, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_of_greys_is_the_grey() {
        for grey in 0..=u8::MAX {
            assert_eq!(OpacityChannel::of([grey, grey, grey, 7], OpacityChannel::Luminance), grey);
        }
        let texel = [1, 2, 3, 4];
        let values = OpacityChannel::ALL.iter().map(|&channel| OpacityChannel::of(texel, channel));
        assert_eq!(values.collect::<Vec<_>>(), [4, 1, 2, 3, 2]);
    }

    #[test]
    fn alpha_counts_where_there_is_any() {
        let texture =
            |alpha| Texture { name: String::new(), size: [2, 1], texels: vec![[9, 9, 9, 255], [9, 9, 9, alpha]] };
        assert_eq!(OpacityChannel::suggested_by(&texture(255)), OpacityChannel::Luminance);
        assert_eq!(OpacityChannel::suggested_by(&texture(254)), OpacityChannel::Alpha);
    }
}
