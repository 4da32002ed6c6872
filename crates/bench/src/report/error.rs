//! Why there is no report.

use std::io;
use std::path::PathBuf;

use lightmesh::image::{CompareError, DecodeError, EncodeError};
use lightmesh_files::TargetError;

use crate::BenchError;

/// Why there is no report. Where files were at fault, nothing was written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file does not hold results.
    #[error(transparent)]
    Results(Box<BenchError>),
    /// Two rows of a file, or two pictures, have one name.
    #[error("{} has two {what} with the id `{id}`; make it anew with `lightmesh bench SUITE --json FILE`", path.display())]
    Twice {
        /// The file.
        path: PathBuf,
        /// Rows or pictures.
        what: &'static str,
        /// Their name.
        id: String,
    },
    /// A picture in a file is none.
    #[error("the picture `{id}` in {} cannot be shown: {reason}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// The picture's name.
        id: String,
        /// What is wrong with it.
        reason: PictureError,
    },
    /// The folder cannot be made.
    #[error("cannot make the folder {}: {reason}; choose another or change its permissions", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// A file cannot be written where it should go.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Filling a file failed.
    #[error("cannot write {}: {reason}; check the space left on the disk, then make the report again", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
}

impl From<BenchError> for ReportError {
    fn from(error: BenchError) -> ReportError {
        ReportError::Results(Box::new(error))
    }
}

/// What is wrong with a picture among results.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// It is not Base64.
    #[error("its PNG file is not in Base64 ({0}), get the file of results anew")]
    Base64(base64::DecodeError),
    /// It is not a PNG file.
    #[error("it is no PNG file")]
    NotPng,
    /// It is a damaged one.
    #[error(transparent)]
    Decode(#[from] DecodeError),
    /// Its reference is missing.
    #[error("there is no picture `{0}` to hold it against, get the file of results anew")]
    NoReference(String),
    /// It cannot be held against its reference.
    #[error("it cannot be held against `{reference}`: {reason}")]
    Compare {
        /// The other picture.
        reference: String,
        /// Why not.
        reason: CompareError,
    },
    /// The picture of the differences cannot be packed.
    #[error("its difference to the reference has no PNG form: {0}")]
    Encode(#[from] EncodeError),
}
