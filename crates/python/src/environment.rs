//! What surrounds scenes.

use std::path::PathBuf;
use std::sync::Arc;

use lightmesh::scene::{self, Up};
use lightmesh_memory::Budget;
use pyo3::prelude::*;

use crate::convert;
use crate::errors::{self, OrRaise};

/// What surrounds a scene: an equirectangular panorama of linear radiance, (H, W, 3) `float32`, straight up in its first row, with
/// the north in its middle: -Z if `up` is "y", +Y if it is "z". East, +X, is to its right. `rotation` turns it clockwise as seen from above,
/// degrees; `strength` multiplies it. If it shows a sun, that becomes a light, and so do other regions that are much brighter than the rest.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone)]
pub(crate) struct Environment {
    pub(crate) environment: Arc<scene::Environment>,
}

/// The axis that is up.
pub(crate) fn axis(up: &str) -> PyResult<Up> {
    up.parse().map_err(|error| errors::setting(format!("{error}")))
}

#[pymethods]
impl Environment {
    #[new]
    #[pyo3(
        signature = (pixels, *, up = "y", rotation = 0.0, strength = 1.0, find_sun = true, name = String::new()),
        text_signature = "(pixels, *, up='y', rotation=0.0, strength=1.0, find_sun=True, name='')"
    )]
    fn new(
        pixels: &Bound<'_, PyAny>,
        up: &str,
        rotation: f32,
        strength: f32,
        find_sun: bool,
        name: String,
    ) -> PyResult<Environment> {
        let (size, channels, values) = convert::image::<f32>("pixels", pixels, "float32")?;
        if values.iter().any(|value| !(value.is_finite() && *value >= 0.0)) {
            return Err(errors::setting("pixels must be finite and not negative"));
        }
        let texels = values.chunks_exact(channels).map(|texel| [texel[0], texel[1], texel[2]]).collect();
        let environment = scene::Environment::new(name, size, texels, axis(up)?);
        let environment = if find_sun { environment.find_sun().find_lights() } else { environment };
        Ok(Environment::of(environment, rotation, strength))
    }

    /// Reads an .hdr or .exr file.
    #[staticmethod]
    #[pyo3(signature = (path, *, up = "y", rotation = 0.0, strength = 1.0))]
    fn open(py: Python<'_>, path: PathBuf, up: &str, rotation: f32, strength: f32) -> PyResult<Environment> {
        let up = axis(up)?;
        let environment = py.detach(|| scene::Environment::open(&path, up, Budget::default())).or_raise()?;
        Ok(Environment::of(environment, rotation, strength))
    }

    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.environment.size().into()
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.environment.size();
        format!("<lightmesh.Environment {:?} {width}x{height}>", self.environment.name)
    }
}

impl Environment {
    fn of(environment: scene::Environment, rotation: f32, strength: f32) -> Environment {
        Environment { environment: environment.turned(rotation).scaled(strength).into() }
    }
}
