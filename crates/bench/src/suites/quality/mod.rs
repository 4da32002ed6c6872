//! Errors relative to converged area shadows, and the cost of equal error.
//!
//! | experiment | rows | values besides counts |
//! |---|---|---|
//! | `reference` | scene | `samples`; `visibility_rmse`, `mean_flip`: its own remaining error |
//! | `errors` | scene, mode, lookup, step, radius, weight, emitter, samples | `visibility_rmse`, `rmse`, `mean_flip` |
//! | `equal error` | a light mesh and a measure | `error`, `seconds`, `rays`, `short_tests`; `area_…`: the cost of shadow rays |
//! | `equal time` | scene | `samples` that take as long as the light mesh, and both errors |
//!
//! The competitor is area mode: n stratified shadow rays per pixel and light, on the same ray tracer. Occluder lists and adaptive shadow
//! rays, which have the key `lookup`, are compared with it like light meshes; their `rays` count all samples that are
//! tested. Its cost at an error is interpolated between the measured n, linearly in the logarithms ([`curve`]). Lights
//! are balls with the spread that area mode gives point lights; the emitter `point` is the thesis' light mesh, which
//! uses their centres. Each scene gets an equal share of the time.

mod cases;
mod curve;
mod errors;
mod rival;
mod study;
#[cfg(test)]
mod tests;

use std::time::{Duration, Instant};

use lightmesh::{Mode, Observer, Settings, Step};

use self::cases::Case;
pub(super) use self::errors::visibility_rmse;
use self::errors::{Errors, Reference};
use self::study::{Outcome, Study};
use super::subjects::{self, Subject};
use super::turns::Turns;
use crate::engine::{self, Engine};
use crate::measure::{Silent, Variant};
use crate::{BenchError, Findings, Plan};

/// Pixels along a side, and in the short version.
const SIDES: [u32; 2] = [512, 256];

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = engine::engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    subjects::each(plan, observer, |subject, share| study(plan, subject, &engines, share, observer, findings))
}

/// Measures one scene within a share of the time. The first device, which is the fastest, renders the reference and the images.
fn study(
    plan: &Plan,
    subject: &Subject,
    engines: &[Engine],
    share: Duration,
    observer: &dyn Observer,
    findings: &mut Findings,
) -> Result<(), BenchError> {
    let (begin, side) = (Instant::now(), plan.side_or(SIDES));
    let (scene, settings, silent) = (subject.with_balls(), Settings::default().with_aa(1), Silent(observer));
    let balls = engines[0].renderer.prepare(&scene, &settings, &silent)?;
    let points = engines[0].renderer.prepare(&subject.scene, &settings, &silent)?;
    let reference = Reference::converge(plan, &engines[0], &balls, side, share, observer)?;
    findings.notes.extend(reference.note(&subject.name));
    let study = Study { plan, subject, balls, points, side, reference, observer };
    findings.add([study.reference_row()]);
    let step = study.step(&engines[0])?;
    for (index, engine) in engines.iter().enumerate() {
        let left = share.saturating_sub(begin.elapsed()) / (engines.len() - index) as u32;
        let outcomes = study.measure(engine, step, left, findings)?;
        findings.add(outcomes.iter().map(|outcome| {
            study.row("errors", engine, outcome.case.keys.clone(), |row| {
                outcome.errors.fill(row);
                outcome.measured.fill(row);
            })
        }));
        rival::compare(&study, engine, &outcomes, index == 0, findings)?;
    }
    Ok(())
}

impl Study<'_> {
    /// The step h to vary: the scene's own, or the automatic one for images of this size.
    fn step(&self, engine: &Engine) -> Result<f32, BenchError> {
        if let Some(step) = self.subject.step {
            return Ok(step);
        }
        let settings = Settings::default().with_aa(1).with_size([self.side; 2]).with_step(Step::Auto);
        let frame = engine.renderer.render_prepared(&self.points, &settings, &Silent(self.observer))?;
        Ok(frame.stats.settings.step.unwrap_or(1.0))
    }

    /// Errors first, for as many cases as fit into half of the time; then those are timed.
    fn measure(
        &self,
        engine: &Engine,
        step: f32,
        share: Duration,
        findings: &mut Findings,
    ) -> Result<Vec<Outcome>, BenchError> {
        let begin = Instant::now();
        let cases = cases::cases(step, self.side, self.subject.step.is_some());
        let wanted = cases.len();
        let mut found = Vec::with_capacity(wanted);
        for case in cases {
            // Everything else is compared with the cost of shadow rays.
            if case.settings.mode == Mode::LightMesh && begin.elapsed() >= share / 2 {
                break;
            }
            found.push((self.errors(engine, &case)?, case));
        }
        let variants: Vec<Variant> = found.iter().map(|(_, case)| self.variant(engine, case, &case.settings)).collect();
        let left = share.saturating_sub(begin.elapsed());
        let mut turns = Turns::take(&variants, self.plan.repetitions, left, self.observer)?;
        turns.left_out += wanted - found.len();
        let what = format!("{} on {}", self.subject.name, engine.kind);
        findings.notes.extend(turns.notes(&what, self.plan.repetitions));
        let outcomes = found.into_iter().zip(turns.measured);
        Ok(outcomes.map(|((errors, case), measured)| Outcome { case, errors, measured }).collect())
    }

    /// Renders a case with layers, which timed renders do not have.
    fn errors(&self, engine: &Engine, case: &Case) -> Result<Errors, BenchError> {
        let layered = case.settings.clone().with_layers(true);
        let frame = engine.renderer.render_prepared(self.scene(case.emitter), &layered, &Silent(self.observer))?;
        Ok(Errors::between(&self.reference.frame, &frame.image)?)
    }
}
