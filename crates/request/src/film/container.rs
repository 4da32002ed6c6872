//! Films that go to one file, a movie.

use std::path::Path;

use crate::error::MovieChoiceError;
use crate::order::Order;
use crate::value::Background;

/// The kind of a movie file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Container {
    /// .mp4
    Mp4,
    /// .mov
    Mov,
    /// .mkv
    Mkv,
    /// .webm
    WebM,
}

impl Container {
    /// By the extension; `None` if it is not that of a movie.
    pub fn from_path(path: &Path) -> Option<Container> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "mp4" => Some(Container::Mp4),
            "mov" => Some(Container::Mov),
            "mkv" => Some(Container::Mkv),
            "webm" => Some(Container::WebM),
            _ => None,
        }
    }

    /// The movie that a film goes to, if it is one.
    pub(crate) fn of_film(order: &Order) -> Result<Option<Container>, MovieChoiceError> {
        let Some(container) = Container::from_path(order.files.picture()) else { return Ok(None) };
        let path = order.files.picture().to_owned();
        if order.request.format.is_some() {
            return Err(MovieChoiceError::Format { path });
        }
        if order.request.background == Some(Background::Transparent) {
            return Err(MovieChoiceError::Alpha { path });
        }
        match [("resume", order.request.resume), ("skip_existing", order.request.skip_existing)]
            .into_iter()
            .find(|(_, given)| *given)
        {
            Some((setting, _)) => Err(MovieChoiceError::Whole { setting, path }),
            None if path.exists() && !order.request.overwrite => Err(MovieChoiceError::Exists { path }),
            None => Ok(Some(container)),
        }
    }

    /// What ffmpeg calls it.
    pub fn muxer(self) -> &'static str {
        match self {
            Container::Mp4 => "mp4",
            Container::Mov => "mov",
            Container::Mkv => "matroska",
            Container::WebM => "webm",
        }
    }

    /// The encoder of its frames, as ffmpeg calls it.
    pub fn encoder(self) -> &'static str {
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
