//! The Python package `lightmesh`, see `python/lightmesh/_lightmesh.pyi` for what each class promises.
//!
//! Classes wrap the types of the Rust library; settings of a request are keyword arguments ([`settings`]). Arrays of frames are views of the frame's
//! own memory. Whatever takes time runs on another thread while the interpreter is free ([`watch`]).

mod argument;
mod cache;
mod camera;
mod cluster;
mod convert;
mod devices;
mod environment;
mod errors;
mod film;
mod frame;
mod geometry;
mod light;
mod material;
mod mattes;
mod objects;
mod planes;
mod prepared;
mod process;
mod renderer;
mod restored;
mod scene;
mod settings;
mod stored;
mod target;
mod texture;
mod warning;
mod watch;

use pyo3::prelude::*;

/// Soft shadows by the light mesh.
#[pymodule]
mod _lightmesh {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::cache::MeshCache;
    #[pymodule_export]
    use crate::camera::Camera;
    #[pymodule_export]
    use crate::devices::{command, devices};
    #[pymodule_export]
    use crate::environment::Environment;
    #[pymodule_export]
    use crate::film::{Film, SunHours};
    #[pymodule_export]
    use crate::frame::Frame;
    #[pymodule_export]
    use crate::geometry::Geometry;
    #[pymodule_export]
    use crate::light::Light;
    #[pymodule_export]
    use crate::material::Material;
    #[pymodule_export]
    use crate::mattes::Mattes;
    #[pymodule_export]
    use crate::prepared::PreparedScene;
    #[pymodule_export]
    use crate::renderer::{Renderer, visibility};
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::texture::Texture;
    #[pymodule_export]
    use crate::watch::{Cancel, Progress};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::process::begin();
        // For `lightmesh.ray` and for pickles alone: they are not exported.
        let py = module.py();
        module.setattr("_FilmLog", py.get_type::<crate::cluster::_FilmLog>())?;
        module.setattr("_BandedPicture", py.get_type::<crate::cluster::_BandedPicture>())?;
        module.setattr("_Worker", py.get_type::<crate::cluster::_Worker>())?;
        module.setattr("_digest", wrap_pyfunction!(crate::cluster::_digest, module)?)?;
        module.setattr("_seal", wrap_pyfunction!(crate::cluster::_seal, module)?)?;
        module.setattr("_sweep", wrap_pyfunction!(crate::cluster::_sweep, module)?)?;
        module.setattr("_parse", wrap_pyfunction!(crate::cluster::_parse, module)?)?;
        module.setattr("_restore", wrap_pyfunction!(crate::restored::_restore, module)?)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
