//! Loading images into linear [`Frame`]s. The format is determined by the first bytes of a file, not its name.
//!
//! Files are untrusted: sizes are checked before memory is allocated, and a truncated or damaged file is an error. Colour
//! profiles and EXIF orientation are ignored.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

#[cfg(feature = "bmp")]
use crate::bmp;
#[cfg(feature = "exr")]
use crate::exr;
#[cfg(feature = "jpeg")]
use crate::jpg;
#[cfg(feature = "png")]
use crate::png;
use crate::{DecodeError, Format, Frame, LoadError};

/// Number of bytes that identify every format.
const SIGNATURE: usize = 8;

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
