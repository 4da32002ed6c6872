//! One film or picture by many processes, on one machine or several: one of them leads, the others work.
//!
//! ```text
//! leader   FilmLog ──▶ numbers of frames ──▶ Worker ──▶ published files ──▶ FileRecord ──▶ FilmLog: manifest.json
//!          BandedPicture ──▶ Pass, rows ──▶ Worker ──▶ Band ──▶ BandedPicture: the picture's file
//! ```
//!
//! * The leader reads the scene, and neither builds its structure nor renders. It alone writes the manifest, which is that of a film by one process.
//! * A [`Worker`] has the scene prepared on its device, and renders whatever part it is told to, in any order.
//! * [`Input`]s are the files that both need, with checksums by which they are compared.
//!
//! Who sends what to whom, and what happens if somebody dies, is not known here.

mod band;
mod film_log;
mod inputs;
mod picture;
mod request;
mod worker;

use std::path::Path;

use lightmesh_files::directory;
use lightmesh_scene::Scene;

pub use crate::manifest::{Chosen, FileRecord};
pub use band::{Band, Pass};
pub use film_log::FilmLog;
pub use inputs::{Input, digest_of, files_of};
pub use picture::BandedPicture;
pub use request::for_workers;
pub use worker::{FrameWritten, Worker};

use crate::error::Error;
use crate::expose::Metering;
use crate::host::Host;
use crate::manifest;
use crate::plan::Plan;

/// The seal of the manifest in the folder of a film, if there is one: whoever sees the same sees the same folder.
pub fn seal_beside(output: &Path) -> Option<String> {
    manifest::seal_in(directory(output))
}

/// Removes the temporary files that dead processes of this system have left in the folder of an output.
pub fn sweep_beside(output: &Path) {
    lightmesh_files::remove_all_stale(directory(output));
}

/// A scene with the camera, the lights and the ground that it lacks, and how its images are exposed.
pub(crate) fn staged(plan: &Plan, scene: &mut Scene, host: &dyn Host) -> Result<Metering, Error> {
    use lightmesh_image::Format;
    if let Some(file) = plan.staging.file() {
        plan.files.outputs.keep("the environment", Some(file))?;
    }
    let staged = plan.staging.apply(scene, host)?;
    let is_linear = plan.files.format() == Some(Format::Exr);
    Ok(Metering::of_staged(scene, &staged, plan.files.exposure, is_linear, plan.settings.transparent))
}
