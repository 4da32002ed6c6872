//! Camera, lights and surroundings that are given as objects among settings.

use lightmesh::request::Request;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::camera::Camera;
use crate::environment::Environment;
use crate::errors;
use crate::light::{Light, LightList};
use crate::scene::Scene;

/// Takes camera, lights and surroundings that are objects out of settings. What is returned gives them to a scene.
pub(crate) fn take_objects(
    request: &mut Request,
    lights: Option<LightList>,
    settings: Option<&Bound<'_, PyDict>>,
) -> PyResult<impl Fn(&mut Scene) + Send + Sync + use<>> {
    let (mut camera, mut environment, mut list) = (None, None, lights.map(|LightList(lights)| lights));
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
        list = taken_lights(settings, list)?;
    }
    if list.is_some() {
        request.light = Vec::new();
    }
    Ok(move |scene: &mut Scene| {
        if let Some(camera) = &camera {
            scene.set_camera(Some(camera.clone()));
        }
        if let Some(list) = &list {
            scene.replace_lights(list);
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

/// The lights that were given as `lights`, or as `light` among settings, which may also be texts as on the command line.
fn taken_lights(settings: &Bound<'_, PyDict>, lights: Option<Vec<Light>>) -> PyResult<Option<Vec<Light>>> {
    let given = settings.get_item("light")?.filter(|value| !value.is_none());
    let Some(value) = given else { return beside_studio(settings, lights) };
    if lights.is_some() {
        return Err(errors::setting("light and lights cannot be given together: they are the same, give one of them"));
    }
    let is_text = |value: &Bound<'_, PyAny>| value.is_instance_of::<PyString>();
    let is_typed = is_text(&value)
        || value.try_iter().is_ok_and(|mut items| items.all(|item| item.is_ok_and(|item| is_text(&item))));
    if is_typed {
        return Ok(None);
    }
    let LightList(lights) = value.extract().map_err(|_: PyErr| {
        errors::wrong_type("a Light, a text such as '3,8,2;0.9;0.25', or a sequence of one of them as light", &value)
    })?;
    settings.del_item("light")?;
    beside_studio(settings, Some(lights))
}

/// A studio is not beside other light, as on the command line.
fn beside_studio(settings: &Bound<'_, PyDict>, lights: Option<Vec<Light>>) -> PyResult<Option<Vec<Light>>> {
    let is_studio = settings.get_item("studio")?.is_some_and(|studio| studio.extract().unwrap_or(false));
    if is_studio && lights.is_some() {
        return Err(errors::setting("studio cannot be given with lights: a studio is not beside other light"));
    }
    Ok(lights)
}
