//! What can be wrong with a request, and what can end its work.

use std::error::Error as Source;
use std::path::PathBuf;

use lightmesh_image::SaveError;
use lightmesh_render::{Crop, MeshFileError, MeshSaveError, RenderError};
use lightmesh_scene::{CameraError, LoadError};

use crate::files::OutputError;
use crate::film::{MovieChoiceError, MovieError};
use crate::manifest::ManifestError;
use crate::stage::StageError;
use crate::table::{Kind, Value};
use crate::told::{Told, display_by_fields};
use crate::value::{Frames, SunSpec};
use crate::words::{Name, Words};

/// Why a request cannot be met, as far as that is known before any work.
#[derive(Debug)]
#[non_exhaustive]
pub enum RequestError {
    /// There is no such setting.
    Unknown {
        /// The name that was given.
        name: String,
        /// One like it.
        similar: Option<Name>,
    },
    /// A value cannot be used.
    Value {
        /// The setting.
        setting: Name,
        /// The value.
        value: Value,
        /// What is wrong with it.
        problem: String,
    },
    /// Two settings exclude each other.
    Conflict {
        /// One of them.
        first: Name,
        /// The other.
        second: Name,
    },
    /// A setting means nothing without another one.
    Requires {
        /// The setting.
        setting: Name,
        /// The other.
        needed: Name,
    },
    /// A setting is needed and not given.
    Missing {
        /// The setting.
        setting: Name,
    },
    /// An image file of this name cannot be written.
    Save(SaveError),
    /// An output cannot be written.
    Output(OutputError),
    /// The camera cannot be used.
    Camera(CameraError),
    /// A film cannot be resumed.
    Manifest(Box<ManifestError>),
    /// A film cannot become a movie.
    Movie(MovieChoiceError),
    /// The part of the image is not in it.
    Crop {
        /// The part.
        crop: Crop,
        /// Width and height of the image.
        size: [u32; 2],
    },
    /// The image goes to standard output, which has no extension.
    NoFormat,
    /// A mesh file that is no file.
    MeshOnStdout,
    /// A file of a film whose name has no place for the number of the frame.
    NoNumber {
        /// Which of the files.
        output: Name,
        /// The file.
        path: PathBuf,
    },
    /// Frames that the film does not have.
    NoFrame {
        /// The frames that were asked for.
        frames: Frames,
        /// The film's last one.
        last: u32,
    },
    /// Nothing in the scene moves.
    NotAnimated,
    /// What is said of frames where there are none.
    NoFilm,
    /// Frames that were rendered before.
    FrameExists {
        /// The first of their images.
        first: PathBuf,
        /// How many there are.
        count: usize,
    },
    /// The sun of a study shines from a clear sky.
    SunWithoutSky,
    /// It is night all the time.
    NoSun {
        /// The hours that were asked for.
        spec: SunSpec,
    },
    /// A file for hours of direct sun of an unknown format.
    HoursFormat {
        /// The file.
        path: PathBuf,
    },
    /// A grid is described, but another structure is selected.
    NoGrid {
        /// What describes the grid.
        setting: Name,
        /// The structure that was selected.
        chosen: &'static str,
    },
}

