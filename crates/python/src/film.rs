//! Films and sun studies.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use lightmesh::request::Words;
use lightmesh::request::files::Files;
use lightmesh::request::sun::{HoursFormat, SunHours as Hours};
use lightmesh::request::table::Group;
use lightmesh::request::{Error, Frames, Order, Plan, Request, Session};
use lightmesh::{Observer, RenderError, Renderer};
use lightmesh_files::visible;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::argument::Given;
use crate::errors::{self, OrRaise};
use crate::frame::Frame;
use crate::light::LightList;
use crate::objects::take_objects;
use crate::planes::plane;
use crate::process::{self, PerProcess};
use crate::scene::Scene;
use crate::settings;
use crate::target::{self, Target};
use crate::watch::{self, Watch, Wishes};

/// What a film is of: a scene, or the file of one.
pub(crate) enum Source {
    File(PathBuf),
    Scene(Box<Scene>),
}

impl FromPyObject<'_, '_> for Source {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Source> {
        if let Ok(scene) = object.cast::<Scene>() {
            return Ok(Source::Scene(Box::new(scene.try_borrow()?.clone())));
        }
        let path = object.extract().map_err(|_| errors::wrong_type("a Scene or the path of one", &object))?;
        Ok(Source::File(path))
    }
}

/// What a film or a study is made of.
pub(crate) struct Production {
    source: Source,
    /// Camera, lights and surroundings that are given as objects.
    objects: Box<dyn Fn(&mut Scene) + Send + Sync>,
    order: Order,
    /// The threads that were asked for.
    threads: Option<usize>,
}

impl Production {
    pub(crate) fn new(
        source: Source,
        files: Files,
        lights: Option<LightList>,
        arguments: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Production> {
        let arguments = arguments.map(|arguments| arguments.copy()).transpose()?;
        let mut request = Request::default();
        let objects = take_objects(&mut request, lights, arguments.as_ref())?;
        settings::apply(&mut request, arguments.as_ref(), Group::FILM)?;
        let scene = match &source {
            Source::File(path) => path.clone(),
            Source::Scene(_) if request.resume => {
                return Err(errors::setting(
                    "resume needs the file of a scene, which can be compared with that of the frames that are there; give its path",
                ));
            }
            Source::Scene(scene) => {
                request.scene_format = scene.format;
                // There is no file that a manifest could name.
                PathBuf::from("-")
            }
        };
        let order = Order { scene, request, files };
        Ok(Production { source, objects: Box::new(objects), order, threads: None })
    }

    /// By a renderer of which so many threads were asked for.
    pub(crate) fn on_threads(self, threads: Option<usize>) -> Production {
        Production { threads, ..self }
    }

    /// Opens, stages and prepares the scene.
    fn session(self, engine: &Renderer, watch: &Watch) -> Result<Session, Error> {
        let Production { source, objects, order, threads } = self;
        watch.note_threads(threads, engine);
        let format = order.format();
        let plan = Plan::new(order)?;
        let mut scene = match source {
            Source::File(_) => Scene::of(plan.open(watch)?, format),
            Source::Scene(scene) => {
                plan.files.outputs.keep_scene(&scene.world)?;
                *scene
            }
        };
        objects(&mut scene);
        Session::begin(engine, plan, scene.world, 0.0, watch)
    }
}

/// The frames of a film: iterate over it. With an output, each frame is written before it is returned. It goes on in the process that began it only.
#[pyclass(frozen, module = "lightmesh")]
pub(crate) struct Film {
    engine: PerProcess<Arc<Renderer>>,
    /// What is left to do.
    frames: PerProcess<Mutex<Frames>>,
    wishes: Wishes,
    notes: Vec<String>,
}

impl Film {
    pub(crate) fn begin(
        py: Python<'_>,
        engine: &Arc<Renderer>,
        production: Production,
        wishes: Wishes,
    ) -> PyResult<Film> {
        let begin = |watch: &Watch| {
            if watch.cancelled() {
                return Err(Error::from(RenderError::Cancelled));
            }
            let frames = production.session(engine, watch)?.frames(engine, watch)?;
            Ok((frames, watch.notes()))
        };
        // No frame is done by that.
        let beginning = Wishes { progress: None, ..wishes.of_part(py) };
        let (frames, notes) = watch::run(py, beginning, begin)?.or_raise()?;
        let (engine, frames) = (PerProcess::new(Arc::clone(engine)), PerProcess::new(Mutex::new(frames)));
        Ok(Film { engine, frames, wishes, notes })
    }

