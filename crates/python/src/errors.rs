//! Exceptions: which class stands for which error. The classes are Python's own, in `_errors.py`.

use lightmesh::render::{MeshFileError, MeshSaveError, Setting};
use lightmesh::request::{Error, RequestError, StageError};
use lightmesh::scene::{CameraError, EnvironmentError, GeometryError, LightError};
use lightmesh::{LoadError, RenderError, SaveError};
use lightmesh_files::visible;
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// The classes.
mod class {
    pyo3::import_exception!(lightmesh._errors, ArgumentError);
    pyo3::import_exception!(lightmesh._errors, Cancelled);
    pyo3::import_exception!(lightmesh._errors, DeviceError);
    pyo3::import_exception!(lightmesh._errors, DeviceMemoryError);
    pyo3::import_exception!(lightmesh._errors, GeometryError);
    pyo3::import_exception!(lightmesh._errors, HostMemoryError);
    pyo3::import_exception!(lightmesh._errors, LayersError);
    pyo3::import_exception!(lightmesh._errors, LightmeshError);
    pyo3::import_exception!(lightmesh._errors, MeshFileError);
    pyo3::import_exception!(lightmesh._errors, SaveError);
    pyo3::import_exception!(lightmesh._errors, SceneError);
    pyo3::import_exception!(lightmesh._errors, SettingError);
}

/// The exception for an error, with its message.
pub(crate) trait IntoException {
    fn into_exception(self) -> PyErr;
}

/// The result with an exception in place of an error.
pub(crate) trait OrRaise<T> {
    fn or_raise(self) -> Result<T, PyErr>;
}

impl<T, E: IntoException> OrRaise<T> for Result<T, E> {
    fn or_raise(self) -> Result<T, PyErr> {
        self.map_err(IntoException::into_exception)
    }
}

/// What names in files contain does not control a terminal that shows the message.
fn text(error: &impl std::fmt::Display) -> String {
    visible(&error.to_string()).into_owned()
}

/// A setting that cannot be used.
pub(crate) fn setting(message: impl Into<String>) -> PyErr {
    class::SettingError::new_err(message.into())
}

/// An argument of a type that cannot be used, or that is not known.
pub(crate) fn argument(message: impl Into<String>) -> PyErr {
    class::ArgumentError::new_err(message.into())
}

/// An argument of another type than is needed.
pub(crate) fn wrong_type(needed: &str, object: &Bound<'_, PyAny>) -> PyErr {
    let found = object.get_type().name().map_or_else(|_| "another type".to_owned(), |name| name.to_string());
    argument(format!("give {needed}, not {found}"))
}

/// What Python itself says of an argument, as an exception of the package.
pub(crate) fn of_argument(py: Python<'_>, error: PyErr) -> PyErr {
    if error.is_instance_of::<class::LightmeshError>(py) {
        error
    } else if error.is_instance_of::<PyTypeError>(py) {
        argument(error.value(py).to_string())
    } else if error.is_instance_of::<PyValueError>(py) || error.is_instance_of::<PyOverflowError>(py) {
        setting(error.value(py).to_string())
    } else {
        error
    }
}

/// A frame that has no layers.
pub(crate) fn no_layers() -> PyErr {
    class::LayersError::new_err("the frame has no layers: render it with layers=True")
}

/// What cannot be done on a device in this process.
pub(crate) fn device(message: impl Into<String>) -> PyErr {
    class::DeviceError::new_err(message.into())
}

/// What has no class of its own.
pub(crate) fn other(message: impl Into<String>) -> PyErr {
    class::LightmeshError::new_err(message.into())
}

/// Arrays that do not make geometry.
pub(crate) fn geometry(message: impl Into<String>) -> PyErr {
    class::GeometryError::new_err(message.into())
}

impl IntoException for RequestError {
    fn into_exception(self) -> PyErr {
        match self {
            RequestError::Unknown { name, similar } => {
                let similar = similar.map_or(String::new(), |name| format!(". Did you mean '{name}'?"));
                argument(format!("unexpected keyword argument '{name}'{similar}"))
            }
            RequestError::Save(error) => error.into_exception(),
            RequestError::Output(_) => class::SaveError::new_err(text(&self)),
            other => setting(text(&other)),
        }
    }
}

