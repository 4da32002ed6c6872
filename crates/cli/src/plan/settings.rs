//! Conversion of flags to [`Settings`].

use lightmesh::scene::SceneFormat;
use lightmesh::{Acceleration, Settings};

use super::PlanError;
use crate::args::ImageArgs;
use crate::value::Background;

/// All settings of an image of a scene in this format, except the camera, which is part of the scene.
pub(crate) fn settings(
    args: &ImageArgs,
    format: Option<SceneFormat>,
    memory_limit: Option<u64>,
) -> Result<Settings, PlanError> {
    if let Some(crop) = args.crop.filter(|crop| !crop.is_within(args.size.0)) {
        return Err(PlanError::Crop { crop, size: args.size.0 });
    }
    let mut settings = Settings::default()
        .with_mode(args.mode)
        .with_bounces(args.bounces)
        .with_size(args.size.0)
        .with_up(args.up.of(format))
        .with_lookup(args.lookup)
        .with_quality(args.quality)
        .with_ambient_light(args.ambient_light)
        .with_filter(args.filter)
        .with_short_tests(args.short_tests)
        .with_acceleration(acceleration(args)?)
        .with_seed(args.seed)
        .with_partial(args.partial)
        .with_transparent(args.background == Some(Background::Transparent));
    // Omitted flags leave their settings open.
    settings.crop = args.crop;
    settings.step = args.step;
    settings.radius = args.radius.map(|radius| radius.0);
    settings.weight = args.weight;
    settings.samples = args.samples;
    settings.aa = args.aa;
    settings.memory_limit = memory_limit;
    Ok(settings)
}

/// Grid parameters imply the grid. The parser has rejected `--grid` together with `--grid-file`.
fn acceleration(args: &ImageArgs) -> Result<Acceleration, PlanError> {
    let described = match (args.grid, &args.grid_file) {
        (Some(dims), _) => Some(("--grid", Acceleration::Grid(Some(dims.0)))),
        (None, Some(file)) => Some(("--grid-file", Acceleration::GridFile(file.clone()))),
        (None, None) => None,
    };
    match (&args.accel, described) {
        (chosen, None) => Ok(chosen.clone()),
        (Acceleration::Auto | Acceleration::Grid(_), Some((_, described))) => Ok(described),
        (chosen, Some((flag, _))) => Err(PlanError::NoGrid { flag, chosen: chosen.name() }),
    }
}
