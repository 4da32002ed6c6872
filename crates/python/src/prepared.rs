//! Scenes that are prepared, and how the scene of an image becomes one.

use std::sync::{Arc, Mutex, PoisonError};

use lightmesh::render::PreparedScene as Prepared;
use lightmesh::request::table::Group;
use lightmesh::request::{ImagePlan, Request, StageError, StagedImage};
use lightmesh::scene::{Geometry, Up};
use lightmesh::{RenderError, Renderer as Engine};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::argument::Given;
use crate::camera::Camera;
use crate::errors::{self, IntoException, OrRaise};
use crate::light::LightList;
use crate::objects::take_objects;
use crate::scene::Scene;
use crate::settings;
use crate::watch::Watch;

/// A scene with its acceleration structure, ready to be rendered any number of times.
#[pyclass(frozen, module = "lightmesh")]
#[derive(Clone)]
pub(crate) struct PreparedScene {
    /// As it was given, with the camera and the surroundings of the settings.
    scene: Scene,
    /// The settings that it was prepared with, which hold for its images, too.
    request: Request,
    kept: Kept,
}

/// A structure that is alive.
#[derive(Clone)]
pub(crate) struct Kept {
    /// The geometry that the scene was given with.
    given: Arc<Geometry>,
    /// What is up, if a ground was added.
    ground: Option<Up>,
    pub(crate) prepared: Prepared,
}

/// What goes wrong on the way to a frame.
pub(crate) enum Failure {
    Stage(StageError),
    Render(RenderError),
}

impl From<StageError> for Failure {
    fn from(error: StageError) -> Failure {
        Failure::Stage(error)
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Failure {
        Failure::Render(error)
    }
}

impl IntoException for Failure {
    fn into_exception(self) -> PyErr {
        match self {
            Failure::Stage(error) => error.into_exception(),
            Failure::Render(error) => error.into_exception(),
        }
    }
}

/// What is to be rendered.
pub(crate) enum Subject<'py> {
    Prepared(Bound<'py, PreparedScene>),
    Scene(Bound<'py, Scene>),
}

impl<'py> FromPyObject<'_, 'py> for Subject<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Subject<'py>> {
        if let Ok(prepared) = object.cast::<PreparedScene>() {
            return Ok(Subject::Prepared(prepared.to_owned()));
        }
        match object.cast::<Scene>() {
            Ok(scene) => Ok(Subject::Scene(scene.to_owned())),
            Err(_) => Err(errors::wrong_type("a Scene or a PreparedScene", &object)),
        }
    }
}

/// A scene with the settings of an image of it.
pub(crate) struct Order {
    pub(crate) scene: Scene,
    request: Request,
    pub(crate) plan: ImagePlan,
    /// Its structure, if there is one.
    kept: Option<Kept>,
}

impl Order {
    /// Takes objects out of the settings, and makes flags of the rest.
    pub(crate) fn new(
        subject: &Subject<'_>,
        lights: Option<LightList>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Order> {
        let (mut scene, mut request, kept) = match subject {
            Subject::Scene(scene) => (scene.try_borrow()?.clone(), Request::default(), None),
            Subject::Prepared(prepared) => {
                let PreparedScene { scene, request, kept } = prepared.get();
                (scene.clone(), request.clone(), Some(kept.clone()))
            }
        };
        let settings = settings.map(|settings| settings.copy()).transpose()?;
        take_objects(&mut request, lights, settings.as_ref())?(&mut scene);
        settings::apply(&mut request, settings.as_ref(), Group::IMAGE)?;
        let plan = ImagePlan::new(&request, scene.format).or_raise()?;
        Ok(Order { scene, request, plan, kept })
    }

    /// The scene with a structure that was made for it.
    pub(crate) fn prepared(self, kept: Kept) -> PreparedScene {
        PreparedScene { scene: self.scene, request: self.request, kept }
    }

    /// The scene with everything that the settings say, how it is exposed, and its structure.
    pub(crate) fn prepare(
        &self,
        engine: &Engine,
        last: &Mutex<Option<Kept>>,
        before: Option<&Prepared>,
        watch: &Watch,
    ) -> Result<(Kept, StagedImage), Failure> {
        let given = &self.scene.world.geometry;
        let mut world = self.scene.world.clone();
        let staged = self.plan.stage(&mut world, watch)?;
        let ground = staged.ground();
        let last = || last.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |kept: &Kept| Arc::ptr_eq(&kept.given, given) && kept.ground == ground;
        let known = self.kept.clone().filter(is_same).or_else(|| last().clone().filter(is_same));
        if let Some(known) = &known {
            // The ground that was added now is the same.
            world.geometry = Arc::clone(&known.prepared.scene.geometry);
        }
        let settings = self.plan.settings();
        let prepared = match before {
            Some(before) => engine.prepare_moved(before, &world, settings, watch)?,
            None => engine.prepare(&world, settings, watch)?,
        };
        let kept = Kept { given: Arc::clone(given), ground, prepared };
        *last() = Some(kept.clone());
        Ok((kept, staged))
    }
}

#[pymethods]
impl PreparedScene {
    /// The scene, with the camera and surroundings of the settings.
    #[getter]
    fn scene(&self) -> Scene {
        self.scene.clone()
    }

    /// Bytes that the structure takes.
    #[getter]
    fn memory(&self) -> usize {
        self.kept.prepared.geometry.memory()
    }

    /// The same with other `lights`, one or a sequence; nothing is rebuilt.
    fn with_lights(&self, lights: LightList) -> PreparedScene {
        let mut changed = self.clone();
        changed.scene.replace_lights(&lights.0);
        changed.request.light = Vec::new();
        changed
    }

    /// The same with another `camera`; nothing is rebuilt.
    fn with_camera(&self, camera: Given<Camera>) -> PreparedScene {
        let mut changed = self.clone();
        changed.scene.set_camera(Some(camera.0));
        (changed.request.camera, changed.request.camera_name) = (None, None);
        changed
    }

    fn __repr__(&self) -> String {
        format!("<lightmesh.PreparedScene of {:?}>", self.scene.world.name)
    }
}

impl PreparedScene {
    /// The structure with its scene.
    pub(crate) fn prepared(&self) -> &Prepared {
        &self.kept.prepared
    }
}
