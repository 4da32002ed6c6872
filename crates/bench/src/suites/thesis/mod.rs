//! All tables and figures of the thesis.
//!
//! | experiment | rows | values besides counts |
//! |---|---|---|
//! | `timings` | scene, lights, size, mode, step, radius, device, threads | `thesis_cpu_seconds`, `thesis_gpu_seconds`; `faster_than_thesis_cpu` and `…_gpu`: speed-up over the thesis |
//! | `table 1` | size, device, threads | `collect_seconds`, `total_seconds`, `share` of the list and mesh steps; the thesis' values as `thesis_…` |
//! | `table 2` | scene, step, size, radius | `light_points`, `thesis_light_points` |
//! | `figure 1` | mode, lookup, samples | `rmse`, `mean_flip` relative to 225 samples of each light; one of each pixel, as everywhere |
//! | `figure 11` | lights, mode, device, threads | |
//! | `figure 11, break-even` | size, device, threads | `predicted_lights`, `measured_lights`, the model's `short_test_seconds` and `long_test_seconds`; `method_seconds` and `hard_seconds`, fixed, and the time per light as `…_per_light` |
//! | `figures 12-15` | radius | `rmse`, `mean_flip` relative to area shadows with 225 samples |
//!
//! The order is: tasks (`tasks`), small trials (`trial`), a schedule, the measurements (`runner`), and values derived from them
//! (`derived`, `break_even`).

mod break_even;
mod cuts;
mod derived;
mod experiments;
mod published;
mod runner;
mod task;
mod tasks;
#[cfg(test)]
mod tests;
mod trial;

use std::time::Instant;

use lightmesh::Observer;

use crate::engine::{self, Engine};
use crate::{BenchError, Findings, Plan, Suite};

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    if !plan.scenes.is_empty() || plan.size.is_some() {
        return Err(BenchError::OwnScenes(Suite::Thesis));
    }
    let begin = Instant::now();
    let engines = thesis_engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    let tasks = tasks::tasks(plan, &engines);
    observer.note("small trials, to estimate times");
    let estimates = trial::estimates(&tasks, &engines, begin, plan.budget, observer)?;
    let outcome = runner::run(plan, begin, &engines, tasks, estimates, observer, findings);
    // From whatever there is, even if the suite was stopped.
    derived::table_1(findings);
    derived::table_2(findings);
    break_even::add(findings);
    findings.notes.extend(notes(plan, &engines));
    outcome
}

/// The devices of the plan; and a single CPU thread, except in the short version.
fn thesis_engines(plan: &Plan) -> Result<Vec<Engine>, BenchError> {
    let mut engines = engine::engines(plan)?;
    let many_threads = engines.iter().any(|engine| engine.thread_count.is_some_and(|threads| threads > 1));
    if many_threads && !plan.quick {
        engines.push(Engine::cpu(Some(1))?);
    }
    Ok(engines)
}

/// Notes for readers of the results.
fn notes(plan: &Plan, engines: &[Engine]) -> Vec<String> {
    let mut notes = vec![
        "Scenes are modelled on those of the thesis: with the same counts and sizes, but not the same shapes. Weight 1, lookup \
         half-ball and one sample of a pixel, as in the thesis; rays use the BVH instead of the thesis' grid."
            .to_owned(),
        "Host memory is the peak of the whole process, scene included; if the system cannot reset it for each frame, it is the \
         peak so far."
            .to_owned(),
    ];
    if plan.quick {
        notes.push(
            "Short version: the timings omit 2048x2048 and a single thread; figure 11 has 512x512 pixels and fewer numbers of \
             lights; images are smaller."
                .to_owned(),
        );
    } else if engines.iter().all(|engine| engine.kind == "cpu") && engines.len() == 1 {
        notes.push("The CPU ran a single thread; there is no second column.".to_owned());
    }
    if engines.iter().all(|engine| engine.kind == "cpu") {
        notes.push("No GPU was used.".to_owned());
    }
    notes
}
