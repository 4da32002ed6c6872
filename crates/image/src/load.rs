//! Loading pictures into linear [`Frame`]s. What a file is, its first bytes say, not its name.
//!
//! Files come from anywhere: sizes are checked before memory is taken for them, and a file that is cut off or damaged ends
//! in an error that says so. Not promised: colour profiles, EXIF orientation and alpha are left aside.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageDecoder, ImageResult};
use thiserror::Error;

use crate::frame::pixel_count;
use crate::{Format, Frame, Transfer, bmp, exr, jpg, png};

/// The most pixels that a file may hold: 16384 x 16384, 3 GiB of colours.
const MAX_PIXELS: usize = 1 << 28;

/// Enough first bytes to know every format.
const SIGNATURE: usize = 8;

/// Why a picture could not be loaded.
#[derive(Debug, Error)]
pub enum LoadError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {reason}; check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// The file was read, but what it holds is of no use.
    #[error("cannot load {}: {reason}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: DecodeError,
    },
}

/// Why bytes could not be turned into a [`Frame`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum DecodeError {
    /// The first bytes are of no known format.
    #[error("not a picture of a known format, convert it to one of these: {}", Format::known())]
    UnknownFormat,
    /// The header asks for more pixels than are reasonable, or for none.
    #[error(
        "the {format} header says {width}x{height} pixels, but 1 to {MAX_PIXELS} pixels can be read: scale it down"
    )]
    TooLarge {
        /// What the bytes are.
        format: Format,
        /// Pixels a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// An OpenEXR file without the channels `R`, `G`, `B` or `Y` in its first part.
    #[error("the exr file has no channels R, G, B or Y but these: {found}; export it with one of these sets")]
    Channels {
        /// Names of its channels.
        found: String,
    },
    /// The bytes break the rules of their format, or end too early.
    #[error("the {format} data is damaged, incomplete or of an unsupported kind ({message}): get or export it anew")]
    Malformed {
        /// What the bytes claim to be.
        format: Format,
        /// What the decoder said.
        message: String,
    },
}

impl DecodeError {
    pub(crate) fn malformed(format: Format, message: impl ToString) -> Self {
        Self::Malformed { format, message: message.to_string() }
    }
}

impl Frame {
    /// Loads a bmp, png, exr or jpg file. 8-bit values are decoded from sRGB, or taken as linear where a png says so; the
    /// layers of an exr written by [`Frame::save_layers`] come back with it.
    ///
    /// # Errors
    /// [`LoadError`], which names the file.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, LoadError> {
        let path = path.as_ref();
        let bytes = read_picture(path).map_err(|reason| LoadError::Read { path: path.to_owned(), reason })?;
        Self::decode(&bytes).map_err(|reason| LoadError::Decode { path: path.to_owned(), reason })
    }

    /// As [`Frame::load`], from the contents of a file.
    ///
    /// # Errors
    /// [`DecodeError`], whatever the bytes are.
    pub fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        match Format::from_signature(bytes).ok_or(DecodeError::UnknownFormat)? {
            Format::Bmp => bmp::read(bytes),
            Format::Png => png::read(bytes),
            Format::Exr => exr::read(bytes),
            Format::Jpg => jpg::read(bytes),
        }
    }
}

/// The contents of a file, or only its start where that shows no picture (it may be a device without an end).
fn read_picture(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let mut bytes = Vec::new();
    file.by_ref().take(SIGNATURE as u64).read_to_end(&mut bytes)?;
    if Format::from_signature(&bytes).is_some() {
        file.read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// The number of pixels, where it is one that can be read.
pub(crate) fn checked_pixels(format: Format, width: u32, height: u32) -> Result<usize, DecodeError> {
    let pixels = pixel_count(width, height).filter(|&pixels| pixels <= MAX_PIXELS);
    pixels.ok_or(DecodeError::TooLarge { format, width, height })
}

/// Reads an 8-bit picture through a decoder of the `image` crate, once its size is known to be reasonable.
pub(crate) fn read_with(format: Format, decoder: ImageResult<impl ImageDecoder>) -> Result<Frame, DecodeError> {
    let decoder = decoder.map_err(|error| DecodeError::malformed(format, error))?;
    let (width, height) = decoder.dimensions();
    checked_pixels(format, width, height)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(|error| DecodeError::malformed(format, error))?;
    let color = picture.into_rgb8().pixels().map(|pixel| pixel.0.map(|code| Transfer::Srgb.decode(code))).collect();
    Frame::new(width, height, color).map_err(|error| DecodeError::malformed(format, error))
}
