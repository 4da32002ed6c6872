//! Why images cannot be loaded or saved.

use std::io;
use std::path::PathBuf;

use lightmesh_files::{PublishError, TargetError};
use thiserror::Error;

use crate::format::{Format, MAX_PIXELS};

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

/// Why bytes could not be turned into a [`Frame`](crate::Frame).
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum DecodeError {
    /// The first bytes do not match a known format.
    #[error("not an image in a known format; convert it to one of these: {}, hdr", Format::known())]
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
    /// A Radiance picture that is damaged, or of a kind that is not read.
    #[error("the hdr data is damaged, incomplete or unsupported ({message}): export it again")]
    Radiance {
        /// What is wrong.
        message: String,
    },
    /// An OpenEXR file without the channels `R`, `G`, `B` or `Y`, those of one layer, or only one.
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

/// Why an image cannot be saved.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The extension is not that of a known format.
    #[error("cannot save {}: unknown image format; use one of these extensions: {}", path.display(), Format::known())]
    UnknownExtension {
        /// The target.
        path: PathBuf,
    },
    /// This crate was built without the format.
    #[error("cannot save {}: this program was built without {format} files: build it with the feature {}", path.display(), format.feature())]
    NotBuilt {
        /// The target.
        path: PathBuf,
        /// The target's format.
        format: Format,
    },
    /// Only exr files can store layers.
    #[error("cannot save layers to {}: only OpenEXR files can store them; use the extension exr", path.display())]
    LayersNeedExr {
        /// The target.
        path: PathBuf,
    },
    /// The frame was rendered without layers.
    #[error("cannot save layers to {}: the frame has none; render it with layers", path.display())]
    NoLayers {
        /// The target.
        path: PathBuf,
    },
    /// The file cannot be created.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// The format does not support images of this size.
    #[error("cannot save {}: {width}x{height} pixels are too many for {format} ({limit}); use exr or png", path.display())]
    TooLarge {
        /// The target.
        path: PathBuf,
        /// The target's format.
        format: Format,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// The limit of the format.
        limit: &'static str,
    },
    /// The format has 8 bits per channel.
    #[error("cannot save {} with 16 bits per channel: {format} files have 8; use png, or exr for floats", path.display())]
    BitDepth {
        /// The target.
        path: PathBuf,
        /// The target's format.
        format: Format,
    },
    /// The format cannot be transparent.
    #[error("cannot save {} with a transparent background: {format} files have no alpha; use png or exr", path.display())]
    Alpha {
        /// The target.
        path: PathBuf,
        /// The target's format.
        format: Format,
    },
    /// Writing failed, most often because the disk is full; nothing is left behind.
    #[error("cannot save {}: {reason}; nothing was written; check the free disk space", path.display())]
    Write {
        /// The target.
        path: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
    /// The complete file could not be renamed.
    #[error(transparent)]
    Publish(#[from] PublishError),
}

/// An error of a writer; [`SaveError`] adds the file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The format does not support images of this size.
    #[error("the format is limited to {limit}")]
    TooLarge {
        /// The limit.
        limit: &'static str,
    },
    /// The format has 8 bits per channel.
    #[error("{format} files have 8 bits per channel")]
    BitDepth {
        /// The format.
        format: Format,
    },
    /// The format cannot be transparent.
    #[error("{format} files have no alpha")]
    Alpha {
        /// The format.
        format: Format,
    },
    /// This crate was built without the format.
    #[error("this program was built without {format} files: build it with the feature {feature}")]
    NotBuilt {
        /// The format.
        format: Format,
        /// The Cargo feature that it needs.
        feature: &'static str,
    },
    /// The frame was rendered without layers.
    #[error("the frame has no layers; render it with layers")]
    NoLayers,
    /// The bytes could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
}
