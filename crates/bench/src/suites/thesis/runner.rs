//! Measures the tasks in order, as often as time allows.

use std::time::Instant;

use lightmesh::image::{self, compare};
use lightmesh::{Observer, Scene};

use super::cuts::Cuts;
use super::published;
use super::task::{Case, Task};
use crate::engine::Engine;
use crate::measure::{Measured, Rounds, Silent, Variant, measure};
use crate::schedule::{Decision, Estimate, Schedule};
use crate::{BenchError, Findings, Key, Picture, Plan, Row};

/// Runs all tasks; `begin` is the start of the time budget.
pub(super) fn run(
    plan: &Plan,
    begin: Instant,
    engines: &[Engine],
    tasks: Vec<Task>,
    estimates: Vec<Estimate>,
    observer: &dyn Observer,
    findings: &mut Findings,
) -> Result<(), BenchError> {
    let total: usize = tasks.iter().map(|task| task.cases.len()).sum();
    let mut schedule = Schedule::new(estimates);
    let (mut cuts, mut reference, mut rows) = (Cuts::default(), None, 0);
    for (index, task) in tasks.into_iter().enumerate() {
        let left = plan.budget.as_secs_f64() - begin.elapsed().as_secs_f64();
        let decision = schedule.decide(index, left);
        observer.note(&progress(&task, rows, total, left.min(schedule.remaining(index)).max(0.0), decision));
        rows += task.cases.len();
        cuts.add(&task, decision);
        if decision.variants == 0 {
            continue;
        }
        let start = Instant::now();
        let (engine, scene) = (&engines[task.engine], Scene::open(&task.scene)?);
        let prepared = engine.renderer.prepare(&scene, &task.cases[0].settings, &Silent(observer))?;
        let cases: Vec<Case> = task.cases.into_iter().take(decision.variants).collect();
        let variant =
            |case: &Case| Variant { renderer: &engine.renderer, scene: &prepared, settings: case.settings.clone() };
        let measured = measure(&cases.iter().map(variant).collect::<Vec<_>>(), decision.rounds, observer)?;
        schedule.done(index, decision, start.elapsed().as_secs_f64());
        for (case, measured) in cases.into_iter().zip(measured) {
            add(case, measured, &mut reference, findings)?;
        }
    }
    findings.notes.extend(cuts.notes());
    Ok(())
}

/// A progress message.
fn progress(task: &Task, rows: usize, total: usize, left: f64, decision: Decision) -> String {
    let last = rows + task.cases.len();
    let what = task.cases.first().map_or("", |case| &case.row.id);
    let Rounds { repetitions, .. } = decision.rounds;
    let how = if decision.variants == 0 { "dropped, no time".to_owned() } else { format!("{repetitions} times") };
    format!("rows {} to {last} of {total}, at least {left:.0} s left: {what} …, {how}", rows + 1)
}

/// Fills a row; keeps the image if it has a title. The first of those is the reference of the others.
fn add(
    case: Case,
    measured: Measured,
    reference: &mut Option<(Picture, image::Frame)>,
    findings: &mut Findings,
) -> Result<(), BenchError> {
    let mut row = case.row;
    measured.fill(&mut row);
    add_published(&mut row, measured.median());
    if let Some(title) = case.title {
        let image = measured.frame.image;
        let picture = Picture::new(&row.experiment, &title, &image)?;
        match reference {
            Some((whole, frame)) => {
                let comparison = compare(frame, &image)?;
                row.values.insert("rmse".to_owned(), comparison.rmse);
                row.values.insert("mean_flip".to_owned(), comparison.mean_flip);
                findings.pictures.push(picture.against(whole));
            }
            None => {
                *reference = Some((picture.clone(), image));
                findings.pictures.push(picture);
            }
        }
    }
    findings.add([row]);
    Ok(())
}

/// The thesis' seconds, if it has such a cell.
fn add_published(row: &mut Row, median: f64) {
    let number = |name: &str| match row.keys.get(name) {
        Some(Key::Number(number)) => Some(*number),
        _ => None,
    };
    let Some(Key::Word(scene)) = row.keys.get("scene") else { return };
    let cell = || {
        let (lights, size) = (number("lights")? as u32, number("size")? as u32);
        published::seconds(scene, lights, size, number("step")?, number("radius")?)
    };
    let Some(seconds) = cell() else { return };
    let figures = [
        ("thesis_cpu_seconds", seconds.cpu),
        ("thesis_gpu_seconds", seconds.gpu),
        ("faster_than_thesis_cpu", seconds.cpu / median),
        ("faster_than_thesis_gpu", seconds.gpu / median),
    ];
    row.values.extend(figures.map(|(name, figure)| (name.to_owned(), figure)));
}
