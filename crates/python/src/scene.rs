//! Scenes.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use lightmesh::Scene as World;
use lightmesh::request::table::Group;
use lightmesh::request::{format_of, load_options};
use lightmesh::scene::{self, Instancing, Lights, SceneFormat, Surroundings};
use lightmesh_files::visible;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::camera::Camera;
use crate::convert::Color;
use crate::environment::Environment;
use crate::errors::{self, OrRaise};
use crate::frame;
use crate::geometry::{self, Geometry};
use crate::light::Light;
use crate::settings;

/// What built-in scenes are called on the command line.
const BUILTIN: &str = "builtin:";

/// Geometry, lights and cameras. Geometry is shared and never changes; lights, cameras and surroundings can be set at any time.
///
/// Without `lights` (`None`), images show it in a studio, as the command line does, or with `no_studio=True` by a key and a fill light; an
/// empty list is darkness. `instances`
/// says whether objects in many places are stored once ("always"), copied ("never"), or stored once if they have many triangles in all
/// ("auto"). Surfaces that emit get lights, `lamps`, as those of files have; in a frame they come after `lights`. What had to be
/// corrected is a `SceneWarning`.
#[pyclass(module = "lightmesh")]
#[derive(Clone)]
pub(crate) struct Scene {
    pub(crate) world: World,
    /// The format of its file, by which it may be known what is up.
    pub(crate) format: Option<SceneFormat>,
    /// Whether surfaces that emit have lights, and these, which stay whatever lights are set: the last ones of the world.
    makes_lamps: bool,
    lamps: Vec<scene::Light>,
}

/// Objects, one or more.
pub(crate) struct Objects(Vec<Geometry>);

impl FromPyObject<'_, '_> for Objects {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Objects> {
        if let Ok(one) = object.extract::<Geometry>() {
            return Ok(Objects(vec![one]));
        }
        let many = object.extract().map_err(|_| errors::wrong_type("a Geometry or a sequence of them", &object))?;
        Ok(Objects(many))
    }
}

impl Objects {
    fn scene(self, py: Python<'_>, name: &str, instances: &str) -> PyResult<World> {
        let instancing: Instancing = instances.parse().map_err(|error| errors::setting(format!("{error}")))?;
        py.detach(|| geometry::scene(name, &self.0, instancing)).or_raise()
    }
}

