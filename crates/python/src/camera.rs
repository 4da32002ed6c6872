//! Cameras.

use glam::{DVec3, Vec3};
use lightmesh::Scene;
use lightmesh::scene::{self, Fov, Projection};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::argument::{Given, Single};
use crate::convert::Vector;
use crate::errors::{self, OrRaise};
use crate::stored::{self, Reduced};

/// The vertical field of view of cameras of which nothing is said, degrees.
const USUAL_VFOV: f32 = 45.0;

/// A camera at `position` that looks at `target`, or along `direction`. `vfov` or `hfov` is the full vertical or horizontal field of view,
/// degrees (45° vertical if none is given); `height` in their place makes it orthographic: the image is as high in scene units. `shift` moves
/// the image, to the right and up, by shares of its height, as a shifted lens does: parallels stay parallel. `up` is what is up in the image, and
/// `name` what `camera_name` calls it. Surfaces and lights are seen from the depth `near` up to the depth `far`, distances along the view
/// direction in scene units; shadows, mirrors and the sky stay.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Camera {
    /// At the origin of its scene.
    camera: scene::Camera,
    /// In the world.
    position: DVec3,
}

impl Camera {
    /// A camera of a scene.
    pub(crate) fn of(camera: &scene::Camera, scene: &Scene) -> Camera {
        Camera { camera: camera.clone().with_position(Vec3::ZERO), position: scene.to_world(camera.position) }
    }

    /// As a camera of a scene.
    pub(crate) fn within(&self, scene: &Scene) -> scene::Camera {
        self.camera.clone().with_position(scene.to_local(self.position))
    }
}

#[pymethods]
impl Camera {
    #[new]
    #[pyo3(
        signature = (
            position, target = None, *, direction = None, up = None, vfov = None, hfov = None, height = None,
            shift = Given((Single(0.0), Single(0.0))), name = Given(String::new()), near = Single(0.0), far = None
        ),
        text_signature = "(position, target=None, *, direction=None, up=(0.0, 1.0, 0.0), vfov=None, hfov=None, height=None, shift=(0.0, 0.0), \
            name='', near=0.0, far=None)"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        position: Vector,
        target: Option<Vector>,
        direction: Option<Vector>,
        up: Option<Vector>,
        vfov: Option<Single>,
        hfov: Option<Single>,
        height: Option<Single>,
        shift: Given<(Single, Single)>,
        name: Given<String>,
        near: Single,
        far: Option<Single>,
    ) -> PyResult<Camera> {
        let position = position.0;
        let [vfov, hfov, height] = [vfov, hfov, height].map(|number| number.map(|Single(number)| number));
        let Given((Single(right), Single(above))) = shift;
        let direction = match (target, direction) {
            (Some(target), None) => target.0 - position,
            (None, Some(direction)) => direction.0,
            _ => return Err(errors::setting("give a target or a direction")),
        };
        let projection = match (vfov, hfov, height) {
            (None, None, None) => Projection::Perspective(Fov::Vertical(USUAL_VFOV)),
            (Some(vfov), None, None) => Projection::Perspective(Fov::Vertical(vfov)),
            (None, Some(hfov), None) => Projection::Perspective(Fov::Horizontal(hfov)),
            (None, None, Some(height)) if height > 0.0 => Projection::Orthographic { height },
            (None, None, Some(height)) => {
                return Err(errors::setting(format!("height is a number above 0, not {height}")));
            }
            _ => return Err(errors::setting("give one of vfov, hfov and height")),
        };
        // Checks the angle, whichever it is.
        let angle = vfov.or(hfov).unwrap_or(USUAL_VFOV);
        let up = up.map_or(DVec3::Y, |up| up.0);
        let camera = scene::Camera::look_to(Vec3::ZERO, direction, up, angle).or_raise()?;
        let camera = camera.with_projection(projection).with_shift([right, above]).named(name.0);
        let (Single(near), far) = (near, far.map_or(f32::INFINITY, |Single(far)| far));
        let camera = camera.with_clip(near, far).or_raise()?;
        Ok(Camera { camera, position })
    }

    /// As it was given; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.camera.name
    }

    /// World coordinates.
    #[getter]
    fn position(&self) -> (f64, f64, f64) {
        self.position.into()
    }

    /// Of unit length.
    #[getter]
    fn direction(&self) -> (f32, f32, f32) {
        self.camera.direction.into()
    }

    /// What is up in the image.
    #[getter]
    fn up(&self) -> (f32, f32, f32) {
        self.camera.up.into()
    }

    /// For `pickle`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        stored::reduce(py, "Camera", self)
    }

    /// It never changes: a copy is the same.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        format!("<lightmesh.Camera {:?} at {}, towards {}>", self.camera.name, self.position, self.camera.direction)
    }
}
