//! What can be wrong with output files.

use std::error::Error as Source;
use std::io;
use std::path::PathBuf;

use lightmesh_files::{PublishError, TargetError, WriteError};

use crate::told::{Told, display_by_fields};
use crate::words::{Name, Words};

/// Why output cannot be written.
#[derive(Debug)]
#[non_exhaustive]
pub enum OutputError {
    /// The file cannot be created.
    Target(TargetError),
    /// Writing the file failed.
    Write(WriteError),
    /// Complete files could not be renamed.
    Publish(PublishError),
    /// An output is an input, or another output.
    SameFile {
        /// What it is already.
        first: Name,
        /// What it would be, too.
        second: Name,
        /// The file.
        path: PathBuf,
    },
    /// Two outputs go to standard output.
    Mixed {
        /// One of them.
        first: Name,
        /// The other.
        second: Name,
    },
    /// Bytes that are no text go to a terminal.
    Terminal {
        /// The output.
        output: Name,
    },
    /// An input is in a folder whose files are written.
    InFolder {
        /// The input.
        what: Name,
        /// Its file.
        path: PathBuf,
        /// The output.
        output: Name,
        /// Its folder.
        folder: PathBuf,
    },
    /// Standard output cannot be written.
    Stdout(io::Error),
}

impl Told for OutputError {
    fn told(&self, words: Words) -> String {
        let of = |name| words.of(name);
        match self {
            OutputError::Target(error) => error.to_string(),
            OutputError::Write(error) => error.to_string(),
            OutputError::Publish(error) => error.to_string(),
            OutputError::SameFile { first, second, path } => format!(
                "{} and {} are the same file, {}; give them different names",
                of(first),
                of(second),
                path.display()
            ),
            OutputError::Mixed { first, second } => {
                format!("{} and {} both go to standard output; send one of them to a file", of(first), of(second))
            }
            OutputError::Terminal { output } => format!(
                "{} would write binary data to the terminal; redirect standard output to a file or a pipe, or name a file",
                of(output)
            ),
            OutputError::InFolder { what, path, output, folder } => format!(
                "{}, {}, is in a folder that {} fills, {}; choose another name for {}",
                of(what),
                path.display(),
                of(output),
                folder.display(),
                of(output)
            ),
            OutputError::Stdout(error) => format!("cannot write to standard output: {error}; check its destination"),
        }
    }
}

display_by_fields!(OutputError);

impl Source for OutputError {
    fn source(&self) -> Option<&(dyn Source + 'static)> {
        match self {
            OutputError::Target(error) => error.source(),
            OutputError::Write(error) => error.source(),
            OutputError::Publish(error) => error.source(),
            OutputError::Stdout(error) => Some(error),
            _ => None,
        }
    }
}

impl From<TargetError> for OutputError {
    fn from(error: TargetError) -> OutputError {
        OutputError::Target(error)
    }
}

impl From<WriteError> for OutputError {
    fn from(error: WriteError) -> OutputError {
        OutputError::Write(error)
    }
}

impl From<PublishError> for OutputError {
    fn from(error: PublishError) -> OutputError {
        OutputError::Publish(error)
    }
}
