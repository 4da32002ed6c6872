//! Where files go: to a path, or into an object of Python that is open for writing.

use std::path::{Path, PathBuf};

use lightmesh::request::Words;
use lightmesh::request::files::misnamed;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::argument::Given;
use crate::errors;
use crate::warning::{self, About};

/// Where a file goes.
pub(crate) enum Target {
    Path(PathBuf),
    File(Py<PyAny>),
}

impl FromPyObject<'_, '_> for Target {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Target> {
        // Temporary files are both; what was opened is what is meant.
        if object.hasattr("write")? {
            return Ok(Target::File(object.to_owned().unbind()));
        }
        match object.extract::<Given<PathBuf>>() {
            Ok(Given(path)) => Ok(Target::Path(path)),
            Err(_) => Err(errors::wrong_type("a path or a file that is open for writing", &object)),
        }
    }
}

/// Writes a whole file into an open one.
pub(crate) fn write(py: Python<'_>, file: &Py<PyAny>, bytes: &[u8]) -> PyResult<()> {
    match file.call_method1(py, "write", (PyBytes::new(py, bytes),)) {
        Ok(_) => Ok(()),
        Err(error) if error.is_instance_of::<PyTypeError>(py) => {
            let message = error.value(py).to_string();
            Err(errors::argument(format!(
                "the file does not take bytes ({message}): open it in binary mode, as in open(path, 'wb')"
            )))
        }
        Err(error) => Err(error),
    }
}

/// Warns of a file that is `written` in another format than its extension has `named`, where both are known.
pub(crate) fn warn_if_misnamed(
    py: Python<'_>,
    path: &Path,
    written: Option<&str>,
    named: Option<&str>,
) -> PyResult<()> {
    let text = written.zip(named).and_then(|formats| misnamed(("path", path), formats, Words::Fields));
    text.map_or(Ok(()), |text| warning::warn(py, About::Other, &text))
}

/// A format that no extension says.
pub(crate) fn no_format(formats: &str) -> PyErr {
    errors::setting(format!("an open file has no extension: say which format, as in format='png' ({formats})"))
}
