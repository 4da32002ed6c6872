//! Scenes.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use lightmesh::Scene as World;
use lightmesh::request::table::Group;
use lightmesh::request::{format_of, load_options};
use lightmesh::scene::{self, Instancing, Lights, SceneFormat, Surroundings};
use lightmesh_files::visible;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::{Deserialize, Serialize};

use crate::argument::{Double, Given};
use crate::camera::Camera;
use crate::convert::Color;
use crate::environment::Environment;
use crate::errors::{self, OrRaise};
use crate::frame;
use crate::geometry::{self, Geometry};
use crate::light::{Light, LightList};
use crate::planes::{column, table};
use crate::process;
use crate::settings;
use crate::stored::{self, Reduced};
use crate::warning::{self, About};

/// What built-in scenes are called on the command line.
const BUILTIN: &str = "builtin:";

/// Geometry, lights and cameras. Geometry is shared and never changes; lights, cameras and surroundings can be set at any time.
///
/// Without `lights` (`None`), images show it in a studio, as the command line does, or with `no_studio=True` by a key and a fill light; an
/// empty list is darkness. `instances`
/// says whether objects in many places are stored once ("always"), copied ("never"), or stored once if they have many triangles in all
/// ("auto"). Surfaces that emit get lights, `lamps`, as those of files have; in a frame they come after `lights`. What had to be
/// corrected is a `SceneWarning`.
///
/// `geometry` is one object or a sequence of them, `camera` the view of it, `environment` what surrounds it, `ambient` constant light from everywhere,
/// `background` what is seen where nothing is, and `name` is for display.
#[pyclass(module = "lightmesh")]
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Scene {
    pub(crate) world: World,
    /// The format of its file, by which it may be known what is up.
    #[serde(with = "by_name")]
    pub(crate) format: Option<SceneFormat>,
    /// Whether surfaces that emit have lights, and these, which stay whatever lights are set: the last ones of the world.
    makes_lamps: bool,
    lamps: Vec<scene::Light>,
}

/// How names of objects and materials change.
const OTHER_GEOMETRY: &str = "geometry never changes: with_geometry makes another scene, and list() a list of your own";

/// Geometry that arrays are views of.
#[pyclass(frozen, module = "lightmesh._lightmesh")]
struct Held(Arc<scene::Geometry>);

impl Held {
    fn of<'py>(scene: &Scene, py: Python<'py>) -> PyResult<Bound<'py, Held>> {
        Bound::new(py, Held(Arc::clone(&scene.world.geometry)))
    }
}

/// Ranges of triangles that an array is a view of.
#[pyclass(frozen, module = "lightmesh._lightmesh")]
struct Ranges(Vec<[u32; 3]>);

/// The object, the first triangle, and the end of each run of triangles.
fn ranges(mesh: &scene::Mesh) -> Vec<[u32; 3]> {
    let rows = mesh.objects.ranges(mesh.triangles.len() as u32);
    rows.map(|(run, object)| [object, run.start, run.end]).collect()
}

/// A list that refuses changes, which would be lost.
fn fixed<'py>(py: Python<'py>, items: impl IntoPyObject<'py>, remedy: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("lightmesh._lists")?.getattr("FixedList")?.call_method1("of", (items, remedy))
}

/// The format of a file as its name.
mod by_name {
    use lightmesh::scene::SceneFormat;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(format: &Option<SceneFormat>, serializer: S) -> Result<S::Ok, S::Error> {
        format.map(SceneFormat::name).serialize(serializer)
    }

