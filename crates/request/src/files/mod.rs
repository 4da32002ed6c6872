//! The files that are made of a request: which they are, and that none of them replaces another one or an input.

mod destination;
mod outputs;
mod picture;

use std::path::{Path, PathBuf};

pub use destination::{Destination, check_one_on_stdout, is_standard};
pub use outputs::{Outputs, input, json, publish, ready};

pub use crate::error::OutputError;
pub use picture::{PictureFiles, misnamed};
pub(crate) use picture::{hours_of_sun, save_options};

use crate::words::Name;

/// The files to write, by the names of the settings that name them. `-` stands for standard output.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Files {
    /// The image; of a film, a pattern such as `film.####.png`, or a movie.
    pub output: Option<PathBuf>,
    /// A multilayer exr with depth, normals, positions, light and ids.
    pub layers: Option<PathBuf>,
    /// Counts, timings and resolved settings as JSON.
    pub stats: Option<PathBuf>,
    /// Hours of direct sun of a sun study: exr, png or csv.
    pub sun_hours: Vec<PathBuf>,
    /// Light points and gathered light, which are read, too.
    pub mesh_file: Option<PathBuf>,
}

impl Files {
    /// The names of the settings that name files.
    pub const NAMES: [Name; 5] = ["output", "layers", "stats", "sun_hours", "mesh_file"];

    /// All of them.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let single = [&self.output, &self.layers, &self.stats, &self.mesh_file].into_iter().flatten();
        single.chain(&self.sun_hours).map(PathBuf::as_path)
    }

    /// The image; an empty path if there is none.
    pub(crate) fn picture(&self) -> &Path {
        self.output.as_deref().unwrap_or(Path::new(""))
    }
}
