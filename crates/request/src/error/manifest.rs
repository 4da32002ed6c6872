//! What can be wrong with the manifest of a film.

use std::error::Error as Source;
use std::io;
use std::path::PathBuf;

use lightmesh_files::{PublishError, WriteError};

use crate::told::{Told, display_by_fields};
use crate::words::{Name, Words};

/// Why a film cannot be resumed, or its manifest not be written.
#[derive(Debug)]
#[non_exhaustive]
pub enum ManifestError {
    /// A file of this name is something else, or damaged.
    Foreign {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// It is not as it was written.
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// It cannot be read.
    Read {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
    /// Another version of the program may render other pixels.
    Program {
        /// The file.
        path: PathBuf,
        /// The film.
        film: String,
        /// The recorded version.
        was: String,
        /// This version.
        is: &'static str,
    },
    /// A setting is not that of the frames that are there.
    Settings {
        /// The file.
        path: PathBuf,
        /// The film.
        film: String,
        /// The setting.
        setting: Name,
        /// The recorded value.
        was: String,
        /// The value now.
        is: String,
    },
    /// The scene is not that of the frames that are there.
    Scene {
        /// The file.
        path: PathBuf,
        /// The film.
        film: String,
        /// The scene.
        scene: PathBuf,
    },
    /// There would be no manifest.
    StandardInput,
    /// A file that belongs to the film cannot be read.
    Checksum {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
    /// It cannot be written.
    Write(WriteError),
    /// It cannot replace the former one.
    Publish(PublishError),
}

impl Told for ManifestError {
    fn told(&self, words: Words) -> String {
        let anew = || format!("write {} in place of {} to begin anew", words.on("overwrite"), words.on("resume"));
        match self {
            ManifestError::Foreign { path, reason } => format!(
                "{} is not a manifest of films ({reason}); choose another folder for {}, or remove it and {}",
                path.display(),
                words.of("output"),
                anew()
            ),
            ManifestError::Damaged { path } => format!(
                "{} is not as it was written: its checksum is another one; restore it, or remove it and {}",
                path.display(),
                anew()
            ),
            ManifestError::Read { path, reason } => {
                format!("cannot read {}: {reason}; check its permissions", path.display())
            }
            ManifestError::Program { path, film, was, is } => format!(
                "{}: the film {film} was begun by version {was} of lightmesh, and this is {is}; use that version, or {}",
                path.display(),
                anew()
            ),
            ManifestError::Settings { path, film, setting, was, is } => format!(
                "{}: the settings of the film {film} differ: {} was {was} and is {is}; give the former, or {}",
                path.display(),
                words.of(setting),
                anew()
            ),
            ManifestError::Scene { path, film, scene } => format!(
                "{}: the scene of the film {film} differs: {}, or a file that it refers to, has changed; restore it, or {}",
                path.display(),
                scene.display(),
                anew()
            ),
            ManifestError::StandardInput => format!(
                "{} needs a scene that can be read again, but it comes from standard input; save it to a file and name that",
                words.of("resume")
            ),
            ManifestError::Checksum { path, reason } => {
                format!("cannot read {} for its checksum: {reason}; check its permissions", path.display())
            }
            ManifestError::Write(error) => error.to_string(),
            ManifestError::Publish(error) => error.to_string(),
        }
    }
}

display_by_fields!(ManifestError);

impl Source for ManifestError {
    fn source(&self) -> Option<&(dyn Source + 'static)> {
        match self {
            ManifestError::Read { reason, .. } | ManifestError::Checksum { reason, .. } => Some(reason),
            ManifestError::Write(error) => error.source(),
            ManifestError::Publish(error) => error.source(),
            _ => None,
        }
    }
}

impl From<WriteError> for ManifestError {
    fn from(error: WriteError) -> ManifestError {
        ManifestError::Write(error)
    }
}

impl From<PublishError> for ManifestError {
    fn from(error: PublishError) -> ManifestError {
        ManifestError::Publish(error)
    }
}
