//! Why there is no report.

use std::path::PathBuf;

use lightmesh::image::{CompareError, DecodeError, EncodeError};
use lightmesh_files::ReadError;

use crate::BenchError;

/// Why a report cannot be created.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A file does not contain results.
    #[error(transparent)]
    Results(Box<BenchError>),
    /// Two rows or images in a file have the same id.
    #[error("{} has two {what} with the id `{id}`; generate it again", path.display())]
    Twice {
        /// The file.
        path: PathBuf,
        /// Rows or images.
        what: &'static str,
        /// Their id.
        id: String,
    },
    /// An image in a file is invalid.
    #[error("the image `{id}` in {} cannot be shown: {reason}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// The id of the image.
        id: String,
        /// The problem.
        reason: PictureError,
    },
}

impl From<BenchError> for ReportError {
    fn from(error: BenchError) -> ReportError {
        ReportError::Results(Box::new(error))
    }
}

/// A problem with an image in results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// Its file cannot be read.
    #[error("cannot read {} ({reason}); keep images next to the result file or generate both again", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's message, or that it is not in the folder of the results.
        reason: ReadError,
    },
    /// It is not a PNG file.
    #[error("it is not a PNG file")]
    NotPng,
    /// It is damaged.
    #[error(transparent)]
    Decode(#[from] DecodeError),
    /// Its reference is missing.
    #[error("its reference image `{0}` is missing; generate the results again")]
    NoReference(String),
    /// It cannot be compared with its reference.
    #[error("it cannot be compared with `{reference}`: {reason}")]
    Compare {
        /// The reference image.
        reference: String,
        /// Why not.
        reason: CompareError,
    },
    /// The difference image cannot be encoded.
    #[error("its difference image cannot be stored as PNG: {0}")]
    Encode(#[from] EncodeError),
}
