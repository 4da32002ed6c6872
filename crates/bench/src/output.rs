//! Writing files and folders.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use lightmesh_files::{PublishError, TargetError, WriteError, check_folder};

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
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Complete files could not be renamed.
    #[error(transparent)]
    Publish(#[from] PublishError),
}

/// Checks that files can be written to a folder, before a long run. It may be missing, and is not created.
///
/// # Errors
/// [`OutputError::Folder`] or [`OutputError::Target`].
pub fn check_output_folder(folder: &Path) -> Result<(), OutputError> {
    check_folder(folder).map_err(|error| match error {
        TargetError::NotADirectory { .. } => {
            OutputError::Folder { path: folder.to_owned(), reason: io::ErrorKind::NotADirectory.into() }
        }
        error => error.into(),
    })
}

/// Creates a folder if it is missing.
pub(crate) fn make_folder(path: &Path) -> Result<(), OutputError> {
    fs::create_dir_all(path).map_err(|reason| OutputError::Folder { path: path.to_owned(), reason })
}
