//! Requests as [`Settings`] of the renderer.

use lightmesh_render::{Acceleration, Mode, Settings};
use lightmesh_scene::SceneFormat;

use crate::error::RequestError;
use crate::request::Request;
use crate::value::Background;
use crate::words::Name;

/// All settings of an image of a scene in this format, except the camera, which is part of the scene.
pub(crate) fn settings(request: &Request, format: Option<SceneFormat>) -> Result<Settings, RequestError> {
    if let Some(crop) = request.crop.filter(|crop| !crop.is_near(request.size.0)) {
        return Err(RequestError::Crop { crop, size: request.size.0 });
    }
    let mut settings = Settings::default()
        .with_mode(request.mode)
        .with_bounces(request.bounces)
        .with_size(request.size.0)
        .with_up(request.up.of(format))
        .with_lookup(request.lookup)
        .with_quality(request.quality)
        .with_ambient_light(request.ambient_light)
        .with_filter(request.filter)
        .with_short_tests(request.short_tests)
        .with_acceleration(acceleration(request)?)
        .with_seed(request.seed)
        .with_layers(request.layers)
        .with_partial(request.partial)
        .with_transparent(request.background == Some(Background::Transparent));
    // What is not given leaves its setting open.
    settings.crop = request.crop;
    settings.step = request.step;
    settings.radius = request.radius.map(|radius| radius.0);
    settings.weight = request.weight;
    settings.samples = request.samples;
    settings.aa = request.aa;
    settings.memory_limit = request.memory_limit.map(|limit| limit.0);
    Ok(settings)
}

/// What has chosen shadows without light points, if something has: a setting and its value.
pub(crate) fn without_light_points(request: &Request) -> Option<(Name, &'static str)> {
    let mut settings = Settings::default().with_mode(request.mode).with_lookup(request.lookup);
    settings.step = request.step;
    settings.radius = request.radius.map(|radius| radius.0);
    settings.weight = request.weight;
    let of_mode = request.mode != Mode::default();
    let chosen = if of_mode { ("mode", request.mode.name()) } else { ("lookup", settings.resolved_lookup().name()) };
    (!settings.has_light_points()).then_some(chosen)
}

/// Grid parameters imply the grid. Only one of them is given.
fn acceleration(request: &Request) -> Result<Acceleration, RequestError> {
    let described = match (request.grid, &request.grid_file) {
        (Some(dims), _) => Some(("grid", Acceleration::Grid(Some(dims.0)))),
        (None, Some(file)) => Some(("grid_file", Acceleration::GridFile(file.clone()))),
        (None, None) => None,
    };
    match (&request.accel, described) {
        (chosen, None) => Ok(chosen.clone()),
        (Acceleration::Auto | Acceleration::Grid(_), Some((_, described))) => Ok(described),
        (chosen, Some((setting, _))) => Err(RequestError::NoGrid { setting, chosen: chosen.name() }),
    }
}
