//! `--sun`: the frames of a day, and the hours of direct sun.

use lightmesh::Observer;
use lightmesh::render::PreparedScene;

use super::render::Studio;
use super::sun_hours;
use crate::failure::Failure;
use crate::plan::SunStudy;
use crate::value::clock;

/// Writes the hours of direct sun, if they are asked for, before the film.
pub(super) fn hours(studio: &Studio, study: &SunStudy) -> Result<(), Failure> {
    let Studio { plan, watcher, .. } = *studio;
    if let Some(note) = study.left_out() {
        watcher.note(&note);
    }
    if study.outputs.is_empty() {
        return Ok(());
    }
    let done = sun_hours::run(studio, study)?;
    if plan.film.is_some() {
        watcher.note(&done)
    } else {
        watcher.summary(&done)
    }
    Ok(())
}

/// The scene under the sky of frame `number`, and when that is, for messages.
pub(super) fn frame(studio: &Studio, number: u32) -> Result<(PreparedScene, String), Failure> {
    let Studio { prepared, plan, .. } = *studio;
    let Some(study) = &plan.sun else { return Ok((prepared.clone(), String::new())) };
    let index = number as usize - 1;
    let lights = plan.choices.under(&study.sky_at(index), &prepared.scene.lights)?;
    Ok((prepared.with_lights(lights), format!(", {}", clock(study.moments[index].minute))))
}
