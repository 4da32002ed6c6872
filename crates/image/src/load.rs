//! Loading images into linear [`Frame`]s. The format is determined by the first bytes of a file, not its name.
//!
//! Files are untrusted: sizes are checked before memory is allocated, and a truncated or damaged file is an error. Colour
//! profiles and EXIF orientation are ignored.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

#[cfg(any(feature = "bmp", feature = "jpeg"))]
use image::{DynamicImage, ImageDecoder, ImageResult};
use thiserror::Error;

#[cfg(feature = "bmp")]
use crate::bmp;
#[cfg(feature = "exr")]
use crate::exr;
use crate::frame::pixel_count;
#[cfg(feature = "jpeg")]
use crate::jpg;
#[cfg(feature = "png")]
use crate::png;
use crate::{Format, Frame, Transfer};

/// Maximum number of pixels in a file: 16384 x 16384, 3 GiB of colours.
const MAX_PIXELS: usize = 1 << 28;

/// Number of bytes that identify every format.
const SIGNATURE: usize = 8;

/// Why an image could not be loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {reason}; check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
    /// The content of the file is invalid.
    #[error("cannot load {}: {reason}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// The problem.
        reason: DecodeError,
    },
}

/// Why bytes could not be turned into a [`Frame`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum DecodeError {
    /// The first bytes do not match a known format.
    #[error("not an image in a known format; convert it to one of these: {}", Format::known())]
    UnknownFormat,
    /// This crate was built without the format.
    #[error("this program was built without {format} files: build it with the feature {}", format.feature())]
    NotBuilt {
        /// The format.
        format: Format,
    },
    /// The header specifies too many pixels, or none.
    #[error(
        "the {format} header specifies {width}x{height} pixels, but only 1 to {MAX_PIXELS} pixels are supported: scale it down"
    )]
    TooLarge {
        /// The format.
        format: Format,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// An OpenEXR file without the channels `R`, `G`, `B` or `Y` in its first part.
    #[error("the exr file has no channels R, G, B or Y, only {found}; export it with one of these sets")]
    Channels {
        /// Names of its channels.
        found: String,
    },
    /// The data violates its format, or is truncated.
    #[error("the {format} data is damaged, incomplete or unsupported ({message}): export it again")]
    Malformed {
        /// The format according to the signature.
        format: Format,
        /// The decoder's message.
        message: String,
    },
}

impl DecodeError {
    pub(crate) fn malformed(format: Format, message: impl ToString) -> Self {
        Self::Malformed { format, message: message.to_string() }
    }
}

impl Frame {
    /// Loads a bmp, png, exr or jpg file. 8-bit values are decoded from sRGB, or as linear if a png is marked so; the layers of
    /// an exr written by [`Frame::save_layers`] are loaded with it.
    ///
    /// # Errors
    /// [`LoadError`], which names the file.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, LoadError> {
        let path = path.as_ref();
        let bytes = read_picture(path).map_err(|reason| LoadError::Read { path: path.to_owned(), reason })?;
        Self::decode(&bytes).map_err(|reason| LoadError::Decode { path: path.to_owned(), reason })
    }

    /// As [`Frame::load`], from the content of a file.
    ///
    /// # Errors
    /// [`DecodeError`] for any invalid bytes.
    pub fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        match Format::from_signature(bytes).ok_or(DecodeError::UnknownFormat)? {
            #[cfg(feature = "bmp")]
            Format::Bmp => bmp::read(bytes),
            #[cfg(feature = "png")]
            Format::Png => png::read(bytes),
            #[cfg(feature = "exr")]
            Format::Exr => exr::read(bytes),
            #[cfg(feature = "jpeg")]
            Format::Jpg => jpg::read(bytes),
            #[allow(unreachable_patterns, reason = "unless all features are on")]
            format => Err(DecodeError::NotBuilt { format }),
        }
    }
}

/// The content of a file, or only its beginning if that is not an image (it may be an endless device).
fn read_picture(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let mut bytes = Vec::new();
    file.by_ref().take(SIGNATURE as u64).read_to_end(&mut bytes)?;
    if Format::from_signature(&bytes).is_some() {
        file.read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// The number of pixels, if supported.
pub(crate) fn checked_pixels(format: Format, width: u32, height: u32) -> Result<usize, DecodeError> {
    let pixels = pixel_count(width, height).filter(|&pixels| pixels <= MAX_PIXELS);
    pixels.ok_or(DecodeError::TooLarge { format, width, height })
}

#[cfg(any(feature = "bmp", feature = "jpeg"))]
/// Reads an 8-bit image with a decoder of the `image` crate, after checking its size.
pub(crate) fn read_with(format: Format, decoder: ImageResult<impl ImageDecoder>) -> Result<Frame, DecodeError> {
    let decoder = decoder.map_err(|error| DecodeError::malformed(format, error))?;
    let (width, height) = decoder.dimensions();
    checked_pixels(format, width, height)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(|error| DecodeError::malformed(format, error))?;
    let color = picture.into_rgb8().pixels().map(|pixel| pixel.0.map(|code| Transfer::Srgb.decode(code))).collect();
    Frame::new(width, height, color).map_err(|error| DecodeError::malformed(format, error))
}
