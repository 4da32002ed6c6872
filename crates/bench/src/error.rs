//! Why a suite or a comparison ended early.

use std::io;
use std::path::PathBuf;

use lightmesh::image::{CompareError, EncodeError};
use lightmesh::{LoadError, RenderError};

use crate::Suite;

/// Why there are no results.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A scene could not be opened.
    #[error(transparent)]
    Scene(#[from] LoadError),
    /// A picture could not be rendered, or the suite was stopped.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A picture could not be packed.
    #[error("a picture of the suite has no PNG form: {0}")]
    Picture(#[from] EncodeError),
    /// Two pictures could not be held against each other.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// There is no suite of this name.
    #[error("there is no suite `{0}`: choose thesis, quality or rays")]
    UnknownSuite(String),
    /// The suite measures scenes of its own.
    #[error("suite {0} measures scenes of its own; leave out --scene, or take the suite quality or rays")]
    OwnScenes(Suite),
    /// A file of results could not be read.
    #[error("cannot read {}: {reason}; check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// A file holds something else than results.
    #[error("{} does not hold results of a suite ({reason}); make it anew with `lightmesh bench SUITE --json FILE`", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and where.
        reason: serde_json::Error,
    },
    /// A file holds results in another version of the format.
    #[error("{} has version {found} of the format, this program reads {known}; make it anew", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// The version in the file.
        found: u32,
        /// The version that is read.
        known: u32,
    },
    /// Two results have nothing that could be compared.
    #[error("{} and {} have no row in common that took time: compare results of one suite, both --quick or both not", old.display(), new.display())]
    NothingInCommon {
        /// The earlier results.
        old: PathBuf,
        /// The later ones.
        new: PathBuf,
    },
}
