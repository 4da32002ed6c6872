//! Saving a [`Frame`]: the extension chooses the format, and a file is there whole or not at all.
//!
//! Pictures are written to a temporary file beside the target and renamed over it, so an interrupted program leaves the
//! earlier file as it was. [`check_writable`] finds what can be found before any time is spent on rendering.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};
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
    /// The target is a directory.
    #[error("cannot save {}: it is a directory, name a file in it", path.display())]
    IsDirectory {
        /// The target.
        path: PathBuf,
    },
    /// The directory of the target does not exist.
    #[error("cannot save {}: the directory {} does not exist, create it first", path.display(), directory.display())]
    NoDirectory {
        /// The target.
        path: PathBuf,
        /// Where it would lie.
        directory: PathBuf,
    },
    /// No file can be made in the directory of the target.
    #[error(
        "cannot save {}: no file can be made in {} ({reason}), choose another directory or change its permissions",
        path.display(), directory.display()
    )]
    Unwritable {
        /// The target.
        path: PathBuf,
        /// Where it would lie.
        directory: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
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
pub(crate) enum EncodeError {
    #[error("the format holds {limit}")]
    TooLarge { limit: &'static str },
    #[error(transparent)]
    Io(#[from] io::Error),
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

    /// Lets `write` fill a temporary file, then renames it to `path`. Dropping the file on the way out removes it.
    fn replace(
        &self,
        path: &Path,
        format: Format,
        write: impl FnOnce(&mut BufWriter<&mut NamedTempFile>) -> Result<(), EncodeError>,
    ) -> Result<(), SaveError> {
        let failed = |error| match error {
            EncodeError::TooLarge { limit } => {
                let (width, height) = (self.width(), self.height());
                SaveError::TooLarge { path: path.to_owned(), format, width, height, limit }
            }
            EncodeError::Io(reason) => SaveError::Write { path: path.to_owned(), reason },
        };
        let target = resolved(path);
        let mut file = temporary_beside(path, &target)?;
        let mut output = BufWriter::new(&mut file);
        write(&mut output).map_err(failed)?;
        output.flush().map_err(|reason| failed(reason.into()))?;
        drop(output);
        file.persist(&target).map_err(|error| failed(error.error.into()))?;
        Ok(())
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
    temporary_beside(path, &resolved(path)).map(drop)
}

fn known_format(path: &Path) -> Result<Format, SaveError> {
    Format::from_path(path).ok_or_else(|| SaveError::UnknownExtension { path: path.to_owned() })
}

/// Where `path` leads: a link is followed, so that the file behind it is replaced and not the link.
fn resolved(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// A new file in the directory of `target`, with the permissions of an ordinary new file.
fn temporary_beside(path: &Path, target: &Path) -> Result<NamedTempFile, SaveError> {
    if target.is_dir() {
        return Err(SaveError::IsDirectory { path: path.to_owned() });
    }
    let directory = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if !directory.is_dir() {
        return Err(SaveError::NoDirectory { path: path.to_owned(), directory: directory.to_owned() });
    }
    let mut builder = Builder::new();
    builder.prefix(".lightmesh-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less the umask
    builder.tempfile_in(directory).map_err(|reason| SaveError::Unwritable {
        path: path.to_owned(),
        directory: directory.to_owned(),
        reason,
    })
}