/// Puts an environment in the place of another one, each with its lights.
fn surround(lights: &mut Lights, environment: Option<&Environment>) {
    if let Some(before) = lights.environment.take() {
        let Surroundings { sun, discs, .. } = (*before).clone().into();
        lights.list.retain(|light| !sun.iter().chain(&discs).any(|own| own.kind == light.kind));
    }
    if let Some(environment) = environment {
        lights.add((*environment.environment).clone().into());
        // What was gathered of this one still holds.
        lights.environment = Some(Arc::clone(&environment.environment));
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(
        signature = (
            geometry, lights = None, camera = None, *, environment = None, ambient = None, background = None,
            instances = "auto", lamps = true, name = String::new()
        ),
        text_signature = "(geometry, lights=None, camera=None, *, environment=None, ambient=None, background=None, instances='auto', lamps=True, name='')"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        py: Python<'_>,
        geometry: Objects,
        lights: Option<Vec<Light>>,
        camera: Option<Camera>,
        environment: Option<Environment>,
        ambient: Option<Color>,
        background: Option<Color>,
        instances: &str,
        lamps: bool,
        name: String,
    ) -> PyResult<Scene> {
        let world = geometry.scene(py, &name, instances)?;
        let mut scene = Scene { makes_lamps: lamps, ..Scene::of(world, None) };
        scene.add_lamps();
        if let Some(lights) = lights {
            scene.set_lights(lights);
        }
        scene.set_camera(camera);
        scene.set_environment(environment);
        scene.set_ambient(ambient);
        scene.set_background(background);
        scene.warn(py)?;
        Ok(scene)
    }

    /// Reads a .toml, .obj, .gltf, .glb, .ply or .stl file. Raises `SceneError`.
    ///
    /// Settings:
    #[doc = include_str!("docs/open.txt")]
    #[staticmethod]
    #[pyo3(signature = (path, **settings))]
    fn open(py: Python<'_>, path: PathBuf, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Scene> {
        let request = settings::of(settings, Group::OPEN)?;
        let options = load_options(&request, request.smooth.unwrap_or_default().0, request.instances);
        let world = py.detach(|| World::open_with(&path, &options)).or_raise()?;
        let scene = Scene::of(world, format_of(&path, request.scene_format));
        scene.warn(py)?;
        Ok(scene)
    }

    /// A built-in scene: "gazebo", "childpark", "garden", also with options, as in "garden?lights=3".
    #[staticmethod]
    fn builtin(py: Python<'_>, name: &str) -> PyResult<Scene> {
        let name = name.strip_prefix(BUILTIN).unwrap_or(name);
        let world = py.detach(|| World::open(format!("{BUILTIN}{name}"))).or_raise()?;
        Ok(Scene::of(world, None))
    }

    /// All lights; set a list to change them.
    #[getter]
    fn lights(&self) -> Vec<Light> {
        let own = self.world.lights.len() - self.lamps.len();
        self.world.lights.iter().take(own).map(|light| Light::of(light, &self.world)).collect()
    }

    #[setter]
    pub(crate) fn set_lights(&mut self, lights: Vec<Light>) {
        let own = lights.iter().map(|light| light.within(&self.world)).collect();
        self.change_own(|lights| (lights.list, lights.chosen) = (own, true));
    }

    /// All cameras; set a list to change them.
    #[getter]
    fn cameras(&self) -> Vec<Camera> {
        self.world.cameras.iter().map(|camera| Camera::of(camera, &self.world)).collect()
    }

    #[setter]
    fn set_cameras(&mut self, cameras: Vec<Camera>) {
        self.world.cameras = cameras.iter().map(|camera| camera.within(&self.world)).collect();
    }

    /// The one that is used unless settings say otherwise: the first.
    #[getter]
    fn camera(&self) -> Option<Camera> {
        self.world.cameras.first().map(|camera| Camera::of(camera, &self.world))
    }

    #[setter]
    pub(crate) fn set_camera(&mut self, camera: Option<Camera>) {
        self.set_cameras(camera.into_iter().collect());
    }

    /// Constant light from everywhere; `None`: gathered from surroundings, or chosen as on the command line.
    #[getter]
    fn ambient(&self) -> Option<(f32, f32, f32)> {
        self.world.lights.ambient.map(Vec3::into)
    }

    #[setter]
    fn set_ambient(&mut self, ambient: Option<Color>) {
        self.world.lights.ambient = ambient.map(|color| color.0);
    }

    /// What is seen where nothing is; `None`: the environment, or black.
    #[getter]
    fn background(&self) -> Option<(f32, f32, f32)> {
        self.world.lights.background.map(Vec3::into)
    }

    #[setter]
    fn set_background(&mut self, background: Option<Color>) {
        self.world.lights.background = background.map(|color| color.0);
    }

    /// What surrounds the scene.
    #[getter]
    fn environment(&self) -> Option<Environment> {
        self.world.lights.environment.as_ref().map(|environment| Environment { environment: Arc::clone(environment) })
    }

    #[setter]
    pub(crate) fn set_environment(&mut self, environment: Option<Environment>) {
        self.change_own(|lights| surround(lights, environment.as_ref()));
    }

    /// As it was given; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.world.name
    }

    /// As they are stored: of what is in many places, once if `instances` is "always".
    #[getter]
    fn triangle_count(&self) -> usize {
        self.world.geometry.mesh.triangle_count()
    }

    /// Lowest and highest corner, world coordinates; `None` without triangles.
    #[getter]
    #[allow(clippy::type_complexity, reason = "two corners")]
    fn bounds(&self) -> Option<((f64, f64, f64), (f64, f64, f64))> {
        let bounds = self.world.geometry.mesh.bounds();
        let corner = |local: Vec3| -> (f64, f64, f64) { DVec3::into(self.world.to_world(local)) };
        (!bounds.is_empty()).then(|| (corner(bounds.min), corner(bounds.max)))
    }

    /// Names of the objects, in the order of `Frame.ids`.
    #[getter]
    fn objects(&self) -> Vec<&str> {
        self.world.geometry.mesh.objects.names().collect()
    }

    /// Names of the materials, in the order of `Frame.material_ids`.
    #[getter]
    fn materials(&self) -> Vec<&str> {
        self.world.geometry.materials.iter().map(|material| &*material.name).collect()
    }

    /// What the loader corrected, ignored or guessed.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.world.warnings.iter().map(|warning| visible(warning).into_owned()).collect()
    }

    /// Seconds of its animation; `None` if nothing moves.
    #[getter]
    fn duration(&self) -> Option<f64> {
        self.world.animation().map(lightmesh::scene::Animation::duration)
    }

    /// The scene at a moment of its animation, in seconds.
    fn at(&self, py: Python<'_>, time: f64) -> Scene {
        Scene { world: py.detach(|| self.world.at(time)), ..self.clone() }
    }

    /// Other geometry with the same lights, cameras and surroundings.
    #[pyo3(signature = (geometry, *, instances = "auto"))]
    fn with_geometry(&self, py: Python<'_>, geometry: Objects, instances: &str) -> PyResult<Scene> {
        let mut world = geometry.scene(py, &self.world.name, instances)?;
        // Another geometry may have another local frame.
        let (lights, cameras) = (self.lights(), self.cameras());
        world.lights = self.world.lights.clone();
        let chosen = world.lights.chosen;
        let mut scene = Scene { makes_lamps: self.makes_lamps, ..Scene::of(world, self.format) };
        scene.add_lamps();
        scene.set_lights(lights);
        scene.world.lights.chosen = chosen;
        scene.set_cameras(cameras);
        Ok(scene)
    }

    /// What `lightmesh info` says of it.
    fn info<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame::dict(py, &self.world.info())
    }

    fn __repr__(&self) -> String {
        let (triangles, lights) = (self.triangle_count(), self.world.lights.len());
        format!("<lightmesh.Scene {:?}, {triangles} triangles, {lights} lights>", self.world.name)
    }
}

