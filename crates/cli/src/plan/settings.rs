//! Flags to [`Settings`].

use lightmesh::{Acceleration, Settings};

use super::PlanError;
use crate::args::{Accel, RenderArgs};

/// All settings but the camera, which needs the scene.
pub(super) fn settings(args: &RenderArgs) -> Result<Settings, PlanError> {
    Ok(Settings {
        mode: args.mode.into(),
        bounces: args.bounces,
        size: args.size.0,
        camera: None,
        up: args.up.of(&args.scene.scene),
        step: args.step.map(|step| step.0),
        radius: args.radius.map(|radius| radius.0),
        weight: args.weight.map(Into::into),
        lookup: args.lookup.into(),
        short_tests: args.short_tests.into(),
        samples: args.samples,
        acceleration: acceleration(args)?,
        seed: args.seed,
        layers: args.layers.is_some(),
        memory_limit: args.memory_limit.map(|limit| limit.0),
    })
}

/// A description of a grid implies one. The parser has refused `--grid` together with `--grid-file`.
fn acceleration(args: &RenderArgs) -> Result<Acceleration, PlanError> {
    let described = match (args.grid, &args.grid_file) {
        (Some(dims), _) => Some(("--grid", Acceleration::Grid(Some(dims.0)))),
        (None, Some(file)) => Some(("--grid-file", Acceleration::GridFile(file.clone()))),
        (None, None) => None,
    };
    match (args.accel, described) {
        (Accel::Auto, None) => Ok(Acceleration::Auto),
        (Accel::Grid, None) => Ok(Acceleration::Grid(None)),
        (Accel::Bvh, None) => Ok(Acceleration::Bvh),
        (Accel::Auto | Accel::Grid, Some((_, acceleration))) => Ok(acceleration),
        (Accel::Bvh, Some((flag, _))) => Err(PlanError::NoGrid { flag }),
    }
}