impl IntoException for StageError {
    fn into_exception(self) -> PyErr {
        setting(text(&self))
    }
}

impl IntoException for LoadError {
    fn into_exception(self) -> PyErr {
        let message = text(&self);
        match self.root() {
            LoadError::Memory { .. } | LoadError::SmoothMemory { .. } => class::HostMemoryError::new_err(message),
            _ => class::SceneError::new_err(message),
        }
    }
}

impl IntoException for EnvironmentError {
    fn into_exception(self) -> PyErr {
        class::SceneError::new_err(text(&self))
    }
}

impl IntoException for GeometryError {
    fn into_exception(self) -> PyErr {
        geometry(text(&self))
    }
}

impl IntoException for LightError {
    fn into_exception(self) -> PyErr {
        setting(text(&self))
    }
}

impl IntoException for CameraError {
    fn into_exception(self) -> PyErr {
        setting(text(&self))
    }
}

impl IntoException for RenderError {
    fn into_exception(self) -> PyErr {
        // The message, and the keyword arguments that may mend it.
        let names = self.settings().into_iter().map(keyword).collect::<Vec<_>>().join(", ");
        let message = text(&self);
        let message = if names.is_empty() { message } else { format!("{message} ({names})") };
        match self {
            RenderError::Cancelled => class::Cancelled::new_err("the render was cancelled"),
            RenderError::Device { .. } | RenderError::DeviceFault { .. } => class::DeviceError::new_err(message),
            RenderError::DeviceMemory { .. } => class::DeviceMemoryError::new_err(message),
            RenderError::Memory { .. } | RenderError::BuildMemory { .. } | RenderError::TextureMemory { .. } => {
                class::HostMemoryError::new_err(message)
            }
            RenderError::Geometry(_) | RenderError::Points { .. } | RenderError::Point { .. } => {
                class::GeometryError::new_err(message)
            }
            RenderError::Setting { .. }
            | RenderError::Structure { .. }
            | RenderError::Lattice(_)
            | RenderError::Template(_)
            | RenderError::Grid(_)
            | RenderError::GridFile(_)
            | RenderError::Threads { .. } => class::SettingError::new_err(message),
            _ => class::LightmeshError::new_err(message),
        }
    }
}

/// The keyword argument for a setting of the renderer.
fn keyword(setting: Setting) -> &'static str {
    if setting == Setting::Acceleration { "accel" } else { setting.name() }
}

impl IntoException for Error {
    fn into_exception(self) -> PyErr {
        match self {
            Error::Request(error) => error.into_exception(),
            Error::Load(error) => (*error).into_exception(),
            Error::Stage(error) => error.into_exception(),
            Error::Render(error) => error.into_exception(),
            Error::Save(error) => error.into_exception(),
            Error::Mesh(error) => error.into_exception(),
            Error::MeshSave(error) => error.into_exception(),
            Error::Cluster(_) => setting(text(&self)),
            Error::Output(_) | Error::Movie(_) | Error::Manifest(_) => class::SaveError::new_err(text(&self)),
            // The class of what happened, with what is said of the film.
            Error::Frame { number, last, finished, goes_on, cause } => {
                let error = Error::Frame { number, last, finished, goes_on, cause };
                let message = text(&error);
                let cause = error.into_cause().into_exception();
                Python::attach(|py| PyErr::from_type(cause.get_type(py), (message,)))
            }
            other => class::LightmeshError::new_err(text(&other)),
        }
    }
}

impl IntoException for SaveError {
    fn into_exception(self) -> PyErr {
        class::SaveError::new_err(text(&self))
    }
}

impl IntoException for lightmesh::image::EncodeError {
    fn into_exception(self) -> PyErr {
        class::SaveError::new_err(text(&self))
    }
}

impl IntoException for lightmesh::image::PublishError {
    fn into_exception(self) -> PyErr {
        class::SaveError::new_err(text(&self))
    }
}

impl IntoException for MeshFileError {
    fn into_exception(self) -> PyErr {
        class::MeshFileError::new_err(text(&self))
    }
}

impl IntoException for MeshSaveError {
    fn into_exception(self) -> PyErr {
        class::SaveError::new_err(text(&self))
    }
}
