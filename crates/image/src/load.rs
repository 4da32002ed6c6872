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
use crate::{DecodeError, Format, Frame, LoadError, radiance};

/// Number of bytes that identify every format.
const SIGNATURE: usize = 8;

/// Which values the pixels of a file can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Range {
    /// From 0 to 1, as on a screen: bmp, png and jpg.
    Display,
    /// Those of light, without a limit: exr and hdr.
    Light,
}

impl Frame {
    /// Loads a bmp, png, exr, jpg or hdr file. 8-bit values are decoded from sRGB, or as linear if a png is marked so; the layers of
    /// an exr written by [`Frame::save_layers`] are loaded with it. An exr without the channels `R G B` or `Y` gives those of a layer (Blender's
    /// `ViewLayer.Combined.R`, or the only one), or its only channel beside alpha as grey.
    ///
    /// # Errors
    /// [`LoadError`], which names the file.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, LoadError> {
        Ok(Self::load_with_range(path)?.0)
    }

    /// As [`Frame::load`], and which values the file's pixels can have.
    ///
    /// # Errors
    /// [`LoadError`], which names the file.
    pub fn load_with_range(path: impl AsRef<Path>) -> Result<(Self, Range), LoadError> {
        let path = path.as_ref();
        let bytes = read_picture(path).map_err(|reason| LoadError::Read { path: path.to_owned(), reason })?;
        let frame = Self::decode(&bytes).map_err(|reason| LoadError::Decode { path: path.to_owned(), reason })?;
        let is_light = is_radiance(&bytes) || Format::from_signature(&bytes) == Some(Format::Exr);
        Ok((frame, if is_light { Range::Light } else { Range::Display }))
    }

    /// As [`Frame::load`], from the content of a file.
    ///
    /// # Errors
    /// [`DecodeError`] for any invalid bytes.
    pub fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        if is_radiance(bytes) {
            return radiance::read(bytes);
        }
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

fn is_radiance(bytes: &[u8]) -> bool {
    bytes.starts_with(radiance::SIGNATURE)
}

/// The content of a file, or only its beginning if that is not an image (it may be an endless device).
fn read_picture(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let mut bytes = Vec::new();
    file.by_ref().take(SIGNATURE as u64).read_to_end(&mut bytes)?;
    if Format::from_signature(&bytes).is_some() || is_radiance(&bytes) {
        file.read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}
