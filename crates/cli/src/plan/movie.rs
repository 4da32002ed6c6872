//! Films that go to one file, a movie.

use std::path::{Path, PathBuf};

use crate::args::RenderArgs;
use crate::value::Background;

/// Why a movie cannot be written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MovieChoiceError {
    /// It has no frames that could be kept.
    #[error("{flag} keeps frames, but -o {} is one file, which is written as a whole; write frames, as in -o film.####.png, and join \
             them with ffmpeg, or leave out {flag}", path.display())]
    Whole {
        /// The flag.
        flag: &'static str,
        /// The movie.
        path: PathBuf,
    },
    /// It was rendered before.
    #[error("{} exists; add --overwrite to replace it", path.display())]
    Exists {
        /// The movie.
        path: PathBuf,
    },
    /// Movies have no alpha.
    #[error("-o {} cannot be transparent: movies have no alpha; write png or exr frames, as in -o film.####.png, or choose a colour \
             (--background)", path.display())]
    Alpha {
        /// The movie.
        path: PathBuf,
    },
    /// The format is that of an image.
    #[error("-o {} is a movie, but --format names an image format; leave it out, or write frames, as in -o film.####.png", path.display())]
    Format {
        /// The movie.
        path: PathBuf,
    },
}

/// The kind of a movie file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Container {
    Mp4,
    Mov,
    Mkv,
    WebM,
}

impl Container {
    /// By the extension; `None` if it is not that of a movie.
    pub(crate) fn from_path(path: &Path) -> Option<Container> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "mp4" => Some(Container::Mp4),
            "mov" => Some(Container::Mov),
            "mkv" => Some(Container::Mkv),
            "webm" => Some(Container::WebM),
            _ => None,
        }
    }

    /// The movie that a film goes to, if it is one.
    pub(super) fn of_film(args: &RenderArgs) -> Result<Option<Container>, MovieChoiceError> {
        let Some(container) = Container::from_path(args.picture()) else { return Ok(None) };
        let path = args.picture().to_owned();
        if args.storage.format.is_some() {
            return Err(MovieChoiceError::Format { path });
        }
        if args.image.background == Some(Background::Transparent) {
            return Err(MovieChoiceError::Alpha { path });
        }
        match [("--resume", args.resume), ("--skip-existing", args.skip_existing)].into_iter().find(|(_, given)| *given)
        {
            Some((flag, _)) => Err(MovieChoiceError::Whole { flag, path }),
            None if path.exists() && !args.overwrite => Err(MovieChoiceError::Exists { path }),
            None => Ok(Some(container)),
        }
    }

    /// What ffmpeg calls it.
    pub(crate) fn muxer(self) -> &'static str {
        match self {
            Container::Mp4 => "mp4",
            Container::Mov => "mov",
            Container::Mkv => "matroska",
            Container::WebM => "webm",
        }
    }

    /// The encoder of its frames, as ffmpeg calls it.
    pub(crate) fn encoder(self) -> &'static str {
        if self == Container::WebM { "libvpx-vp9" } else { "libx264" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn movies_are_known_by_their_extension() {
        let of = |name: &str| Container::from_path(Path::new(name));
        assert_eq!([of("a.mp4"), of("a.b.MOV"), of("a/c.mkv")].map(|kind| kind.is_some()), [true; 3]);
        assert_eq!((of("a.webm").map(Container::encoder), of("a.png"), of("mp4")), (Some("libvpx-vp9"), None, None));
    }
}
