//! What is wrong with saved grids.

use std::io;
use std::path::PathBuf;

use lightmesh_files::TargetError;

use super::VERSION;

/// Why a grid cannot be saved.
#[derive(Debug, thiserror::Error)]
pub enum GridSaveError {
    /// No such file can exist.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Writing failed, most often for lack of space; nothing is left behind.
    #[error("cannot write {}: {reason}; nothing was written, check the space left on the disk", path.display())]
    Write {
        /// The target.
        path: PathBuf,
        /// What the system reported.
        reason: io::Error,
    },
}

/// Why a grid file cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}; {}", path.display(), fault.remedy())]
pub struct GridFileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    #[source]
    pub fault: GridFault,
}

/// What is wrong with a grid file.
#[derive(Debug, thiserror::Error)]
pub enum GridFault {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Read(io::Error),
    /// It is not a grid file.
    #[error("is not a grid file")]
    NotAGrid,
    /// It was written by another version of this program.
    #[error("has format version {found}, this program reads version {VERSION}")]
    Version {
        /// The version in the file.
        found: u32,
    },
    /// It belongs to other triangles.
    #[error("belongs to another scene ({found} triangles in the file, {expected} in the scene, or other positions)")]
    OtherGeometry {
        /// Triangles that the file was built from.
        found: u32,
        /// Triangles of the scene.
        expected: usize,
    },
    /// It is shorter or longer than its header says.
    #[error("has {found} bytes, but its header says {expected}")]
    Length {
        /// Length of the file.
        found: u64,
        /// Length according to its header.
        expected: u128,
    },
    /// Its content is not as written.
    #[error("is corrupted: {0}")]
    Corrupted(&'static str),
}

impl GridFault {
    /// What to do about it.
    fn remedy(&self) -> &'static str {
        match self {
            GridFault::Read(_) => "check the path and its permissions",
            _ => "build the grid again and save it",
        }
    }
}
