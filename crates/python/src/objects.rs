//! Camera and surroundings that are given as objects among settings.

use lightmesh::request::Request;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::camera::Camera;
use crate::environment::Environment;
use crate::scene::Scene;

/// Takes camera and surroundings that are objects out of settings. What is returned gives them to a scene.
pub(crate) fn take_objects(
    request: &mut Request,
    settings: Option<&Bound<'_, PyDict>>,
) -> PyResult<impl Fn(&mut Scene) + Send + Sync + use<>> {
    let (mut camera, mut environment) = (None, None);
    if let Some(settings) = settings {
        camera = taken::<Camera>(settings, "camera")?;
        environment = taken::<Environment>(settings, "environment")?;
        if camera.is_some() {
            settings.set_item("camera_name", settings.py().None())?;
            (request.camera, request.camera_name) = (None, None);
        }
        if environment.is_some() {
            request.environment = None;
        }
    }
    Ok(move |scene: &mut Scene| {
        if let Some(camera) = &camera {
            scene.set_camera(Some(camera.clone()));
        }
        if let Some(environment) = &environment {
            scene.set_environment(Some(environment.clone()));
        }
    })
}

/// An object of this class among settings, which it is taken out of.
fn taken<T: for<'a, 'py> FromPyObject<'a, 'py>>(settings: &Bound<'_, PyDict>, name: &str) -> PyResult<Option<T>> {
    let Some(value) = settings.get_item(name)? else { return Ok(None) };
    let Ok(object) = value.extract::<T>() else { return Ok(None) };
    settings.del_item(name)?;
    Ok(Some(object))
}
