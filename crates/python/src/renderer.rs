//! Rendering.

use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use glam::Vec3;
use lightmesh::render::{Choice, MeshFileError};
use lightmesh::request::files::Files;
use lightmesh::{Device, Observer, RenderError, Renderer as Engine};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::cache::MeshCache;
use crate::convert;
use crate::errors::{self, IntoException, OrRaise};
use crate::film::{Film, Production, Source, SunHours};
use crate::frame::Frame;
use crate::light::Light;
use crate::prepared::{Failure, Kept, Order, PreparedScene, Subject};
use crate::scene::Scene;
use crate::watch::{self, Cancel, Watch, Wishes};

/// Renders scenes on one device: "auto", "cpu", "cuda" or "cuda:1". Can be used by several threads at once; the interpreter is free while it
/// works. Raises `DeviceError` if the device cannot be used.
#[pyclass(frozen, module = "lightmesh")]
pub(crate) struct Renderer {
    engine: Arc<Engine>,
    device: String,
    reason: String,
    /// What was rendered last, so that its structure stays alive.
    last: Mutex<Option<Kept>>,
}

#[pymethods]
impl Renderer {
    #[new]
    #[pyo3(signature = (device = "auto", *, threads = None))]
    fn new(py: Python<'_>, device: &str, threads: Option<usize>) -> PyResult<Renderer> {
        let device: Device = device.parse().map_err(|error| errors::setting(format!("{error}")))?;
        let made = || {
            let choice = Choice::of(device)?;
            let (chosen, reason) = (choice.device.to_string(), choice.reason.clone());
            Ok((Arc::new(Engine::on(choice, threads)?), chosen, reason))
        };
        let (engine, device, reason) = py.detach(made).map_err(|error: RenderError| error.into_exception())?;
        Ok(Renderer { engine, device, reason, last: Mutex::default() })
    }

    /// The device in use: "cpu" or "cuda:0".
    #[getter]
    fn device(&self) -> &str {
        &self.device
    }

    /// Which device that is, and why it was chosen.
    #[getter]
    fn reason(&self) -> &str {
        &self.reason
    }

