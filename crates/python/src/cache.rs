//! What is kept from image to image.

use std::convert::Infallible;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use lightmesh::MeshCache as Kept;
use lightmesh_memory::Budget;
use pyo3::prelude::*;

use crate::argument::Given;
use crate::errors::OrRaise;
use crate::prepared::PreparedScene;
use crate::process::{self, PerProcess};

/// What light points see and surfaces gather, kept from image to image. Images are the same without it. A process that is forked begins with
/// an empty one.
#[pyclass(frozen, module = "lightmesh")]
pub(crate) struct MeshCache {
    kept: PerProcess<Mutex<Kept>>,
}

impl MeshCache {
    /// The cache, which serves one image at a time. To be asked for without the interpreter: another thread may need it to be done.
    pub(crate) fn lock(&self) -> MutexGuard<'_, Kept> {
        let Ok(kept) = self.kept.get_or_make(|| Ok::<_, Infallible>(Mutex::default()));
        kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl MeshCache {
    #[new]
    fn new() -> MeshCache {
        MeshCache { kept: PerProcess::new(Mutex::default()) }
    }

    /// Reads the file `path` of `save`, or of `--mesh-file`, for a `prepared` scene. Raises `MeshFileError`.
    #[staticmethod]
    fn load(py: Python<'_>, path: Given<PathBuf>, prepared: Given<Bound<'_, PreparedScene>>) -> PyResult<MeshCache> {
        let prepared = prepared.get().prepared();
        let kept = process::detach(py, || Kept::load(&*path, prepared, Budget::default()))?.or_raise()?;
        Ok(MeshCache { kept: PerProcess::new(Mutex::new(kept)) })
    }

    /// Writes light points and gathered light of a `prepared` scene to `path`, and returns the number of light points; if nothing is kept, no file is
    /// written.
    fn save(&self, py: Python<'_>, path: Given<PathBuf>, prepared: Given<Bound<'_, PreparedScene>>) -> PyResult<u64> {
        let prepared = prepared.get().prepared();
        let saved = process::detach(py, || self.lock().save(&*path, prepared))?.or_raise()?;
        Ok(saved.map_or(0, |saved| saved.values))
    }

    /// Forgets everything.
    fn clear(&self, py: Python<'_>) {
        py.detach(|| self.lock().clear());
    }

    /// Light points times lights.
    fn __len__(&self, py: Python<'_>) -> usize {
        py.detach(|| self.lock().len() as usize)
    }

    /// Bytes on the host and on devices.
    #[getter]
    fn memory(&self, py: Python<'_>) -> u64 {
        py.detach(|| self.lock().memory())
    }

    /// An empty cache is a cache, too.
    fn __bool__(&self) -> bool {
        true
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        format!("<lightmesh.MeshCache of {} values>", self.__len__(py))
    }
}
