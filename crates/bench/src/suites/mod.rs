//! The suites. Each is a function that fills [`Findings`].

mod quality;
mod rays;
mod subjects;
mod thesis;
mod turns;

use std::time::Instant;

use lightmesh::Observer;

use crate::{BenchError, Findings, Machine, Plan, Program, Results, Suite, machine};

/// Runs a suite. The observer's [`note`](Observer::note) gets a line for each row; what it is told is for people.
///
/// # Errors
/// [`BenchError`], most often because a device cannot be used; [`RenderError::Cancelled`](lightmesh::RenderError::Cancelled) in it
/// where the observer asked to stop.
pub fn run(suite: Suite, plan: &Plan, observer: &dyn Observer) -> Result<Results, BenchError> {
    let (started, begin) = (machine::utc_now(), Instant::now());
    let mut findings = Findings::default();
    match suite {
        Suite::Thesis => thesis::run(plan, observer, &mut findings),
        Suite::Quality => quality::run(plan, observer, &mut findings),
        Suite::Rays => rays::run(plan, observer, &mut findings),
    }?;
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