impl Scene {
    /// A scene as it was read; its lights are all its own.
    pub(crate) fn of(world: World, format: Option<SceneFormat>) -> Scene {
        Scene { world, format, makes_lamps: false, lamps: Vec::new() }
    }

    /// Makes lights for surfaces that emit, as files that are opened have them.
    fn add_lamps(&mut self) {
        if !self.makes_lamps {
            return;
        }
        let own = std::mem::take(&mut self.world.lights.list);
        self.world.add_lamps();
        self.lamps = std::mem::replace(&mut self.world.lights.list, own);
        self.world.lights.list.extend(self.lamps.iter().cloned());
    }

    /// Changes the lights that are no lamps.
    fn change_own(&mut self, change: impl FnOnce(&mut Lights)) {
        let own = self.world.lights.len() - self.lamps.len();
        self.world.lights.list.truncate(own);
        change(&mut self.world.lights);
        self.world.lights.list.extend(self.lamps.iter().cloned());
    }

    /// With these lights, and nothing else.
    pub(crate) fn set_all_lights(&mut self, lights: &[Light]) {
        self.lamps.clear();
        self.world.lights.list = lights.iter().map(|light| light.within(&self.world)).collect();
    }

    /// Python's warnings of what was corrected, ignored or guessed.
    fn warn(&self, py: Python<'_>) -> PyResult<()> {
        if self.world.warnings.is_empty() {
            return Ok(());
        }
        let category = py.import("lightmesh._errors")?.getattr("SceneWarning")?;
        let warn = py.import("warnings")?.getattr("warn")?;
        for warning in self.warnings() {
            warn.call1((warning, &category, 1))?;
        }
        Ok(())
    }
}