    pub(super) fn deserialize<'a, D: Deserializer<'a>>(deserializer: D) -> Result<Option<SceneFormat>, D::Error> {
        let name = Option::<String>::deserialize(deserializer)?;
        name.map(|name| name.parse().map_err(D::Error::custom)).transpose()
    }
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
        process::detach(py, || geometry::scene(name, &self.0, instancing))?.or_raise()
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
            instances = Given(String::from("auto")), lamps = Given(true), name = Given(String::new())
        ),
        text_signature = "(geometry, lights=None, camera=None, *, environment=None, ambient=None, background=None, instances='auto', lamps=True, name='')"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        py: Python<'_>,
        geometry: Objects,
        lights: Option<LightList>,
        camera: Option<Given<Camera>>,
        environment: Option<Given<Environment>>,
        ambient: Option<Color>,
        background: Option<Color>,
        instances: Given<String>,
        lamps: Given<bool>,
        name: Given<String>,
    ) -> PyResult<Scene> {
        let world = geometry.scene(py, &name, &instances)?;
        let mut scene = Scene { makes_lamps: lamps.0, ..Scene::of(world, None) };
        scene.add_lamps();
        if let Some(LightList(lights)) = lights {
            scene.replace_lights(&lights);
        }
        scene.set_camera(camera.map(|Given(camera)| camera));
        scene.set_environment(environment.map(|Given(environment)| environment));
        scene.set_ambient(ambient);
        scene.set_background(background);
        scene.warn(py)?;
        Ok(scene)
    }

    /// Reads `path`, a .toml, .obj, .gltf, .glb, .ply or .stl file. Raises `SceneError`, or `HostMemoryError` if it needs more memory than there is.
    ///
    /// Settings:
    #[doc = include_str!("docs/open.txt")]
    #[staticmethod]
    #[pyo3(signature = (path, **settings))]
    fn open(py: Python<'_>, path: Given<PathBuf>, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Scene> {
        let request = settings::of(settings, Group::OPEN)?;
        let options = load_options(&request, request.smooth.unwrap_or_default().0, request.instances);
        let world = process::detach(py, || World::open_with(&*path, &options))?.or_raise()?;
        let scene = Scene::of(world, format_of(&path, request.scene_format));
        scene.warn(py)?;
        Ok(scene)
    }

    /// A built-in scene by `name`: "gazebo", "childpark", "garden", also with options, as in "garden?lights=3".
    #[staticmethod]
    fn builtin(py: Python<'_>, name: Given<String>) -> PyResult<Scene> {
        let name = name.strip_prefix(BUILTIN).unwrap_or(&name);
        let world = process::detach(py, || World::open(format!("{BUILTIN}{name}")))?.or_raise()?;
        Ok(Scene::of(world, None))
    }

    /// All lights; set a list, or one, to change them. The list is a copy, and cannot be changed itself.
    #[getter]
    fn lights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        fixed(py, self.own_lights(), "set lights, as in scene.lights = [*scene.lights, light]")
    }

    #[setter]
    fn set_lights(&mut self, lights: LightList) {
        self.replace_lights(&lights.0);
    }

    /// All cameras; set a list to change them. The list is a copy, and cannot be changed itself.
    #[getter]
    fn cameras<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        fixed(py, self.own_cameras(), "set cameras, as in scene.cameras = [*scene.cameras, camera]")
    }

    #[setter]
    fn set_cameras(&mut self, cameras: Given<Vec<Camera>>) {
        self.replace_cameras(&cameras);
    }

    /// The one that is used unless settings say otherwise: the first.
    #[getter]
    fn camera(&self) -> Option<Camera> {
        self.world.cameras.first().map(|camera| Camera::of(camera, &self.world))
    }

    #[setter(camera)]
    fn give_camera(&mut self, camera: Option<Given<Camera>>) {
        self.set_camera(camera.map(|Given(camera)| camera));
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

    #[setter(environment)]
    fn give_environment(&mut self, environment: Option<Given<Environment>>) {
        self.set_environment(environment.map(|Given(environment)| environment));
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

    /// The place of vertices with the coordinates 0, 0, 0; world coordinates.
    #[getter]
    fn origin(&self) -> (f64, f64, f64) {
        self.world.geometry.origin.into()
    }

    /// (V, 3): the vertices, relative to `origin`. Like all arrays of a scene it is a view that cannot be written, and lives as long as it is
    /// used. Of objects that are stored once for many places, see `instances`, vertices are in coordinates of their own.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let held = Held::of(self, py)?;
        table(held.as_any(), bytemuck::cast_slice::<_, [f32; 3]>(&held.get().0.mesh.positions))
    }

    /// (T, 3): the vertices of each triangle, counterclockwise seen from the front.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let held = Held::of(self, py)?;
        table(held.as_any(), &held.get().0.mesh.triangles)
    }

    /// (V, 3): the shading normals of vertices, of unit length, or 0 where triangles are flat; `None` if all are.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        let held = Held::of(self, py)?;
        let normals = &held.get().0.mesh.normals;
        (!normals.is_empty()).then(|| table(held.as_any(), bytemuck::cast_slice::<_, [f32; 3]>(normals))).transpose()
    }

    /// (V, 2): texture coordinates, origin in the upper left corner of the image; `None` if there are none.
    #[getter]
    fn uvs<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        let held = Held::of(self, py)?;
        let uvs = &held.get().0.mesh.uvs;
        (!uvs.is_empty()).then(|| table(held.as_any(), bytemuck::cast_slice::<_, [f32; 2]>(uvs))).transpose()
    }

    /// (V, 3): linear colours that tint the materials; `None` if there are none.
    #[getter]
    fn colors<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        let held = Held::of(self, py)?;
        let colors = &held.get().0.mesh.colors;
        (!colors.is_empty()).then(|| table(held.as_any(), bytemuck::cast_slice::<_, [f32; 3]>(colors))).transpose()
    }

    /// (T,): the material of each triangle, an index of `materials`.
    #[getter]
    fn material_indices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        let held = Held::of(self, py)?;
        column(held.as_any(), &held.get().0.mesh.materials)
    }

    /// (R, 3): which triangles belong to which object. A row is an index of `objects`, the first triangle, and the one after the last. An object
    /// can have several rows.
    #[getter]
    fn object_ranges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let mesh = &self.world.geometry.mesh;
        let held = Bound::new(py, Ranges(ranges(mesh)))?;
        table(held.as_any(), &held.get().0)
    }

    /// Names of the objects, in the order of `Frame.ids`; `object_ranges` has their triangles.
    #[getter]
    fn objects<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        fixed(py, self.world.geometry.mesh.objects.names().collect::<Vec<_>>(), OTHER_GEOMETRY)
    }

    /// Names of the materials, in the order of `Frame.material_ids`.
    #[getter]
    fn materials<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let names = self.world.geometry.materials.iter().map(|material| &*material.name);
        fixed(py, names.collect::<Vec<_>>(), OTHER_GEOMETRY)
    }

    /// What the loader corrected, ignored or guessed.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        fixed(py, self.warning_texts(), "copy it by list()")
    }

    /// Seconds of its animation; `None` if nothing moves.
    #[getter]
    fn duration(&self) -> Option<f64> {
        self.world.animation().map(lightmesh::scene::Animation::duration)
    }

    /// The scene at a moment of its animation: `time` is in seconds.
    fn at(&self, py: Python<'_>, time: Double) -> PyResult<Scene> {
        Ok(Scene { world: process::detach(py, || self.world.at(time.0))?, ..self.clone() })
    }

    /// Other `geometry` with the same lights, cameras and surroundings; `instances` as in the constructor.
    #[pyo3(
        signature = (geometry, *, instances = Given(String::from("auto"))),
        text_signature = "($self, geometry, *, instances='auto')"
    )]
    fn with_geometry(&self, py: Python<'_>, geometry: Objects, instances: Given<String>) -> PyResult<Scene> {
        let mut world = geometry.scene(py, &self.world.name, &instances)?;
        // Another geometry may have another local frame.
        let (lights, cameras) = (self.own_lights(), self.own_cameras());
        world.lights = self.world.lights.clone();
        let chosen = world.lights.chosen;
        let mut scene = Scene { makes_lamps: self.makes_lamps, ..Scene::of(world, self.format) };
        scene.add_lamps();
        scene.replace_lights(&lights);
        scene.world.lights.chosen = chosen;
        scene.replace_cameras(&cameras);
        Ok(scene)
    }

    /// What `lightmesh info` says of it.
    fn info<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame::dict(py, &process::detach(py, || self.world.info())?)
    }

    /// For `pickle`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        if self.world.animation().is_some() {
            return Err(errors::other(
                "a scene that moves cannot be pickled: give its file to the other process, which opens it, or make a scene of its arrays",
            ));
        }
        stored::reduce(py, "Scene", self)
    }

    /// Another scene with the same geometry, which never changes.
    fn __copy__(&self) -> Scene {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Scene {
        self.clone()
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

    fn own_lights(&self) -> Vec<Light> {
        let own = self.world.lights.len() - self.lamps.len();
        self.world.lights.iter().take(own).map(|light| Light::of(light, &self.world)).collect()
    }

    /// With these lights, and lamps.
    pub(crate) fn replace_lights(&mut self, lights: &[Light]) {
        let own = lights.iter().map(|light| light.within(&self.world)).collect();
        self.change_own(|lights| (lights.list, lights.chosen) = (own, true));
    }

    fn own_cameras(&self) -> Vec<Camera> {
        self.world.cameras.iter().map(|camera| Camera::of(camera, &self.world)).collect()
    }

    fn replace_cameras(&mut self, cameras: &[Camera]) {
        self.world.cameras = cameras.iter().map(|camera| camera.within(&self.world)).collect();
    }

    pub(crate) fn set_camera(&mut self, camera: Option<Camera>) {
        self.replace_cameras(camera.as_slice());
    }

    pub(crate) fn set_environment(&mut self, environment: Option<Environment>) {
        self.change_own(|lights| surround(lights, environment.as_ref()));
    }

    fn warning_texts(&self) -> Vec<String> {
        self.world.warnings.iter().map(|warning| visible(warning).into_owned()).collect()
    }

    /// With these lights, and nothing else.
    pub(crate) fn set_all_lights(&mut self, lights: &[Light]) {
        self.lamps.clear();
        self.world.lights.list = lights.iter().map(|light| light.within(&self.world)).collect();
    }

    /// Python's warnings of what was corrected, ignored or guessed.
    fn warn(&self, py: Python<'_>) -> PyResult<()> {
        self.world.warnings.iter().try_for_each(|text| warning::warn(py, About::Scene, text))
    }
}
