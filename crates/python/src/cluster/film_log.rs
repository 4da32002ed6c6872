//! The log of a film, for the process that leads.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use lightmesh::request::Error;
use lightmesh::request::cluster::FilmLog;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{json, listed, order, parsed, request_for_workers};
use crate::errors::OrRaise;
use crate::process;
use crate::watch::{self, Watch, Wishes};

/// The log of a film that others render: the manifest of a film by one process. Raises what `Renderer.film` raises.
#[pyclass(frozen, module = "lightmesh._lightmesh")]
pub(crate) struct _FilmLog {
    log: Mutex<FilmLog>,
    notes: Vec<String>,
}

impl _FilmLog {
    fn lock(&self) -> MutexGuard<'_, FilmLog> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl _FilmLog {
    #[new]
    fn new(py: Python<'_>, scene: PathBuf, output: PathBuf, settings: &Bound<'_, PyDict>) -> PyResult<_FilmLog> {
        let order = order(scene, Some(output), settings)?;
        let begin = |watch: &Watch| FilmLog::begin(order, watch).map(|log| (log, watch.said()));
        let (log, notes) = watch::run(py, Wishes::of_warnings(), begin)?.or_raise()?;
        Ok(_FilmLog { log: Mutex::new(log), notes })
    }

    /// What was chosen, corrected or guessed, as sentences.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The request of workers, as text.
    #[getter]
    fn request(&self) -> String {
        request_for_workers(self.lock().order())
    }

    /// The files that are needed: path, size and checksum.
    #[getter]
    fn inputs(&self) -> Vec<(PathBuf, u64, String)> {
        listed(self.lock().inputs())
    }

    /// The numbers of the frames that were left when it began.
    #[getter]
    fn numbers(&self) -> Vec<u32> {
        self.lock().numbers().to_vec()
    }

    /// How many frames were there and are kept.
    #[getter]
    fn kept(&self) -> usize {
        self.lock().kept()
    }

    /// The film's last frame.
    #[getter]
    fn last(&self) -> u32 {
        self.lock().last()
    }

    /// What a worker chose for all frames, as text; `None` if that is to be asked.
    #[getter]
    fn chosen(&self) -> Option<String> {
        self.lock().chosen().map(|chosen| json(&chosen))
    }

    /// A worker has `chosen` for all frames.
    fn choose(&self, chosen: &str) -> PyResult<()> {
        self.lock().choose(parsed(chosen)?);
        Ok(())
    }

    /// Whether the manifest was lately written with this `seal`.
    fn has_written(&self, seal: &str) -> bool {
        self.lock().has_written(seal)
    }

    /// Writes the file of frame `number`, its `content`, which a worker without this disk has sent with its `files`.
    fn publish(&self, py: Python<'_>, number: u32, content: &[u8], files: &str) -> PyResult<()> {
        let files: Vec<_> = parsed(files)?;
        process::detach(py, || self.lock().publish(number, content, &files))?.or_raise()
    }

    /// Frame `number` is finished, its `files` are published.
    fn finished(&self, py: Python<'_>, number: u32, files: &str) -> PyResult<()> {
        let files = parsed(files)?;
        process::detach(py, || self.lock().finished(number, files))?.or_raise()
    }

    /// Records what is not yet recorded.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        process::detach(py, || self.lock().close())?.map_err(|error: Error| error).or_raise()
    }
}
