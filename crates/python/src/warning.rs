//! Python's warnings, by class. The classes are Python's own, in `_errors.py`.

use lightmesh_files::visible;
use pyo3::prelude::*;

/// What a warning is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum About {
    /// A file of a scene.
    Scene,
    /// A file of light points.
    MeshFile,
    /// Anything else: settings, and outputs.
    Other,
}

impl About {
    /// The name of its class.
    fn class(self) -> &'static str {
        match self {
            About::Scene => "SceneWarning",
            About::MeshFile => "MeshFileWarning",
            About::Other => "LightmeshWarning",
        }
    }
}

/// Warns whoever called the library. Fails if warnings are errors.
pub(crate) fn warn(py: Python<'_>, about: About, text: &str) -> PyResult<()> {
    let category = py.import("lightmesh._errors")?.getattr(about.class())?;
    // No frame of Python is between this and the caller.
    py.import("warnings")?.call_method1("warn", (visible(text), category, 1))?;
    Ok(())
}
