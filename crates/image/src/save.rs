//! Saving a [`Frame`]: the extension chooses the format, and a file is there whole or not at all.
//!
//! Pictures are written to a temporary file beside the target and renamed over it, so an interrupted program leaves the
//! earlier file as it was. [`check_writable`] finds what can be found before any time is spent on rendering.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use lightmesh_files::{Replacement, TargetError};
use thiserror::Error;

use crate::{Format, Frame, Transfer, bmp, exr, jpg, png};

/// Why a picture was not, or will not be, saved.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The extension names no format that can be written.
    #[error("cannot save {}: unknown picture format, use one of these extensions: {}", path.display(), Format::known())]
    UnknownExtension {
        /// The target.
        path: PathBuf,
    },
    /// Layers fit into no format but exr.
    #[error("cannot save layers to {}: only an OpenEXR file can hold them, use the extension exr", path.display())]
    LayersNeedExr {
        /// The target.
        path: PathBuf,
    },
    /// The frame was rendered without layers.
    #[error("cannot save layers to {}: the frame has none, render it with layers", path.display())]
    NoLayers {
        /// The target.
        path: PathBuf,
    },
    /// There could be no such file.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// The format cannot hold a picture of this size.
    #[error("cannot save {}: {width}x{height} pixels are too many for {format} ({limit}), use exr or png", path.display())]
    TooLarge {
        /// The target.
        path: PathBuf,
        /// The target's format.
        format: Format,
        /// Pixels a row.
        width: u32,
        /// Rows.
        height: u32,
        /// What the format can hold.
        limit: &'static str,
    },
    /// Writing failed, most often for want of space; nothing is left behind.
    #[error("cannot save {}: {reason}; nothing was written, check the space left on the disk", path.display())]
    Write {
        /// The target.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
}

/// What the writers report; [`SaveError`] adds which file.
#[derive(Debug, Error)]
pub enum EncodeError {
    /// The format cannot hold a picture of this size.
    #[error("the format holds {limit}")]
    TooLarge {
        /// What it can hold.
        limit: &'static str,
    },
    /// The bytes could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Fails where `format` cannot hold a picture of the size of `frame`.
pub(crate) fn check_fits(format: Format, frame: &Frame) -> Result<(), EncodeError> {
    match format.exceeded_limit(frame.width(), frame.height()) {
        Some(limit) => Err(EncodeError::TooLarge { limit }),
        None => Ok(()),
    }
}

impl Frame {
    /// Saves the colours as bmp, png, exr or jpg, by the extension of `path`; 8-bit formats get the sRGB curve.
    ///
    /// # Errors
    /// [`SaveError`]; the target then is what it was before.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.save_with(path, Transfer::Srgb)
    }

    /// As [`Frame::save`], with another transfer function for 8-bit formats. An exr is linear whatever `transfer` says.
    ///
    /// # Errors
    /// [`SaveError`]; the target then is what it was before.
    pub fn save_with(&self, path: impl AsRef<Path>, transfer: Transfer) -> Result<(), SaveError> {
        let path = path.as_ref();
        let format = known_format(path)?;
        self.replace(path, format, |output| match format {
            Format::Bmp => bmp::write(self, transfer, output),
            Format::Png => png::write(self, transfer, output),
            Format::Exr => exr::write(self, output),
            Format::Jpg => jpg::write(self, transfer, output),
        })
    }

    /// The bytes of a PNG file of the colours, with the sRGB curve.
    ///
    /// # Errors
    /// [`EncodeError::TooLarge`] where a side is longer than 2147483647 pixels.
    pub fn to_png(&self) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Vec::new();
        png::write(self, Transfer::Srgb, &mut bytes)?;
        Ok(bytes)
    }

    /// The same in as few bytes as there can be: with a palette where 256 colours are enough, as in difference pictures.
    ///
    /// # Errors
    /// As [`Frame::to_png`].
    pub fn to_small_png(&self) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Vec::new();
        if png::write_indexed(self, &mut bytes)? { Ok(bytes) } else { self.to_png() }
    }

    /// Saves colours and layers as one multilayer exr of 32-bit floats with the channels `R G B` (linear), `Z` (distance
    /// along the ray), `N.X N.Y N.Z`, `P.X P.Y P.Z`, `V.0 V.1 …` (one a light) and `M` (light points used).
    ///
    /// # Errors
    /// [`SaveError::NoLayers`], [`SaveError::LayersNeedExr`], or as [`Frame::save`].
    pub fn save_layers(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        let format = known_format(path)?;
        if format != Format::Exr {
            return Err(SaveError::LayersNeedExr { path: path.to_owned() });
        }
        let layers = self.layers().ok_or_else(|| SaveError::NoLayers { path: path.to_owned() })?;
        self.replace(path, format, |output| exr::write_layers(self, layers, output))
    }

    /// Lets `write` fill a file that then replaces the one at `path`.
    fn replace(
        &self,
        path: &Path,
        format: Format,
        write: impl FnOnce(&mut BufWriter<&mut Replacement>) -> Result<(), EncodeError>,
    ) -> Result<(), SaveError> {
        let failed = |error| match error {
            EncodeError::TooLarge { limit } => {
                let (width, height) = (self.width(), self.height());
                SaveError::TooLarge { path: path.to_owned(), format, width, height, limit }
            }
            EncodeError::Io(reason) => SaveError::Write { path: path.to_owned(), reason },
        };
        let mut file = Replacement::of(path)?;
        let mut output = BufWriter::new(&mut file);
        write(&mut output).map_err(failed)?;
        output.flush().map_err(|reason| failed(reason.into()))?;
        drop(output);
        file.commit().map_err(|reason| failed(reason.into()))
    }
}

/// Says whether a picture could be saved to `path`, without touching what is there: the extension is known, the target is
/// not a directory, and a file can be made beside it (one is made and removed again).
///
/// # Errors
/// The [`SaveError`] that [`Frame::save`] would end with.
pub fn check_writable(path: impl AsRef<Path>) -> Result<(), SaveError> {
    let path = path.as_ref();
    known_format(path)?;
    Ok(lightmesh_files::check_writable(path)?)
}

/// Says whether the format that `path` names can hold a picture of this size.
///
/// # Errors
/// [`SaveError::TooLarge`] or [`SaveError::UnknownExtension`], as [`Frame::save`] would end with.
pub fn check_size(path: impl AsRef<Path>, width: u32, height: u32) -> Result<(), SaveError> {
    let path = path.as_ref();
    let format = known_format(path)?;
    match format.exceeded_limit(width, height) {
        Some(limit) => Err(SaveError::TooLarge { path: path.to_owned(), format, width, height, limit }),
        None => Ok(()),
    }
}

fn known_format(path: &Path) -> Result<Format, SaveError> {
    Format::from_path(path).ok_or_else(|| SaveError::UnknownExtension { path: path.to_owned() })
}
