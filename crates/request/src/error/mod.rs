//! What can end the work on a request.

mod cluster;
mod manifest;
mod movie;
mod output;
mod request;
mod stage;

use std::error::Error as Source;

use lightmesh_image::SaveError;
use lightmesh_render::{MeshFileError, MeshSaveError, RenderError};
use lightmesh_scene::{CameraError, LoadError};

use crate::told::{Told, display_by_fields};
use crate::words::{Name, Words};
pub use cluster::ClusterError;
pub use manifest::ManifestError;
pub(crate) use movie::FFMPEG;
pub use movie::{MovieChoiceError, MovieError};
pub use output::OutputError;
pub use request::RequestError;
pub use stage::StageError;

/// Why work on a request ended early.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// The request cannot be met.
    Request(RequestError),
    /// The scene cannot be read.
    Load(Box<LoadError>),
    /// The scene cannot be lit or seen as requested.
    Stage(StageError),
    /// The image cannot be rendered.
    Render(RenderError),
    /// The image cannot be stored.
    Save(SaveError),
    /// An output cannot be written.
    Output(OutputError),
    /// A movie cannot be encoded.
    Movie(MovieError),
    /// Many processes cannot do it together.
    Cluster(ClusterError),
    /// A film's manifest cannot be written.
    Manifest(Box<ManifestError>),
    /// A file of light points and gathered light cannot be read.
    Mesh(MeshFileError),
    /// A file of light points and gathered light cannot be written.
    MeshSave(MeshSaveError),
    /// A film ended early.
    Frame {
        /// The frame that failed.
        number: u32,
        /// The film's last one.
        last: u32,
        /// How many frames that were asked for are there.
        finished: usize,
        /// The setting that goes on with them.
        goes_on: Name,
        /// Why.
        cause: Box<Error>,
    },
}

impl Told for Error {
    fn told(&self, words: Words) -> String {
        match self {
            Error::Request(error) => error.told(words),
            Error::Load(error) => error.to_string(),
            Error::Stage(error) => error.told(words),
            Error::Render(error) => error.to_string(),
            Error::Save(error) => error.to_string(),
            Error::Output(error) => error.told(words),
            Error::Movie(error) => error.told(words),
            Error::Cluster(error) => error.told(words),
            Error::Manifest(error) => error.told(words),
            Error::Mesh(error) => error.to_string(),
            Error::MeshSave(error) => error.to_string(),
            Error::Frame { number, last, finished, goes_on, cause } => {
                let there = what_is_there(*finished, &words.on(goes_on));
                format!("frame {number} of {last}: {}{there}", cause.told(words))
            }
        }
    }
}

/// What is there of a film, and how to go on.
fn what_is_there(count: usize, goes_on: &str) -> String {
    match count {
        0 => String::new(),
        1 => format!("; 1 frame is finished ({goes_on} goes on)"),
        count => format!("; {count} frames are finished ({goes_on} goes on)"),
    }
}

impl Error {
    /// What happened, without the frame of a film in which it did.
    pub fn into_cause(self) -> Error {
        match self {
            Error::Frame { cause, .. } => cause.into_cause(),
            cause => cause,
        }
    }

    /// Whether more free memory would have helped.
    pub(crate) fn is_of_memory(&self) -> bool {
        matches!(self, Error::Render(error) if error.is_of_memory())
    }

    /// What happened to frame `number` of a film up to `last`, of which some are `finished`: `goes_on` goes on with them.
    pub(crate) fn in_frame(self, number: u32, last: u32, finished: usize, goes_on: Name) -> Error {
        match self {
            Error::Render(RenderError::Cancelled) => self,
            cause => Error::Frame { number, last, finished, goes_on, cause: Box::new(cause) },
        }
    }
}

display_by_fields!(Error);

impl Source for Error {
    fn source(&self) -> Option<&(dyn Source + 'static)> {
        match self {
            Error::Request(error) => error.source(),
            Error::Load(error) => error.source(),
            Error::Stage(error) => error.source(),
            Error::Render(error) => error.source(),
            Error::Save(error) => error.source(),
            Error::Output(error) => error.source(),
            Error::Movie(error) => error.source(),
            Error::Cluster(error) => error.source(),
            Error::Manifest(error) => error.source(),
            Error::Mesh(error) => error.source(),
            Error::MeshSave(error) => error.source(),
            Error::Frame { cause, .. } => Some(cause),
        }
    }
}

/// An error that is one of another type as it is.
macro_rules! from {
    ($($type:ident: $($variant:ident($error:ty)),*;)*) => {
        $($(impl From<$error> for $type {
            fn from(error: $error) -> $type {
                $type::$variant(error)
            }
        })*)*
    };
}

from! {
    RequestError: Save(SaveError), Output(OutputError), Camera(CameraError), Movie(MovieChoiceError);
    Error: Request(RequestError), Stage(StageError), Render(RenderError), Save(SaveError), Output(OutputError),
        Movie(MovieError), Cluster(ClusterError), Mesh(MeshFileError), MeshSave(MeshSaveError);
}

impl From<ManifestError> for RequestError {
    fn from(error: ManifestError) -> RequestError {
        RequestError::Manifest(Box::new(error))
    }
}

impl From<LoadError> for Error {
    fn from(error: LoadError) -> Error {
        Error::Load(Box::new(error))
    }
}

impl From<ManifestError> for Error {
    fn from(error: ManifestError) -> Error {
        Error::Manifest(Box::new(error))
    }
}

#[cfg(test)]
mod tests {
    use lightmesh_render::Crop;

    use super::*;

    #[test]
    fn a_message_is_in_the_words_of_its_face() {
        let error = RequestError::Crop { crop: Crop::new([-70_000, 0], [10, 10]), size: [64, 48] };
        assert_eq!(
            error.told(Words::Flags),
            "--crop -70000,0,10,10 is more than 65536 pixels beyond the image of 64x48 pixels; choose a part of the image, or what is next to \
             it (--crop, --size)"
        );
        assert_eq!(
            error.to_string(),
            "crop=-70000,0,10,10 is more than 65536 pixels beyond the image of 64x48 pixels; choose a part of the image, or what is next to it \
             (crop, size)"
        );
    }

    #[test]
    fn a_film_that_ended_says_what_is_there() {
        let ended = |finished| {
            let cause = Error::Render(RenderError::Device { device: "cuda".into(), reason: "none".into() });
            cause.in_frame(3, 9, finished, "resume")
        };
        assert!(ended(2).told(Words::Flags).ends_with("; 2 frames are finished (--resume goes on)"));
        assert!(ended(1).to_string().ends_with("; 1 frame is finished (resume=True goes on)"));
        let cancelled = Error::from(RenderError::Cancelled).in_frame(3, 9, 2, "resume");
        assert!(matches!(cancelled, Error::Render(RenderError::Cancelled)));
    }
}
