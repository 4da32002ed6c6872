//! Opacity: surfaces that are only where it says so, such as leaves and fences on a few triangles, and such that let a share of the light
//! through, such as curtains and tinted glass.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::{Texture, TextureUse};

/// Which part of a texel is its opacity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
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

/// What an opacity below 1 means.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum OpacityMode {
    /// There is a surface where the opacity is at least the cutoff; elsewhere nothing is hit, hidden or shaded.
    Mask {
        /// The least opacity at which there is a surface. At 0 it is everywhere.
        cutoff: f32,
    },
    /// The surface shows that share of what it would if it was opaque. The rest of the light goes straight on, times a colour (glTF's
    /// `alphaMode` BLEND, with white).
    Blend {
        /// The share of each channel, from 0 to 1, that is left of the light that goes through.
        filter: Vec3,
    },
}

/// How much of a surface is there: the product of `factor`, the texture's channel and the [opacity of vertices](crate::Mesh::opacities),
/// all from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Opacity {
    /// The image; without one its part is 1.
    pub texture: Option<TextureUse>,
    /// What of the image counts.
    pub channel: OpacityChannel,
    /// Opacity of the whole surface.
    pub factor: f32,
    /// What it means.
    pub mode: OpacityMode,
}

impl Default for Opacity {
    /// 1 everywhere, and a mask.
    fn default() -> Opacity {
        Opacity {
            texture: None,
            channel: OpacityChannel::Alpha,
            factor: 1.0,
            mode: OpacityMode::Mask { cutoff: Opacity::CUTOFF },
        }
    }
}

impl Opacity {
    /// The cutoff where none is given.
    pub const CUTOFF: f32 = 0.5;

    /// What is less opaque and does not filter is not there: half the smallest step of an image's opacities.
    pub const LEAST: f32 = 0.5 / 255.0;

    /// That of a whole surface, of which light goes through in part.
    pub fn blend(factor: f32) -> Opacity {
        Opacity { factor, mode: OpacityMode::Blend { filter: Vec3::ONE }, ..Opacity::default() }
    }

    /// By a channel of a texture, as a mask.
    pub fn by(texture: TextureUse, channel: OpacityChannel) -> Opacity {
        Opacity { texture: Some(texture), channel, ..Opacity::default() }
    }

    /// As a mask with this cutoff.
    pub fn with_cutoff(self, cutoff: f32) -> Opacity {
        Opacity { mode: OpacityMode::Mask { cutoff }, ..self }
    }

    /// With this colour for light that goes through.
    pub fn with_filter(self, filter: impl Into<Vec3>) -> Opacity {
        Opacity { mode: OpacityMode::Blend { filter: filter.into() }, ..self }
    }

    /// The colour that is left of white light that goes through; `None` if it is a mask.
    pub fn filter(&self) -> Option<Vec3> {
        match self.mode {
            OpacityMode::Blend { filter } => Some(filter),
            OpacityMode::Mask { .. } => None,
        }
    }

    /// Whether there is no surface anywhere.
    pub(crate) fn is_nowhere(&self) -> bool {
        let within = |limit: f32| self.texture.is_none() && self.factor < limit;
        match self.mode {
            OpacityMode::Mask { cutoff } => within(cutoff),
            OpacityMode::Blend { filter } => filter == Vec3::ONE && within(Opacity::LEAST),
        }
    }

    /// With another opacity of the whole surface.
    pub fn with_factor(self, factor: f32) -> Opacity {
        Opacity { factor, ..self }
    }
}
