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

use crate::argument::Given;
use crate::cache::MeshCache;
use crate::convert;
use crate::errors::{self, IntoException, OrRaise};
use crate::film::{Film, Production, Source, SunHours};
use crate::frame::Frame;
use crate::light::LightList;
use crate::prepared::{Failure, Kept, Order, PreparedScene, Subject};
use crate::process::{self, PerProcess};
use crate::scene::Scene;
use crate::warning::{self, About};
use crate::watch::{self, Callback, Cancel, Watch, Wishes};

/// What to say of the visibility of nothing.
const NO_LIGHTS: &str = "the scene has no lights, so there is no visibility of any: the array has no columns; give lights, or a sky with a sun \
                         (lights, sky)";

/// Renders scenes on a `device`: "auto", "cpu", "cuda" or "cuda:1", or on several: "cuda:all", "cuda:0,1" or "cuda:all,cpu", with so many `threads` of
/// the CPU, or as many as `OMP_NUM_THREADS` says, or all. Can be used by several threads at once; the interpreter is free while it works. A process that is
/// forked uses it with threads of its own, if the device is the CPU. Raises `DeviceError` if the device cannot be used.
#[pyclass(frozen, module = "lightmesh")]
pub(crate) struct Renderer {
    machine: PerProcess<Machine>,
    device: String,
    reason: String,
    threads: Option<usize>,
}

/// What renders.
struct Machine {
    engine: Arc<Engine>,
    /// What was rendered last, so that its structure stays alive.
    last: Mutex<Option<Kept>>,
}

impl Machine {
    fn new(choice: Choice, threads: Option<usize>) -> Result<Machine, RenderError> {
        Ok(Machine { engine: Arc::new(Engine::on(choice, threads)?), last: Mutex::default() })
    }
}

impl Renderer {
    /// What renders in this process.
    fn machine(&self) -> PyResult<&Machine> {
        self.machine.get_or_make(|| {
            if self.device != Device::Cpu.to_string() {
                return Err(errors::device(format!(
                    "{} cannot be used by a process that was forked from one which uses it: start processes by spawn, or make \
                     renderers on GPUs only after the fork",
                    self.device
                )));
            }
            Choice::of(Device::Cpu)
                .and_then(|choice| Machine::new(choice, self.threads.or(process::threads())))
                .map_err(IntoException::into_exception)
        })
    }
}

