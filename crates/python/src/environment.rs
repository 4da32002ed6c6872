//! What surrounds scenes.

use std::path::PathBuf;
use std::sync::Arc;

use lightmesh::scene::{self, Up};
use lightmesh_memory::Budget;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::argument::{Given, Single};
use crate::convert;
use crate::errors::{self, OrRaise};
use crate::process;
use crate::stored::{self, Reduced};

/// What surrounds a scene: `pixels` are an equirectangular panorama of linear radiance, (H, W, 3) `float32`, straight up in its first row, with
/// the north in its middle: -Z if `up` is "y", +Y if it is "z". East, +X, is to its right. `rotation` turns it clockwise as seen from above,
/// degrees; `strength` multiplies it. If it shows a sun, that becomes a light, and so do other regions that are much brighter than the rest,
/// unless `find_sun` is off. `name` is for display.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone, Serialize, Deserialize)]
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
        signature = (
            pixels, *, up = Given(String::from("y")), rotation = Single(0.0), strength = Single(1.0),
            find_sun = Given(true), name = Given(String::new())
        ),
        text_signature = "(pixels, *, up='y', rotation=0.0, strength=1.0, find_sun=True, name='')"
    )]
    fn new(
        pixels: &Bound<'_, PyAny>,
        up: Given<String>,
        rotation: Single,
        strength: Single,
        find_sun: Given<bool>,
        name: Given<String>,
    ) -> PyResult<Environment> {
        let kind = pixels.py().import("numpy")?.call_method1("asarray", (pixels,))?.getattr("dtype")?;
        // Pictures of whole numbers are encoded for display, and cut off what is bright.
        if kind.getattr("kind")?.extract::<String>()? != "f" {
            return Err(errors::setting(format!("pixels must be linear radiance in floating point, not {kind}")));
        }
        let (size, channels, values) = convert::image::<f32>("pixels", pixels, "float32")?;
        if values.iter().any(|value| !(value.is_finite() && *value >= 0.0)) {
            return Err(errors::setting("pixels must be finite and not negative"));
        }
        let texels = values.chunks_exact(channels).map(|texel| [texel[0], texel[1], texel[2]]).collect();
        let environment = scene::Environment::new(name.0, size, texels, axis(&up)?);
        let environment = match find_sun.0 {
            true => process::detach(pixels.py(), || environment.find_sun().find_lights())?,
            false => environment,
        };
        Ok(Environment::of(environment, rotation, strength))
    }

    /// Reads an .hdr or .exr file, `path`.
    #[staticmethod]
    #[pyo3(
        signature = (path, *, up = Given(String::from("y")), rotation = Single(0.0), strength = Single(1.0)),
        text_signature = "(path, *, up='y', rotation=0.0, strength=1.0)"
    )]
    fn open(
        py: Python<'_>,
        path: Given<PathBuf>,
        up: Given<String>,
        rotation: Single,
        strength: Single,
    ) -> PyResult<Environment> {
        let up = axis(&up)?;
        let environment = process::detach(py, || scene::Environment::open(&path, up, Budget::default()))?.or_raise()?;
        Ok(Environment::of(environment, rotation, strength))
    }

    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.environment.size().into()
    }

    /// For `pickle`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        stored::reduce(py, "Environment", self)
    }

    /// It never changes: a copy is the same.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.environment.size();
        format!("<lightmesh.Environment {:?} {width}x{height}>", self.environment.name)
    }
}

impl Environment {
    fn of(environment: scene::Environment, Single(rotation): Single, Single(strength): Single) -> Environment {
        Environment { environment: environment.turned(rotation).scaled(strength).into() }
    }
}
