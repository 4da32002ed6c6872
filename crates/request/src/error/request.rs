//! What can be wrong with a request, as far as that is known before any work.

use std::error::Error as Source;
use std::path::PathBuf;

use lightmesh_image::SaveError;
use lightmesh_render::Crop;
use lightmesh_scene::CameraError;

use super::{ManifestError, MovieChoiceError, OutputError};
use crate::table::Value;
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
    /// A setting of light points, where there are none.
    NoLightPoints {
        /// The setting.
        setting: Name,
        /// What has chosen shadows without them, and its value.
        chosen: (Name, &'static str),
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
    /// The part of the image is too far from it.
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
    /// A film in which nothing moves.
    NoFilm,
    /// What is said of frames where there are none.
    OfFilm {
        /// The setting.
        setting: Name,
        /// Whether there are hours of direct sun.
        has_hours: bool,
    },
    /// A day of which nothing is kept.
    NothingOfSun,
    /// Frames that were rendered before.
    FrameExists {
        /// The first of their images.
        first: PathBuf,
        /// How many there are.
        count: usize,
    },
    /// The sun of a study shines from a clear sky.
    SunWithoutSky,
    /// It is night all the time, which has no frames.
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
                format!("{} cannot be {}: {}", of(setting), shown(value), problem)
            }
            RequestError::Conflict { first, second } => {
                format!("{} and {} cannot be given together; leave out one of them", of(first), of(second))
            }
            RequestError::Requires { setting, needed } => {
                let (setting, needed) = (of(setting), of(needed));
                format!("{setting} needs {needed}; give it, too, or leave {setting} out")
            }
            RequestError::NoLightPoints { setting, chosen: (name, value) } => {
                let without = if *name == "mode" { format!(" without {}", of(name)) } else { String::new() };
                format!(
                    "{} is of light points, which {} does not have; leave it out, or choose {}{without}",
                    of(setting),
                    words.with(name, value),
                    words.with("lookup", "half-ball")
                )
            }
            RequestError::Missing { setting } => format!("{} is needed; give it", of(setting)),
            RequestError::Save(error) => error.to_string(),
            RequestError::Output(error) => error.told(words),
            RequestError::Camera(error) => error.to_string(),
            RequestError::Manifest(error) => error.told(words),
            RequestError::Movie(error) => error.told(words),
            RequestError::Crop { crop, size: [width, height] } => format!(
                "{} is more than 65536 pixels beyond the image of {width}x{height} pixels; choose a part of the image, or what is next to it ({}, {})",
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
            RequestError::NoFrame { frames, .. } if frames.first() < 1 => {
                format!("{}: films begin with frame 1; choose frames from there on", words.with("frames", frames))
            }
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
            RequestError::NoFilm => format!("nothing moves, so there is no film; add {}", what_moves(words)),
            RequestError::OfFilm { setting, has_hours: true } => format!(
                "{} is for frames of a film, and hours of direct sun have none; leave it out (files of hours are replaced), or write frames, too ({})",
                of(setting),
                words.with("output", "film.####.png")
            ),
            RequestError::OfFilm { setting, has_hours: false } => {
                format!("{} is for films; add {}, or leave it out", of(setting), what_moves(words))
            }
            RequestError::NothingOfSun => format!(
                "{} needs an output; add {} for a frame of each STEP, {} for the hours of direct sun, or both",
                of("sun"),
                words.with("output", "film.####.png"),
                words.with("sun_hours", "hours.png")
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
                "{}: the sun is below the horizon at all of these moments, so there is no frame; choose another date, other hours or a smaller \
                 step, or write only the hours, which are 0 ({})",
                words.with("sun", spec),
                words.of("sun_hours")
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

/// What makes a film.
fn what_moves(words: Words) -> String {
    let [turntable, sun, frames, fps] = ["turntable", "sun", "frames", "fps"].map(|name| words.of(name));
    format!("{turntable}, {sun}, {frames} or {fps}")
}

/// Further files besides the first.
fn others(count: usize) -> String {
    match count - 1 {
        0 => String::new(),
        1 => " and one more".to_owned(),
        more => format!(" and {more} more"),
    }
}

display_by_fields!(RequestError);

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
