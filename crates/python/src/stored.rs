//! Objects as bytes: for `pickle`, by which other processes get them.
//!
//! Bytes are those of serde, and hold in the version of the package that has written them.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::camera::Camera;
use crate::environment::Environment;
use crate::errors;
use crate::geometry::Geometry;
use crate::light::Light;
use crate::material::Material;
use crate::scene::Scene;
use crate::texture::Texture;

/// The version of the package.
const VERSION: &str = env!("CARGO_PKG_VERSION");

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

/// The object of bytes of [`reduce`].
#[pyfunction]
pub(crate) fn _restore<'py>(py: Python<'py>, kind: &str, version: &str, bytes: &[u8]) -> PyResult<Bound<'py, PyAny>> {
    if version != VERSION {
        return Err(errors::setting(format!(
            "a {kind} was pickled by version {version} of lightmesh, and this is {VERSION}: use the same version"
        )));
    }
    fn read<T: DeserializeOwned + Send>(py: Python<'_>, kind: &str, bytes: &[u8]) -> PyResult<T> {
        py.detach(|| ciborium::from_reader(bytes)).map_err(|error: ciborium::de::Error<std::io::Error>| {
            errors::setting(format!("this is no pickled {kind}: {error}"))
        })
    }
    let made = match kind {
        "Camera" => Bound::new(py, read::<Camera>(py, kind, bytes)?)?.into_any(),
        "Environment" => Bound::new(py, read::<Environment>(py, kind, bytes)?)?.into_any(),
        "Geometry" => Bound::new(py, read::<Geometry>(py, kind, bytes)?)?.into_any(),
        "Light" => Bound::new(py, read::<Light>(py, kind, bytes)?)?.into_any(),
        "Material" => Bound::new(py, read::<Material>(py, kind, bytes)?)?.into_any(),
        "Scene" => Bound::new(py, read::<Scene>(py, kind, bytes)?)?.into_any(),
        "Texture" => Bound::new(py, read::<Texture>(py, kind, bytes)?)?.into_any(),
        other => return Err(errors::setting(format!("there is no class {other} that can be pickled"))),
    };
    Ok(made)
}
