//! What can be wrong with a movie.

use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;

use lightmesh_files::TargetError;

use crate::told::{Told, display_by_fields};
use crate::words::{Name, Words};

/// Names the program that encodes.
pub(crate) const FFMPEG: &str = "LIGHTMESH_FFMPEG";

/// What helps if something else has ended it.
const KILLED: &str = "the system or another program has killed it: check the free memory and try again";

/// Whether a signal has ended a program.
#[cfg(unix)]
fn was_killed(status: &ExitStatus) -> bool {
    std::os::unix::process::ExitStatusExt::signal(status).is_some()
}

#[cfg(not(unix))]
fn was_killed(_: &ExitStatus) -> bool {
    false
}

/// Why a film cannot become a movie.
#[derive(Debug)]
#[non_exhaustive]
pub enum MovieChoiceError {
    /// It has no frames that could be kept.
    Whole {
        /// What would keep them.
        setting: Name,
        /// The movie.
        path: PathBuf,
    },
    /// It was rendered before.
    Exists {
        /// The movie.
        path: PathBuf,
    },
    /// Movies have no alpha.
    Alpha {
        /// The movie.
        path: PathBuf,
    },
    /// The format is that of an image.
    Format {
        /// The movie.
        path: PathBuf,
    },
}

impl Told for MovieChoiceError {
    fn told(&self, words: Words) -> String {
        let frames = || words.with("output", "film.####.png");
        let movie = |path: &Path| words.with("output", path.display());
        match self {
            MovieChoiceError::Whole { setting, path } => {
                let setting = words.of(setting);
                format!(
                    "{setting} keeps frames, but {} is one file, which is written as a whole; write frames, as in {}, and join them with \
                     ffmpeg, or leave out {setting}",
                    movie(path),
                    frames()
                )
            }
            MovieChoiceError::Exists { path } => {
                format!("{} exists; add {} to replace it", path.display(), words.on("overwrite"))
            }
            MovieChoiceError::Alpha { path } => format!(
                "{} cannot be transparent: movies have no alpha; write png or exr frames, as in {}, or choose a colour ({})",
                movie(path),
                frames(),
                words.of("background")
            ),
            MovieChoiceError::Format { path } => format!(
                "{} is a movie, but {} names an image format; leave it out, or write frames, as in {}",
                movie(path),
                words.of("format"),
                frames()
            ),
        }
    }
}

display_by_fields!(MovieChoiceError);

impl std::error::Error for MovieChoiceError {}

/// Why a movie cannot be encoded.
#[derive(Debug)]
#[non_exhaustive]
pub enum MovieError {
    /// There is no such program.
    NoProgram {
        /// The movie.
        path: PathBuf,
        /// The program.
        program: String,
        /// The system's message.
        reason: io::Error,
    },
    /// It lacks the encoder.
    NoEncoder {
        /// The movie.
        path: PathBuf,
        /// The program.
        program: String,
        /// The encoder.
        encoder: &'static str,
    },
    /// It does not say what its encoders are.
    Unasked {
        /// The movie.
        path: PathBuf,
        /// The program.
        program: String,
        /// How it ended.
        status: ExitStatus,
        /// The end of its messages.
        said: String,
    },
    /// It ended before the movie did.
    Failed {
        /// The movie.
        path: PathBuf,
        /// The program.
        program: String,
        /// How it ended.
        status: ExitStatus,
        /// The end of its messages.
        said: String,
    },
    /// It cannot be reached.
    Lost {
        /// The movie.
        path: PathBuf,
        /// The program.
        program: String,
        /// The system's message.
        reason: io::Error,
    },
    /// The movie is a pipe or a device.
    NoFile {
        /// The movie.
        path: PathBuf,
    },
    /// The movie cannot be written.
    Target(TargetError),
}

impl Told for MovieError {
    fn told(&self, words: Words) -> String {
        let frames = words.with("output", "film.####.png");
        match self {
            MovieError::NoProgram { path, program, reason } => format!(
                "{} needs {program} to encode it, but {program} does not start ({reason}); install ffmpeg, name it by {FFMPEG}, or \
                 write frames, as in {frames}",
                path.display()
            ),
            MovieError::NoEncoder { path, program, encoder } => format!(
                "{} needs the encoder {encoder}, but {program} lacks it; install an ffmpeg with it, name that by {FFMPEG}, or write \
                 frames, as in {frames}",
                path.display()
            ),
            MovieError::Unasked { path, program, status, said } => format!(
                "{} needs {program} to encode it, but `{program} -encoders` failed ({status}): {said}; {}, name another program by \
                 {FFMPEG}, or write frames, as in {frames}",
                path.display(),
                if was_killed(status) { KILLED } else { "install an ffmpeg that works" }
            ),
            MovieError::Failed { path, program, status, said } => format!(
                "cannot write {}: {program} failed ({status}): {said}; {}, or write frames, as in {frames}",
                path.display(),
                if was_killed(status) { KILLED } else { "check the free disk space" }
            ),
            MovieError::Lost { path, program, reason } => format!(
                "cannot write {}: {program} cannot be reached ({reason}); try again, or write frames, as in {frames}",
                path.display()
            ),
            MovieError::NoFile { path } => {
                format!("cannot write {}: ffmpeg must be able to seek in a movie; name a regular file", path.display())
            }
            MovieError::Target(error) => error.to_string(),
        }
    }
}

display_by_fields!(MovieError);

impl std::error::Error for MovieError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            MovieError::NoProgram { reason, .. } | MovieError::Lost { reason, .. } => Some(reason),
            MovieError::Target(error) => error.source(),
            _ => None,
        }
    }
}

impl From<TargetError> for MovieError {
    fn from(error: TargetError) -> MovieError {
        MovieError::Target(error)
    }
}