#[pymethods]
impl Renderer {
    #[new]
    #[pyo3(
        signature = (device = Given(String::from("auto")), *, threads = None),
        text_signature = "(device='auto', *, threads=None)"
    )]
    fn new(py: Python<'_>, device: Given<String>, threads: Option<Given<usize>>) -> PyResult<Renderer> {
        let threads = threads.map(|Given(threads)| threads);
        let device: Device = device.parse().map_err(|error| errors::setting(format!("{error}")))?;
        let made = || {
            let choice = Choice::of(device)?;
            let (chosen, reason) = (choice.device.to_string(), choice.reason.clone());
            Ok((PerProcess::new(Machine::new(choice, threads.or(process::threads()))?), chosen, reason))
        };
        let made = process::detach(py, made)?;
        let (machine, device, reason) = made.map_err(|error: RenderError| error.into_exception())?;
        Ok(Renderer { machine, device, reason, threads })
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

    /// The threads of the CPU that were started: of more than 16, at most four for each logical CPU.
    #[getter]
    fn threads(&self) -> PyResult<usize> {
        Ok(self.machine()?.engine.threads())
    }

    /// Builds the acceleration structure of `scene`. `before` is the same scene at another moment: what has not moved is kept. `lights`, one or a
    /// sequence, stand in for the scene's. `progress` is called now and then, and `cancel` stops it.
    ///
    /// Settings:
    #[doc = include_str!("docs/image.txt")]
    #[pyo3(signature = (scene, *, before = None, lights = None, progress = None, cancel = None, **settings))]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn prepare(
        &self,
        py: Python<'_>,
        scene: Given<Bound<'_, Scene>>,
        before: Option<Given<Bound<'_, PreparedScene>>>,
        lights: Option<LightList>,
        progress: Option<Callback>,
        cancel: Option<Given<Cancel>>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PreparedScene> {
        let machine = self.machine()?;
        let order = Order::new(&Subject::Scene(scene.0), lights, settings)?;
        let before = before.as_ref().map(|before| before.get().prepared());
        let prepare = |watch: &Watch| match watch.cancelled() {
            true => Err(RenderError::Cancelled.into()),
            false => order.prepare(&machine.engine, &machine.last, before, watch),
        };
        let (kept, _) = watch::run(py, Wishes::new(progress, cancel), prepare)?.or_raise()?;
        Ok(order.prepared(kept))
    }

    /// Renders an image of `scene`. The structure of the scene rendered last is kept: other lights and cameras cost no building. `lights`, one or a
    /// sequence, stand in for the scene's. `cache` keeps what light points see. `progress` is called now and then, and `cancel` stops it.
    ///
    /// Settings:
    #[doc = include_str!("docs/image.txt")]
    #[pyo3(signature = (scene, *, cache = None, lights = None, progress = None, cancel = None, **settings))]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn render(
        &self,
        py: Python<'_>,
        scene: Subject<'_>,
        cache: Option<Given<Bound<'_, MeshCache>>>,
        lights: Option<LightList>,
        progress: Option<Callback>,
        cancel: Option<Given<Cancel>>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Frame> {
        let machine = self.machine()?;
        let cache = cache.as_ref().map(|cache| cache.get());
        let mut order = Order::new(&scene, lights, settings)?;
        order.plan = order.plan.of_picture();
        let render = |watch: &Watch| {
            watch.note_threads(self.threads, &machine.engine);
            let (kept, staged) = order.prepare(&machine.engine, &machine.last, None, watch)?;
            let mut cache = cache.map(MeshCache::lock);
            let (frame, stops) =
                staged.picture(&kept.prepared, order.plan.settings(), watch, |prepared, settings, host| {
                    match &mut cache {
                        Some(cache) => machine.engine.render_with(cache, prepared, settings, host),
                        None => machine.engine.render_prepared(prepared, settings, host),
                    }
                })?;
            let refused = cache.and_then(|mut cache| cache.refused());
            Ok((Frame::new(frame, stops, watch.notes(), &kept.prepared.scene), refused))
        };
        let rendered = watch::run(py, Wishes::new(progress, cancel), render)?;
        let (frame, refused): (Frame, Option<MeshFileError>) =
            rendered.map_err(|error: Failure| error.into_exception())?;
        if let Some(refused) = refused {
            warning::warn(py, About::MeshFile, &refused.to_string())?;
        }
        Ok(frame)
    }

    /// The frames of a film of `scene`: by `turntable`, `sun`, `frames` or `fps`. Iterate over it to render them one by one, or as many at the same
    /// time as there are GPUs; `len` says how many are left. With `output`, as in "film.####.png" or "film.mp4", and `layers_file`, `stats` and
    /// `mesh_file`, each is written before it is returned; `resume` goes on with a film of which some frames are there. `lights`, one or a sequence,
    /// stand in for the scene's. `progress` is called now and then with the share of the whole film, and `cancel` stops it.
    ///
    /// Settings:
    #[doc = include_str!("docs/film.txt")]
    #[pyo3(signature = (scene, output = None, *, layers_file = None, stats = None, mesh_file = None, lights = None, progress = None, cancel = None, **settings))]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn film(
        &self,
        py: Python<'_>,
        scene: Source,
        output: Option<Given<PathBuf>>,
        layers_file: Option<Given<PathBuf>>,
        stats: Option<Given<PathBuf>>,
        mesh_file: Option<Given<PathBuf>>,
        lights: Option<LightList>,
        progress: Option<Callback>,
        cancel: Option<Given<Cancel>>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Film> {
        let [output, layers, stats, mesh_file] =
            [output, layers_file, stats, mesh_file].map(|path| path.map(|Given(path)| path));
        let files = Files { output, layers, stats, mesh_file, sun_hours: Vec::new() };
        let production = Production::new(scene, files, lights, settings)?.on_threads(self.threads);
        Film::begin(py, &self.machine()?.engine, production, Wishes::new(progress, cancel))
    }

    /// The hours of direct sun on what an image of `scene` shows, on a day at a place that `sun` says. `progress` is called now and then, and `cancel`
    /// stops it.
    ///
    /// Settings:
    #[doc = include_str!("docs/film.txt")]
    #[pyo3(signature = (scene, *, progress = None, cancel = None, **settings))]
    fn sun_hours(
        &self,
        py: Python<'_>,
        scene: Source,
        progress: Option<Callback>,
        cancel: Option<Given<Cancel>>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<SunHours> {
        SunHours::find(
            py,
            &self.machine()?.engine,
            Production::new(scene, Files::default(), None, settings)?.on_threads(self.threads),
            Wishes::new(progress, cancel),
        )
    }

    /// The visible share of each light, (N, L), at surface `points` (N, 3) of `scene` with these `normals`, (N, 3) or one for all, world coordinates: to
    /// bake vertex colours and lightmaps. `lights`, one or a sequence, stand in for the scene's, of which a scene may have none: L is 0 then, with a
    /// `LightmeshWarning`, for no studio is added. What lies behind a surface is dark. `progress` is called now and then, and `cancel` stops it.
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
        lights: Option<LightList>,
        progress: Option<Callback>,
        cancel: Option<Given<Cancel>>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let machine = self.machine()?;
        let mut order = Order::new(&scene, None, settings)?;
        let are_given = lights.is_some();
        if let Some(LightList(lights)) = lights {
            order.scene.set_all_lights(&lights);
        }
        // Those that an image gets by default are nobody's.
        order.scene.world.lights.chosen = true;
        let points = convert::points("points", points)?.double();
        let normals = convert::one_or_each("normals", normals, points.len())?;
        let find = |watch: &Watch| {
            let (kept, _) = order.prepare(&machine.engine, &machine.last, None, watch)?;
            let world = &kept.prepared.scene;
            let local: Vec<Vec3> = points.iter().map(|&point| world.to_local(point)).collect();
            let found = machine.engine.visibility(&kept.prepared, &local, &normals, order.plan.settings(), watch)?;
            Ok::<_, Failure>(([found.lights(), found.points()], found.into_shares()))
        };
        let (shape, shares) = watch::run(py, Wishes::new(progress, cancel), find)?.or_raise()?;
        if shape[0] == 0 && !are_given {
            warning::warn(py, About::Other, NO_LIGHTS)?;
        }
        // By light, then point, in memory.
        let array: Bound<'py, PyArray2<f32>> = convert::owned(py, shares).reshape(shape)?;
        array.getattr("T")
    }

    fn __repr__(&self) -> String {
        format!("<lightmesh.Renderer on {}>", self.device)
    }
}

/// `Renderer.visibility` of `points` with `normals` in `scene`, lit by `lights`, on a renderer of its own on `device`.
///
/// Settings:
#[doc = include_str!("docs/image.txt")]
#[pyfunction]
#[pyo3(
    signature = (points, normals, scene, lights = None, *, device = Given(String::from("auto")), **settings),
    text_signature = "(points, normals, scene, lights=None, *, device='auto', **settings)"
)]
pub(crate) fn visibility<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    scene: Subject<'_>,
    lights: Option<LightList>,
    device: Given<String>,
    settings: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    Renderer::new(py, device, None)?.visibility(py, points, normals, scene, lights, None, None, settings)
}
