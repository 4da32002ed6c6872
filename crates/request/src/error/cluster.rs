//! What many processes cannot do together.

use std::path::PathBuf;

use crate::film::Container;
use crate::order::Order;
use crate::told::{Told, display_by_fields};
use crate::words::{Name, Words};

/// Why a film or a picture is not rendered by many processes.
#[derive(Debug)]
#[non_exhaustive]
pub enum ClusterError {
    /// It has no output.
    NoOutput,
    /// A movie is one file.
    Movie {
        /// The movie.
        path: PathBuf,
    },
    /// Standard input can be read once, on one machine.
    StandardInput,
    /// What this setting asks for is made by one process alone.
    Setting {
        /// The setting.
        setting: Name,
    },
    /// Rows that the picture does not have.
    Rows {
        /// The first of them.
        first: i64,
        /// How many.
        rows: u32,
    },
    /// Bands that do not make a picture.
    Bands {
        /// The rows of the picture.
        rows: i64,
    },
    /// A file has other bytes than its worker has written.
    Damaged {
        /// The file.
        path: PathBuf,
    },
}

impl ClusterError {
    /// Checks that frames can be rendered by many processes.
    pub(crate) fn check_film(order: &Order) -> Result<(), ClusterError> {
        let Some(output) = &order.files.output else { return Err(ClusterError::NoOutput) };
        if Container::from_path(output).is_some() {
            return Err(ClusterError::Movie { path: output.clone() });
        }
        ClusterError::check_request(order)
    }

    /// Checks that the rows of a picture can be rendered by many processes.
    pub(crate) fn check_picture(order: &Order) -> Result<(), ClusterError> {
        let request = &order.request;
        let of_films: [(Name, bool); 5] = [
            ("turntable", request.turntable.is_some()),
            ("sun", request.sun.is_some()),
            ("frames", request.frames.is_some()),
            ("fps", request.fps.is_some()),
            ("partial", request.partial),
        ];
        match of_films.into_iter().find(|(_, given)| *given) {
            Some((setting, _)) => Err(ClusterError::Setting { setting }),
            None => ClusterError::check_request(order),
        }
    }

    fn check_request(order: &Order) -> Result<(), ClusterError> {
        if order.is_from_stdin() {
            Err(ClusterError::StandardInput)
        } else if order.request.layers {
            Err(ClusterError::Setting { setting: "layers" })
        } else {
            Ok(())
        }
    }
}

impl Told for ClusterError {
    fn told(&self, words: Words) -> String {
        let frames = || words.with("output", "film.####.png");
        match self {
            ClusterError::NoOutput => format!("a film needs files for its frames, as in {}", frames()),
            ClusterError::Movie { path } => format!(
                "{} is one file, and frames come from many processes; write frames, as in {}, and join them with ffmpeg",
                words.with("output", path.display()),
                frames()
            ),
            ClusterError::StandardInput => {
                "a scene on standard input cannot be read by many processes; save it as a file".to_owned()
            }
            ClusterError::Setting { setting } => format!(
                "{} is not for a picture by many processes; leave it out, or render with one process (lightmesh render)",
                words.of(setting)
            ),
            ClusterError::Rows { first, rows } => {
                format!("the picture does not have {rows} rows from row {first} on; ask for rows of its pass")
            }
            ClusterError::Bands { rows } => {
                format!("the bands do not make a picture of {rows} rows; give each row once, and all of them")
            }
            ClusterError::Damaged { path } => {
                format!(
                    "{} is not as its worker has written it; check the network and render the frame again",
                    path.display()
                )
            }
        }
    }
}

impl std::error::Error for ClusterError {}

display_by_fields!(ClusterError);
