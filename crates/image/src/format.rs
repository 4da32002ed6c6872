//! Image formats: extensions for writing, signatures for reading.

use std::path::Path;

#[cfg(feature = "bmp")]
use crate::bmp::layout;

/// Maximum number of pixels in a file: 16384 x 16384, 3 GiB of colours.
pub(crate) const MAX_PIXELS: usize = 1 << 28;
/// JPEG stores sizes in 16 bits.
const MAX_JPG_SIDE: u32 = 65_535;

/// An image format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Windows bitmap, 24 bits per pixel, uncompressed.
    Bmp,
    /// Portable Network Graphics, 8 bits per channel.
    Png,
    /// OpenEXR, linear 32-bit floats.
    Exr,
    /// JPEG, 8 bits per channel, lossy.
    Jpg,
}

impl Format {
    /// The extensions of the format, the preferred one first.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Bmp => &["bmp"],
            Self::Png => &["png"],
            Self::Exr => &["exr"],
            Self::Jpg => &["jpg", "jpeg"],
        }
    }

    /// The format of the extension of `path`, in upper or lower case.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?;
        Self::ALL
            .iter()
            .copied()
            .find(|format| format.extensions().iter().any(|known| extension.eq_ignore_ascii_case(known)))
    }

    /// The Cargo feature of this crate that the format needs.
    pub fn feature(self) -> &'static str {
        match self {
            Self::Bmp => "bmp",
            Self::Png => "png",
            Self::Exr => "exr",
            Self::Jpg => "jpeg",
        }
    }

    /// Whether this crate was built with the format's feature.
    pub fn is_built(self) -> bool {
        match self {
            Self::Bmp => cfg!(feature = "bmp"),
            Self::Png => cfg!(feature = "png"),
            Self::Exr => cfg!(feature = "exr"),
            Self::Jpg => cfg!(feature = "jpeg"),
        }
    }

    /// The format's limit as text, if an image of this size exceeds it.
    pub(crate) fn exceeded_limit(self, width: u32, height: u32) -> Option<&'static str> {
        let longest = width.max(height);
        let (exceeded, limit) = match self {
            #[cfg(feature = "bmp")]
            Self::Bmp => (!layout::can_hold(width, height), layout::LIMIT),
            #[cfg(feature = "jpeg")]
            Self::Jpg => (longest > MAX_JPG_SIDE, "65535 pixels per side"),
            _ => (longest > i32::MAX as u32, "2147483647 pixels per side"),
        };
        exceeded.then_some(limit)
    }

    /// The format whose signature starts `bytes`.
    pub(crate) fn from_signature(bytes: &[u8]) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| bytes.starts_with(format.signature()))
    }

    pub(crate) fn signature(self) -> &'static [u8] {
        match self {
            Self::Bmp => b"BM",
            Self::Png => b"\x89PNG\r\n\x1a\n",
            Self::Exr => b"\x76\x2f\x31\x01",
            Self::Jpg => b"\xff\xd8\xff",
        }
    }

    /// The extensions of all formats that the crate was built with, for messages.
    pub(crate) fn known() -> String {
        let built = Self::ALL.iter().copied().filter(|format| format.is_built());
        let extensions: Vec<_> = built.flat_map(|format| format.extensions()).copied().collect();
        extensions.join(", ")
    }
}