    /// Builds the acceleration structure. `before` is the same scene at another moment: what has not moved is kept.
    ///
    /// Settings:
    #[doc = include_str!("docs/image.txt")]
    #[pyo3(signature = (scene, *, before = None, progress = None, cancel = None, **settings))]
    fn prepare(
        &self,
        py: Python<'_>,
        scene: Bound<'_, Scene>,
        before: Option<&PreparedScene>,
        progress: Option<Py<PyAny>>,
        cancel: Option<Cancel>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PreparedScene> {
        let order = Order::new(&Subject::Scene(scene), settings)?;
        let before = before.map(PreparedScene::prepared);
        let prepare = |watch: &Watch| match watch.cancelled() {
            true => Err(RenderError::Cancelled.into()),
            false => order.prepare(&self.engine, &self.last, before, watch),
        };
        let (kept, _) = watch::run(py, Wishes { progress, cancel }, prepare)?.or_raise()?;
        Ok(order.prepared(kept))
    }

    /// Renders an image. The structure of the scene rendered last is kept: other lights and cameras cost no building.
    ///
    /// Settings:
    #[doc = include_str!("docs/image.txt")]
    #[pyo3(signature = (scene, *, cache = None, progress = None, cancel = None, **settings))]
    fn render(
        &self,
        py: Python<'_>,
        scene: Subject<'_>,
        cache: Option<&MeshCache>,
        progress: Option<Py<PyAny>>,
        cancel: Option<Cancel>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Frame> {
        let mut order = Order::new(&scene, settings)?;
        order.plan = order.plan.of_picture();
        let render = |watch: &Watch| {
            let (kept, staged) = order.prepare(&self.engine, &self.last, None, watch)?;
            let mut cache = cache.map(MeshCache::lock);
            let (frame, stops) = staged.picture(
                &kept.prepared,
                order.plan.settings(),
                watch,
                |prepared, settings| match &mut cache {
                    Some(cache) => self.engine.render_with(cache, prepared, settings, watch),
                    None => self.engine.render_prepared(prepared, settings, watch),
                },
            )?;
            let refused = cache.and_then(|mut cache| cache.refused());
            Ok((Frame::new(frame, stops, watch.notes(), &kept.prepared.scene), refused))
        };
        let rendered = watch::run(py, Wishes { progress, cancel }, render)?;
        let (frame, refused): (Frame, Option<MeshFileError>) =
            rendered.map_err(|error: Failure| error.into_exception())?;
        if let Some(refused) = refused {
            let category = py.import("lightmesh._errors")?.getattr("MeshFileWarning")?;
            py.import("warnings")?.call_method1("warn", (refused.to_string(), category))?;
        }
        Ok(frame)
    }

    /// The frames of a film: by `turntable`, `sun`, `frames` or `fps`. Iterate over it to render them one by one, and `len` says how many are left.
    /// With `output`, as in "film.####.png" or "film.mp4", and `layers_file`, `stats` and `mesh_file`, each is written before it is returned; `resume` goes
    /// on with a film of which some frames are there.
    ///
    /// Settings:
    #[doc = include_str!("docs/film.txt")]
    #[pyo3(signature = (scene, output = None, *, layers_file = None, stats = None, mesh_file = None, progress = None, cancel = None, **settings))]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn film(
        &self,
        py: Python<'_>,
        scene: Source,
        output: Option<PathBuf>,
        layers_file: Option<PathBuf>,
        stats: Option<PathBuf>,
        mesh_file: Option<PathBuf>,
        progress: Option<Py<PyAny>>,
        cancel: Option<Cancel>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Film> {
        let files = Files { output, layers: layers_file, stats, mesh_file, sun_hours: Vec::new() };
        Film::begin(py, &self.engine, Production::new(scene, files, settings)?, Wishes { progress, cancel })
    }

    /// The hours of direct sun on what an image shows, on a day at a place that `sun` says.
    ///
    /// Settings:
    #[doc = include_str!("docs/film.txt")]
    #[pyo3(signature = (scene, *, progress = None, cancel = None, **settings))]
    fn sun_hours(
        &self,
        py: Python<'_>,
        scene: Source,
        progress: Option<Py<PyAny>>,
        cancel: Option<Cancel>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<SunHours> {
        SunHours::find(
            py,
            &self.engine,
            Production::new(scene, Files::default(), settings)?,
            Wishes { progress, cancel },
        )
    }

    /// The visible share of each light, (N, L), at surface points (N, 3) with these normals (N, 3), world coordinates: to bake vertex colours and
    /// lightmaps. `lights` stand in for the scene's. What lies behind a surface is dark.
    ///
    /// Settings:
    #[doc = include_str!("docs/image.txt")]
    #[pyo3(signature = (points, normals, scene, lights = None, *, progress = None, cancel = None, **settings))]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn visibility<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        normals: &Bound<'py, PyAny>,
        scene: Subject<'_>,
        lights: Option<Vec<Light>>,
        progress: Option<Py<PyAny>>,
        cancel: Option<Cancel>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut order = Order::new(&scene, settings)?;
        if let Some(lights) = lights {
            order.scene.set_all_lights(&lights);
        }
        // Those that an image gets by default are nobody's.
        order.scene.world.lights.chosen = true;
        let points = convert::points("points", points)?.double();
        let normals = convert::vectors("normals", normals)?;
        let find = |watch: &Watch| {
            let (kept, _) = order.prepare(&self.engine, &self.last, None, watch)?;
            let world = &kept.prepared.scene;
            let local: Vec<Vec3> = points.iter().map(|&point| world.to_local(point)).collect();
            let found = self.engine.visibility(&kept.prepared, &local, &normals, order.plan.settings(), watch)?;
            Ok::<_, Failure>(([found.lights(), found.points()], found.into_shares()))
        };
        let (shape, shares) = watch::run(py, Wishes { progress, cancel }, find)?.or_raise()?;
        // By light, then point, in memory.
        let array: Bound<'py, PyArray2<f32>> = convert::owned(py, shares).reshape(shape)?;
        array.getattr("T")
    }

    fn __repr__(&self) -> String {
        format!("<lightmesh.Renderer on {}>", self.device)
    }
}

/// `Renderer.visibility` on a renderer of its own.
///
/// Settings:
#[doc = include_str!("docs/image.txt")]
#[pyfunction]
#[pyo3(signature = (points, normals, scene, lights = None, *, device = "auto", **settings))]
pub(crate) fn visibility<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    scene: Subject<'_>,
    lights: Option<Vec<Light>>,
    device: &str,
    settings: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    Renderer::new(py, device, None)?.visibility(py, points, normals, scene, lights, None, None, settings)
}
