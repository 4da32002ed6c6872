//! Writing files and folders.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use lightmesh_files::{Replacement, TargetError, check_writable};

/// Why output cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The folder cannot be created.
    #[error("cannot create the folder {}: {reason}; choose another or change its permissions", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
    /// A file cannot be created.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Writing a file failed.
    #[error("cannot write {}: {reason}; check the free disk space, then try again", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
}

/// Creates a folder if it is missing, and checks that files can be written to it, before a long run.
///
/// # Errors
/// [`OutputError::Folder`] or [`OutputError::Target`].
pub fn prepare_folder(folder: &Path) -> Result<(), OutputError> {
    make_folder(folder)?;
    Ok(check_writable(folder.join("report.md"))?)
}

/// Creates a folder if it is missing.
pub(crate) fn make_folder(path: &Path) -> Result<(), OutputError> {
    fs::create_dir_all(path).map_err(|reason| OutputError::Folder { path: path.to_owned(), reason })
}

/// Writes a file completely or not at all.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let failed = |reason| OutputError::Write { path: path.to_owned(), reason };
    let mut file = Replacement::of(path)?;
    file.write_all(bytes).map_err(failed)?;
    file.commit().map_err(failed)
}
