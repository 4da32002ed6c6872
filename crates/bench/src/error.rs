//! Why a suite or a comparison ended early.

use std::io;
use std::path::PathBuf;

use lightmesh::image::{CompareError, EncodeError};
use lightmesh::scene::SkyError;
use lightmesh::{LoadError, RenderError};

use crate::Suite;

/// Why there are no results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// A scene could not be opened.
    #[error(transparent)]
    Scene(#[from] LoadError),
    /// An image could not be rendered, or the suite was stopped.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// There is no such sky.
    #[error(transparent)]
    Sky(#[from] SkyError),
    /// An image could not be encoded.
    #[error("an image of the suite cannot be stored as PNG: {0}")]
    Picture(#[from] EncodeError),
    /// Two images could not be compared.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// There is no suite of this name.
    #[error("there is no suite `{0}`: choose thesis, quality, rays, shadows or stages")]
    UnknownSuite(String),
    /// The suite does not accept scenes and sizes.
    #[error("suite {0} has its own scenes and sizes; omit them, or use the suite quality, rays or stages")]
    OwnScenes(Suite),
    /// A file of results could not be read.
    #[error("cannot read {}: {reason}; check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
    /// A file does not contain results.
    #[error("{} does not contain results of a suite ({reason}); generate it again", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The problem, and where it is.
        reason: serde_json::Error,
    },
    /// A file contains results in another version of the format.
    #[error("{} has format version {found}, this program reads version {known}; generate it again", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// The version in the file.
        found: u32,
        /// The version that is read.
        known: u32,
    },
    /// Two results have nothing in common.
    #[error("{} and {} have no timed row in common: compare results of the same suite, both quick or both not", old.display(), new.display())]
    NothingInCommon {
        /// The earlier results.
        old: PathBuf,
        /// The later ones.
        new: PathBuf,
    },
}