impl Told for RequestError {
    fn told(&self, words: Words) -> String {
        let of = |name| words.of(name);
        match self {
            RequestError::Unknown { name, similar } => match similar {
                Some(similar) => format!("there is no setting {name}; did you mean {}?", of(similar)),
                None => format!("there is no setting {name}"),
            },
            RequestError::Value { setting, value, problem } => {
                format!("{} cannot be {}: {}", of(setting), shown(value), advice(setting, problem))
            }
            RequestError::Conflict { first, second } => {
                format!("{} and {} cannot be given together; leave out one of them", of(first), of(second))
            }
            RequestError::Requires { setting, needed } => {
                let (setting, needed) = (of(setting), of(needed));
                format!("{setting} needs {needed}; give it, too, or leave {setting} out")
            }
            RequestError::Missing { setting } => format!("{} is needed; give it", of(setting)),
            RequestError::Save(error) => error.to_string(),
            RequestError::Output(error) => error.told(words),
            RequestError::Camera(error) => error.to_string(),
            RequestError::Manifest(error) => error.told(words),
            RequestError::Movie(error) => error.told(words),
            RequestError::Crop { crop, size: [width, height] } => format!(
                "{} exceeds the image of {width}x{height} pixels; choose a part of the image ({}, {})",
                words.with("crop", crop),
                of("crop"),
                of("size")
            ),
            RequestError::NoFormat => format!(
                "{} - needs the format of the image; add {}",
                of("output"),
                words.with("format", "bmp, png, exr or jpg")
            ),
            RequestError::MeshOnStdout => format!(
                "{} cannot be standard output, since the file is read and written; name a file",
                words.with("mesh_file", "-")
            ),
            RequestError::NoNumber { output, path } => format!(
                "{} {} is one file, but a film has one for each frame; write #### where the number goes, as in film.####.png",
                of(output),
                path.display()
            ),
            RequestError::NoFrame { frames, last } => format!(
                "{}: the film ends with frame {last}; choose frames up to it ({}, {}, {}, {})",
                words.with("frames", frames),
                of("frames"),
                of("turntable"),
                of("fps"),
                of("sun")
            ),
            RequestError::NotAnimated => format!(
                "nothing in the scene moves; add {} for a film in which the camera goes around it, or render one image such as \
                 image.png, without {} and {}",
                words.with("turntable", "N"),
                of("frames"),
                of("fps")
            ),
            RequestError::NoFilm => format!(
                "{}, {} and {} are for films; add {}, {} or {}, or remove them",
                of("resume"),
                of("skip_existing"),
                of("overwrite"),
                of("frames"),
                of("fps"),
                of("turntable")
            ),
            RequestError::FrameExists { first, count } => format!(
                "{} exists{}; add {} to keep such frames, or {} to replace them",
                first.display(),
                others(*count),
                words.on("skip_existing"),
                words.on("overwrite")
            ),
            RequestError::SunWithoutSky => format!(
                "{} needs a clear sky, but {} chooses another; write {} with its options, or omit it",
                of("sun"),
                of("sky"),
                words.with("sky", "clear")
            ),
            RequestError::NoSun { spec } => format!(
                "{}: the sun is below the horizon at all of these moments; choose another date, other hours or a smaller step",
                words.with("sun", spec)
            ),
            RequestError::HoursFormat { path } => format!(
                "{}: unknown format; use the extension exr, png or csv",
                words.with("sun_hours", path.display())
            ),
            RequestError::NoGrid { setting, chosen } => format!(
                "{} specifies a grid, but {} selects another structure; remove one of them",
                of(setting),
                words.with("accel", chosen)
            ),
        }
    }
}

/// A value for people.
fn shown(value: &Value) -> String {
    match value {
        Value::Switch(is_on) => is_on.to_string(),
        Value::Whole(whole) => whole.to_string(),
        Value::Number(number) => number.to_string(),
        Value::Text(text) => format!("`{text}`"),
        Value::List(items) => format!("[{}]", items.iter().map(shown).collect::<Vec<_>>().join(", ")),
    }
}

/// What is wrong with a value, or the words that can be chosen.
fn advice(setting: Name, problem: &str) -> String {
    let choices = crate::fields::field(setting).filter(|field| field.kind == Kind::Value);
    let choices = choices.map(|field| (field.choices)()).unwrap_or_default();
    let names: Vec<&str> = choices.iter().map(|choice| choice.name).collect();
    match names.split_last() {
        Some((last, others)) if !others.is_empty() => format!("choose {} or {last}", others.join(", ")),
        _ => problem.to_owned(),
    }
}

/// Further files besides the first.
fn others(count: usize) -> String {
    match count - 1 {
        0 => String::new(),
        1 => " and one more".to_owned(),
        more => format!(" and {more} more"),
    }
}

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

    /// What happened to frame `number` of a film up to `last`, of which some are `finished`: `goes_on` goes on with them.
    pub(crate) fn in_frame(self, number: u32, last: u32, finished: usize, goes_on: Name) -> Error {
        match self {
            Error::Render(RenderError::Cancelled) => self,
            cause => Error::Frame { number, last, finished, goes_on, cause: Box::new(cause) },
        }
    }
}

display_by_fields!(RequestError, Error);

impl Source for RequestError {
    fn source(&self) -> Option<&(dyn Source + 'static)> {
        match self {
            RequestError::Save(error) => error.source(),
            RequestError::Output(error) => error.source(),
            RequestError::Camera(error) => error.source(),
            RequestError::Manifest(error) => error.source(),
            _ => None,
        }
    }
}

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
        Movie(MovieError), Mesh(MeshFileError), MeshSave(MeshSaveError);
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
    use super::*;

    #[test]
    fn a_message_is_in_the_words_of_its_face() {
        let error = RequestError::Crop { crop: Crop::new([60, 0], [10, 10]), size: [64, 48] };
        assert_eq!(
            error.told(Words::Flags),
            "--crop 60,0,10,10 exceeds the image of 64x48 pixels; choose a part of the image (--crop, --size)"
        );
        assert_eq!(
            error.to_string(),
            "crop=60,0,10,10 exceeds the image of 64x48 pixels; choose a part of the image (crop, size)"
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
