//! The suites. Each is a function that fills [`Findings`].

mod antialiasing;
mod film;
mod flight;
mod light;
mod quality;
mod rays;
mod shadows;
mod stages;
mod subjects;
mod thesis;
mod turns;

use std::cell::OnceCell;
use std::rc::Rc;
use std::time::Instant;

use lightmesh::{Observer, RenderError};

use crate::findings::{Keeper, Tell};
use crate::{BenchError, Findings, Machine, Picture, Plan, Program, Results, Suite, machine};

/// Runs a suite. The observer's [`note`](Observer::note) gets human-readable progress. If the observer requests a stop, the
/// results contain the rows so far, with a note.
///
/// # Errors
/// [`BenchError`], most often because a device cannot be used; it is [`RenderError::Cancelled`] if the suite was stopped before
/// its first row.
pub fn run(suite: Suite, plan: &Plan, observer: &dyn Observer) -> Result<Results, BenchError> {
    run_with(suite, plan, observer, None)
}

/// As [`run`]. Whenever there are new rows, `keep` gets the results so far, without images, as those of a suite that was stopped.
///
/// # Errors
/// As [`run`].
pub fn run_keeping(
    suite: Suite,
    plan: &Plan,
    observer: &dyn Observer,
    keep: impl Fn(&Results) + 'static,
) -> Result<Results, BenchError> {
    run_with(suite, plan, observer, Some(Box::new(keep)))
}

/// Whoever gets the results so far.
type Keep = Box<dyn Fn(&Results)>;

/// Without `keep`, results are put together at the end alone: that copies all rows.
fn run_with(suite: Suite, plan: &Plan, observer: &dyn Observer, keep: Option<Keep>) -> Result<Results, BenchError> {
    let run = Rc::new(Run::begin(suite, plan));
    let mut findings = Findings::default();
    findings.keeper = Keeper(keep.map(|keep| -> Tell {
        let run = run.clone();
        Rc::new(move |findings| keep(&run.stopped(findings)))
    }));
    let outcome = match suite {
        Suite::Antialiasing => antialiasing::run(plan, observer, &mut findings),
        Suite::Film => film::run(plan, observer, &mut findings),
        Suite::Flight => flight::run(plan, observer, &mut findings),
        Suite::Light => light::run(plan, observer, &mut findings),
        Suite::Thesis => thesis::run(plan, observer, &mut findings),
        Suite::Quality => quality::run(plan, observer, &mut findings),
        Suite::Rays => rays::run(plan, observer, &mut findings),
        Suite::Shadows => shadows::run(plan, observer, &mut findings),
        Suite::Stages => stages::run(plan, observer, &mut findings),
    };
    let pictures = std::mem::take(&mut findings.pictures);
    match outcome {
        Err(BenchError::Render(RenderError::Cancelled)) if !findings.rows.is_empty() => {
            Ok(Results { pictures, ..run.stopped(&findings) })
        }
        outcome => outcome.map(|()| run.results(&findings, pictures)),
    }
}

/// What is known of a run before its results.
struct Run {
    suite: Suite,
    quick: bool,
    program: Program,
    started: String,
    begin: Instant,
    /// Known when the devices are.
    machine: OnceCell<Machine>,
}

impl Run {
    fn begin(suite: Suite, plan: &Plan) -> Run {
        let (program, machine) = (Program::this(&plan.command), OnceCell::new());
        Run { suite, quick: plan.quick, program, started: machine::utc_now(), begin: Instant::now(), machine }
    }

    fn results(&self, findings: &Findings, pictures: Vec<Picture>) -> Results {
        Results {
            version: Results::VERSION,
            suite: self.suite.name().to_owned(),
            quick: self.quick,
            program: self.program.clone(),
            machine: self.machine.get_or_init(|| Machine::here(&findings.devices)).clone(),
            started: self.started.clone(),
            seconds: self.begin.elapsed().as_secs_f64(),
            rows: findings.rows.clone(),
            pictures,
            notes: findings.notes.clone(),
        }
    }

    /// The results if the suite ends now.
    fn stopped(&self, findings: &Findings) -> Results {
        let mut results = self.results(findings, Vec::new());
        results.notes.push("Stopped early; later rows are missing.".to_owned());
        results
    }
}