    /// The renderer, and what is left to do.
    fn of_this_process(&self) -> PyResult<(&Renderer, &Mutex<Frames>)> {
        let both = self.engine.own().zip(self.frames.own());
        let (engine, reel) = both.ok_or_else(|| {
            errors::other("the film was begun by another process, from which this one was forked: begin it in this one")
        })?;
        Ok((engine, reel))
    }
}

fn lock(frames: &Mutex<Frames>) -> MutexGuard<'_, Frames> {
    frames.lock().unwrap_or_else(PoisonError::into_inner)
}

#[pymethods]
impl Film {
    fn __iter__(slf: Py<Film>) -> Py<Film> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Frame>> {
        let (engine, frames) = self.of_this_process()?;
        let next = |watch: &Watch| {
            let mut frames = lock(frames);
            let rendered = frames.next(engine, watch).transpose()?;
            let request = &frames.plan().order.request;
            Ok::<_, Error>(rendered.map(|rendered| Frame::of_film(rendered, request, watch.notes())))
        };
        watch::run(py, self.wishes.of_part(py), next)?.or_raise()
    }

    /// What was chosen for all frames, as sentences.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| visible(note).into_owned()).collect()
    }

    /// How many frames are left.
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        let (_, frames) = self.of_this_process()?;
        Ok(py.detach(|| lock(frames).left()))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        match self.__len__(py) {
            Ok(left) => format!("<lightmesh.Film, {left} frames left>"),
            Err(_) => "<lightmesh.Film of another process>".to_owned(),
        }
    }
}

/// The hours of direct sun on what an image shows.
#[pyclass(frozen, module = "lightmesh")]
pub(crate) struct SunHours {
    found: Hours,
    notes: Vec<String>,
}

impl SunHours {
    pub(crate) fn find(
        py: Python<'_>,
        engine: &Arc<Renderer>,
        production: Production,
        wishes: Wishes,
    ) -> PyResult<SunHours> {
        let find = |watch: &Watch| {
            let found = production.session(engine, watch)?.sun_hours(engine, watch)?;
            Ok::<_, Error>((found, watch.notes()))
        };
        let (found, notes) = watch::run(py, wishes, find)?.or_raise()?;
        Ok(SunHours { found, notes })
    }
}

#[pymethods]
impl SunHours {
    /// (H, W): hours of direct sun; 0 where there is none, and where no surface is seen: `mask` tells which.
    #[getter]
    fn hours<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let found = &slf.get().found;
        plane(slf.as_any(), found.size(), found.hours())
    }

    /// (H, W): whether a surface is seen. It is the alpha of exr files.
    #[getter]
    fn mask<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<bool>>> {
        let found = &slf.get().found;
        plane(slf.as_any(), found.size(), found.mask())
    }

    /// Hours by object, as the text of a csv file.
    #[getter]
    fn table(&self) -> String {
        self.found.table()
    }

    /// What was chosen and what counts, as sentences: how many materials let light through, and what `glass` makes of them.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| visible(note).into_owned()).collect()
    }

    /// What to know of the table, as sentences: how many objects no pixel sees, and how many rest on few points. Empty if there is nothing.
    #[getter]
    fn table_notes(&self) -> Vec<String> {
        self.found.table_notes(Words::Fields)
    }

    /// Writes an exr with the hours, a png with a legend, or a csv with a row for each object. `path` may also be a file that is open for writing
    /// bytes: then `format`, "exr", "png" or "csv", is needed. Raises `SaveError`.
    #[pyo3(signature = (path, *, format = None))]
    fn save(&self, py: Python<'_>, path: Target, format: Option<Given<String>>) -> PyResult<()> {
        let format: Option<HoursFormat> = match &format {
            Some(name) => Some(name.parse().map_err(|error| errors::setting(format!("{error}")))?),
            None => None,
        };
        match path {
            Target::Path(path) => {
                let named = HoursFormat::from_path(&path).map(HoursFormat::name);
                target::warn_if_misnamed(py, &path, format.map(HoursFormat::name), named)?;
                process::detach(py, || self.found.save_as(&path, format))?.or_raise()
            }
            Target::File(file) => {
                let format = format.ok_or_else(|| target::no_format("exr, png or csv"))?;
                target::write(py, &file, &process::detach(py, || self.found.encode(format))?.or_raise()?)
            }
        }
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.found.size();
        format!("<lightmesh.SunHours, {width}x{height}>")
    }
}
