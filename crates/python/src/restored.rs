//! Objects of the bytes that [`stored`](crate::stored) has made.

use pyo3::prelude::*;
use serde::de::DeserializeOwned;

use crate::camera::Camera;
use crate::environment::Environment;
use crate::errors;
use crate::geometry::Geometry;
use crate::light::Light;
use crate::material::Material;
use crate::scene::Scene;
use crate::stored::VERSION;
use crate::texture::Texture;

/// The object of bytes of [`reduce`](crate::stored::reduce).
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
