//! Why a scene could not be written.

use std::io;
use std::path::{Path, PathBuf};

use lightmesh_files::{PublishError, WriteError};

/// Why a scene could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// A file cannot be written; nothing is left behind.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Complete files could not be renamed.
    #[error(transparent)]
    Publish(#[from] PublishError),
    /// The file extension is not that of a format that can be written.
    #[error("`.{extension}` is not a format that can be written, {}; use the extension .toml or .glb", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// The extension without the dot; may be empty.
        extension: String,
    },
    /// A GLB file counts its bytes in 32 bits.
    #[error("the scene takes {bytes} bytes, {}; a GLB file can hold 4 GiB: split the scene", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Size that the file would have in bytes.
        bytes: usize,
    },
}

/// The content of a file cannot be made.
pub(super) fn refused(path: &Path, reason: io::Error) -> ExportError {
    WriteError::Data { path: path.to_owned(), reason }.into()
}
