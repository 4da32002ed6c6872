//! A worker: what an actor keeps warm.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use lightmesh::request::Order;
use lightmesh::request::cluster::{Band, Pass, Worker};
use lightmesh::request::files::Files;
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

use super::{json, listed, parsed};
use crate::errors::OrRaise;
use crate::process;
use crate::watch::{self, Watch, Wishes};

/// Rows as Python gets them: colours, alpha if there is one, and statistics as text.
type Rows<'py> = (Bound<'py, PyArray3<f32>>, Option<Bound<'py, PyArray2<f32>>>, String);

/// A scene that is prepared on a device; its frames and rows are rendered as they are asked for.
#[pyclass(frozen, module = "lightmesh._lightmesh")]
pub(crate) struct _Worker {
    worker: Mutex<Worker>,
    notes: Vec<String>,
}

impl _Worker {
    fn lock(&self) -> MutexGuard<'_, Worker> {
        self.worker.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl _Worker {
    #[new]
    fn new(py: Python<'_>, scene: PathBuf, output: Option<PathBuf>, request: &str) -> PyResult<_Worker> {
        let order = Order { scene, request: parsed(request)?, files: Files { output, ..Files::default() } };
        let threads = process::threads();
        let open = |watch: &Watch| Worker::open(order, threads, watch).map(|worker| (worker, watch.said()));
        let (worker, notes) = watch::run(py, Wishes::of_warnings(), open)?.or_raise()?;
        Ok(_Worker { worker: Mutex::new(worker), notes })
    }

    /// What was chosen, corrected or guessed, as sentences.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The files that the scene was read from: path, size and checksum.
    #[getter]
    fn inputs(&self) -> Vec<(PathBuf, u64, String)> {
        listed(self.lock().inputs())
    }

    /// The CPU threads that it renders with.
    #[getter]
    fn threads(&self) -> usize {
        self.lock().threads()
    }

    /// What holds for all frames of a film, as text.
    fn choose(&self, py: Python<'_>) -> PyResult<String> {
        let choose = |watch: &Watch| self.lock().choose(watch);
        Ok(json(&watch::run(py, Wishes::of_warnings(), choose)?.or_raise()?))
    }

    /// Renders frame `number` with what was `chosen`, and publishes its file. Returns the record of its files as text, the seconds of the image, those of
    /// its file, and what was said of it.
    fn frame(&self, py: Python<'_>, number: u32, chosen: &str) -> PyResult<(String, f64, f64, Vec<String>)> {
        let chosen = parsed(chosen)?;
        let render = |watch: &Watch| self.lock().frame(number, chosen, watch).map(|written| (written, watch.said()));
        let (written, said) = watch::run(py, Wishes::of_warnings(), render)?.or_raise()?;
        Ok((json(&written.files), written.render, written.write, said))
    }

    /// Renders `rows` rows of a pass, which is given as text, from row `first` of the image on. Returns colours, alpha if there is one, statistics as
    /// text, and the seconds of the image.
    #[pyo3(name = "rows")]
    fn band<'py>(&self, py: Python<'py>, render_pass: &str, first: i64, rows: u32) -> PyResult<(Rows<'py>, f64)> {
        let pass: Pass = parsed(render_pass)?;
        let render = |watch: &Watch| self.lock().band(&pass, first, rows, watch);
        let Band { color, alpha, stats, .. } = watch::run(py, Wishes::of_warnings(), render)?.or_raise()?;
        let (height, width) = (rows as usize, color.len() / rows.max(1) as usize);
        let seconds = stats.seconds.render;
        let color = color.into_flattened().into_pyarray(py).reshape([height, width, 3])?;
        let alpha = alpha.map(|alpha| alpha.into_pyarray(py).reshape([height, width])).transpose()?;
        Ok(((color, alpha, json(&stats)), seconds))
    }
}
