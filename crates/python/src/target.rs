//! Where files go: to a path, or into an object of Python that is open for writing.

use std::path::PathBuf;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::argument::Given;
use crate::errors;

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

/// A format that no extension says.
pub(crate) fn no_format(formats: &str) -> PyErr {
    errors::setting(format!("an open file has no extension: say which format, as in format='png' ({formats})"))
}
