//! The suites. Each is a function that fills [`Findings`].

mod quality;
mod rays;
mod shadows;
mod stages;
mod subjects;
mod thesis;
mod turns;

use std::time::Instant;

use lightmesh::{Observer, RenderError};

use crate::{BenchError, Findings, Machine, Plan, Program, Results, Suite, machine};

/// Runs a suite. The observer's [`note`](Observer::note) gets human-readable progress. If the observer requests a stop, the
/// results contain the rows so far, with a note.
///
/// # Errors
/// [`BenchError`], most often because a device cannot be used; it is [`RenderError::Cancelled`] if the suite was stopped before
/// its first row.
pub fn run(suite: Suite, plan: &Plan, observer: &dyn Observer) -> Result<Results, BenchError> {
    let (started, begin) = (machine::utc_now(), Instant::now());
    let mut findings = Findings::default();
    let outcome = match suite {
        Suite::Thesis => thesis::run(plan, observer, &mut findings),
        Suite::Quality => quality::run(plan, observer, &mut findings),
        Suite::Rays => rays::run(plan, observer, &mut findings),
        Suite::Shadows => shadows::run(plan, observer, &mut findings),
        Suite::Stages => stages::run(plan, observer, &mut findings),
    };
    match outcome {
        Err(BenchError::Render(RenderError::Cancelled)) if !findings.rows.is_empty() => {
            findings.notes.push("Stopped early; later rows are missing.".to_owned());
        }
        outcome => outcome?,
    }
    Ok(Results {
        version: Results::VERSION,
        suite: suite.name().to_owned(),
        quick: plan.quick,
        program: Program::this(&plan.command),
        machine: Machine::here(&findings.devices),
        started,
        seconds: begin.elapsed().as_secs_f64(),
        rows: findings.rows,
        pictures: findings.pictures,
        notes: findings.notes,
    })
}
