//! Sun studies: the frames of a day, and the hours of direct sun.

mod hours;
mod study;

use lightmesh_render::PreparedScene;

pub use hours::SunHours;
pub use study::{HoursFile, HoursFormat, SunMoment, SunStudy};

use crate::context::Context;
use crate::error::Error;
use crate::plan::Plan;
use crate::value::clock;

/// Writes the hours of direct sun, if they are asked for; returns what was done.
pub(crate) fn write_hours(
    study: &SunStudy,
    prepared: &PreparedScene,
    context: Context,
) -> Result<Option<String>, Error> {
    if let Some(note) = study.left_out(context.plan.film.is_some(), context.host.words()) {
        context.host.note(&note);
    }
    if study.outputs.is_empty() {
        return Ok(None);
    }
    hours::write(study, prepared, context).map(Some)
}

/// The scene under the sky of frame `number`, and when that is, for messages.
pub(crate) fn frame(plan: &Plan, prepared: &PreparedScene, number: u32) -> Result<(PreparedScene, String), Error> {
    let Some(study) = &plan.sun else { return Ok((prepared.clone(), String::new())) };
    let index = number as usize - 1;
    let lights = plan.staging.under(&study.sky_at(index), &prepared.scene.lights)?;
    Ok((prepared.with_lights(lights), clock(study.moments[index].minute)))
}
