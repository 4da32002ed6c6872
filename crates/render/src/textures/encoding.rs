//! What the numbers of an image say. One image may be used as colours by a material, and as data by another.

use glam::Vec3;
use lightmesh_image::Transfer;

/// What the numbers of an image say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// Colours, encoded as sRGB.
    Color,
    /// Data, such as directions, as they are.
    Data,
}

impl Encoding {
    /// All of them, by number.
    pub(crate) const ALL: [Encoding; 2] = [Encoding::Color, Encoding::Data];

    /// The linear value of a code.
    #[inline(always)]
    pub(crate) fn decode(self, code: u8) -> f32 {
        match self {
            Encoding::Color => Transfer::Srgb.decode(code),
            Encoding::Data => f32::from(code) / f32::from(u8::MAX),
        }
    }

    /// The linear values of a texel.
    #[inline(always)]
    pub fn linear(self, [r, g, b, _]: [u8; 4]) -> Vec3 {
        Vec3::new(self.decode(r), self.decode(g), self.decode(b))
    }
}
