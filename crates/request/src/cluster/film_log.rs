//! The log of a film that others render: which frames are left, and which are finished. It is the manifest of a film by one process, so that either
//! can go on with what the other has begun.

use super::{Chosen, FileRecord, Input};
use crate::error::{ClusterError, Error, RequestError};
use crate::files::{publish, ready};
use crate::host::Host;
use crate::manifest::{self, Manifest};
use crate::order::Order;
use crate::plan::Plan;

/// The log of a film.
pub struct FilmLog {
    plan: Plan,
    inputs: Vec<Input>,
    manifest: Manifest,
    numbers: Vec<u32>,
    kept: usize,
    last: u32,
}

impl FilmLog {
    /// Begins a film or goes on with it: reads the scene, and writes the manifest.
    ///
    /// # Errors
    /// [`Error`]; [`ClusterError`] for what only one process can render.
    pub fn begin(order: Order, host: &dyn Host) -> Result<FilmLog, Error> {
        ClusterError::check_film(&order)?;
        let plan = Plan::new(order)?;
        let scene = plan.open(host)?;
        if let Some(text) = plan.files.misnamed(host.words()) {
            host.warning(&text);
        }
        let film = plan.film.as_ref().ok_or(RequestError::NoFilm)?;
        manifest::check(&plan.order)?;
        let mut range = film.work(&plan.order, &scene)?;
        let manifest = Manifest::begin(&plan.order, film, &scene, &mut range, host)?;
        let inputs = Input::all_of(&plan.order, &scene)?;
        Ok(FilmLog { inputs, manifest, numbers: range.numbers, kept: range.skipped, last: range.last, plan })
    }

    /// What it is a film of.
    pub fn order(&self) -> &Order {
        &self.plan.order
    }

    /// The files that the scene is read from.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The numbers of the frames that were left when it began.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// How many frames were there and are kept.
    pub fn kept(&self) -> usize {
        self.kept
    }

    /// The film's last frame.
    pub fn last(&self) -> u32 {
        self.last
    }

    /// Exposure and step for all frames, if they are chosen.
    pub fn chosen(&self) -> Option<Chosen> {
        self.manifest.chosen()
    }

    /// A worker has chosen them. They are recorded with the first frame.
    pub fn choose(&mut self, chosen: Chosen) {
        self.manifest.choose(chosen);
    }

    /// Whether the manifest was once written with this seal.
    pub fn has_written(&self, seal: &str) -> bool {
        self.manifest.has_written(seal)
    }

    /// Writes the file of a frame that a worker without this disk has sent.
    ///
    /// # Errors
    /// [`Error`] if it cannot be written; [`ClusterError::Damaged`] if it is not what the worker has written.
    pub fn publish(&self, number: u32, bytes: &[u8], files: &[FileRecord]) -> Result<(), Error> {
        let film = self.plan.film.as_ref().ok_or(RequestError::NoFilm)?;
        let own = film.files(&self.plan.order, number)?;
        let path = own.picture_file().ok_or(RequestError::NoFilm)?;
        if !files.iter().all(|file| file.is_of(bytes)) {
            return Err(ClusterError::Damaged { path: path.to_owned() }.into());
        }
        Ok(publish(vec![ready(path, bytes)?])?)
    }

    /// The files of a frame are published: it is finished.
    ///
    /// # Errors
    /// [`Error::Manifest`] if that cannot be recorded.
    pub fn finished(&mut self, number: u32, files: Vec<FileRecord>) -> Result<(), Error> {
        Ok(self.manifest.record_finished(number, files)?)
    }

    /// Records what is not yet recorded.
    ///
    /// # Errors
    /// As [`FilmLog::finished`].
    pub fn close(&mut self) -> Result<(), Error> {
        Ok(self.manifest.close()?)
    }
}

impl Drop for FilmLog {
    fn drop(&mut self) {
        // Nobody is there to hear of it; at worst, frames are rendered again.
        let _ = self.manifest.close();
    }
}
