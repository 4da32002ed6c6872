//! Objects as bytes: for `pickle`, by which other processes get them.
//!
//! Bytes are those of serde, and hold in the version of the package that has written them.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use serde::Serialize;

use crate::errors;

/// The version of the package.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What `__reduce__` returns: a function, and its arguments.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// An object of the class `kind` as bytes, and what makes it from them.
pub(crate) fn reduce<'py, T: Serialize + Sync>(py: Python<'py>, kind: &str, object: &T) -> PyResult<Reduced<'py>> {
    let mut bytes = Vec::new();
    py.detach(|| ciborium::into_writer(object, &mut bytes))
        .map_err(|error| errors::other(format!("the {kind} cannot be pickled: {error}")))?;
    let restore = py.import("lightmesh._lightmesh")?.getattr("_restore")?;
    Ok((restore, (kind, VERSION, PyBytes::new(py, &bytes)).into_pyobject(py)?))
}
