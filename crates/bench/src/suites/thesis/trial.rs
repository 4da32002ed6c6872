//! Time estimates: each image is rendered once at a small size, and times are scaled by the number of pixels.
//!
//! This overestimates the method, whose cells are shared by fewer pixels of a small image; the schedule corrects that. A single
//! thread would take too long to measure: it is assumed to be slower than all threads by their number.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use lightmesh::{Observer, Scene, Settings};

use super::task::Task;
use crate::BenchError;
use crate::engine::Engine;
use crate::measure::Silent;
use crate::schedule::Estimate;

/// The sides of a trial are reduced by this factor,
const SHORTER: u32 = 4;
/// have no more pixels than this,
const LONGEST: u32 = 256;
/// and no fewer than this.
const SHORTEST: u32 = 8;

/// Seconds per pixel, by scene, device and settings.
type Costs = BTreeMap<(String, usize, String), f64>;

/// An estimate for each task. Tasks without a trial by `budget` after `begin` are estimated as infinite: there is no time for
/// them anyway.
pub(super) fn estimates(
    tasks: &[Task],
    engines: &[Engine],
    begin: Instant,
    budget: Duration,
    observer: &dyn Observer,
) -> Result<Vec<Estimate>, BenchError> {
    let mut costs = Costs::new();
    let mut estimates = Vec::with_capacity(tasks.len());
    for task in tasks {
        let (engine, factor) = asked(task.engine, engines);
        if begin.elapsed() < budget {
            measure(task, engine, engines, &mut costs, observer)?;
        }
        let seconds = task.cases.iter().map(|case| {
            let [width, height] = case.settings.size.map(f64::from);
            let cost = costs.get(&key(task, engine, &small(&case.settings)));
            factor * width * height * cost.copied().unwrap_or(f64::INFINITY)
        });
        let class = format!("{} {}", task.engine, task.side());
        estimates.push(Estimate { class, seconds: seconds.collect(), repetitions: task.repetitions });
    }
    Ok(estimates)
}

/// The device that is measured instead of this one, and how much faster it is.
fn asked(engine: usize, engines: &[Engine]) -> (usize, f64) {
    let many = engines.iter().position(|other| other.thread_count.is_some_and(|threads| threads > 1));
    match (engines[engine].thread_count, many) {
        (Some(1), Some(many)) => (many, engines[many].thread_count.unwrap_or(1) as f64),
        _ => (engine, 1.0),
    }
}

/// Adds estimates that are still missing.
fn measure(
    task: &Task,
    engine: usize,
    engines: &[Engine],
    costs: &mut Costs,
    observer: &dyn Observer,
) -> Result<(), BenchError> {
    let unknown: Vec<Settings> = task.cases.iter().map(|case| small(&case.settings)).collect();
    let unknown: Vec<Settings> =
        unknown.into_iter().filter(|settings| !costs.contains_key(&key(task, engine, settings))).collect();
    let Some(first) = unknown.first() else { return Ok(()) };
    let (scene, renderer) = (Scene::open(&task.scene)?, &engines[engine].renderer);
    let silent = Silent(observer);
    let prepared = renderer.prepare(&scene, first, &silent)?;
    // The first image warms up caches and, on a GPU, uploads the scene.
    renderer.render_prepared(&prepared, first, &silent)?;
    for settings in unknown {
        let start = Instant::now();
        renderer.render_prepared(&prepared, &settings, &silent)?;
        let [width, height] = settings.size.map(f64::from);
        costs.insert(key(task, engine, &settings), start.elapsed().as_secs_f64() / (width * height));
    }
    Ok(())
}

fn small(settings: &Settings) -> Settings {
    let size = settings.size.map(|side| (side / SHORTER).clamp(SHORTEST, LONGEST));
    settings.clone().with_size(size)
}

fn key(task: &Task, engine: usize, settings: &Settings) -> (String, usize, String) {
    (task.scene.clone(), engine, format!("{settings:?}"))
}
