//! The whole suite, on tiny images.

use std::collections::BTreeSet;
use std::sync::{Mutex, OnceLock};
use std::time::Duration;

use lightmesh::{Device, Observer};

use crate::{BenchError, Key, Plan, Results, Row, Suite};

/// 1024 pixels become 8.
const SHRINK: u32 = 128;

#[derive(Default)]
struct Listener {
    notes: Mutex<Vec<String>>,
    /// The number of notes after which the suite is stopped.
    patience: Option<usize>,
}

impl Observer for Listener {
    fn note(&self, text: &str) {
        self.notes.lock().unwrap().push(text.to_owned());
    }

    fn cancelled(&self) -> bool {
        self.patience.is_some_and(|patience| self.notes.lock().unwrap().len() > patience)
    }
}

fn tiny(quick: bool) -> Plan {
    Plan { device: Device::Cpu, threads: Some(2), repetitions: 1, shrink: SHRINK, ..Plan::new(quick) }
}

fn run(plan: &Plan) -> (Results, Vec<String>) {
    let listener = Listener::default();
    let results = crate::run(Suite::Thesis, plan, &listener).unwrap();
    (results, listener.notes.into_inner().unwrap())
}

/// The whole suite, run once for all tests.
fn whole() -> &'static (Results, Vec<String>) {
    static WHOLE: OnceLock<(Results, Vec<String>)> = OnceLock::new();
    WHOLE.get_or_init(|| run(&tiny(false)))
}

fn of<'r>(results: &'r Results, experiment: &'r str) -> Vec<&'r Row> {
    results.rows.iter().filter(|row| row.experiment == experiment).collect()
}

fn word<'r>(row: &'r Row, key: &str) -> &'r str {
    match row.keys.get(key) {
        Some(Key::Word(word)) => word,
        _ => "",
    }
}

fn keys(row: &Row) -> String {
    row.keys.keys().map(String::as_str).collect::<Vec<_>>().join(" ")
}

#[test]
fn every_experiment_is_there_once() {
    let (results, notes) = whole();
    let ids: BTreeSet<&str> = results.rows.iter().map(|row| row.id.as_str()).collect();
    assert_eq!(ids.len(), results.rows.len());
    let counts = ["timings", "table 1", "table 2", "figure 1", "figure 11", "figure 11, break-even", "figures 12-15"]
        .map(|experiment| of(results, experiment).len());
    // Timings: 24 cells and 8 of Garden with more lights with the method, and 8 with hard shadows, for two numbers of threads.
    assert_eq!(counts, [2 * 40, 4, 16, 5, 14, 1, 5]);
    assert_eq!(counts.iter().sum::<usize>(), results.rows.len());
    assert!(notes.iter().any(|note| note.starts_with("rows 1 to 1 of 104, at least ")), "{notes:?}");
    assert!(results.notes.iter().all(|note| !note.contains("time budget")), "{:?}", results.notes);
    assert_eq!((results.suite.as_str(), results.version), ("thesis", Results::VERSION));
}

#[test]
fn the_cells_of_the_thesis_are_complete() {
    let (results, _) = whole();
    let timings = of(results, "timings");
    let one_thread: Vec<&&Row> = timings.iter().filter(|row| row.keys["threads"] == 1.0.into()).collect();
    let method = one_thread.iter().filter(|row| word(row, "mode") == "light-mesh");
    let cells: Vec<&&&Row> =
        method.filter(|row| word(row, "scene") != "garden" || row.keys["lights"] == 1.0.into()).collect();
    assert_eq!(cells.len(), 24);
    for row in cells {
        assert_eq!(keys(row), "device lights mode radius scene size step threads", "{}", row.id);
        for value in ["light_points", "half_ball_mean", "used_mean", "hits", "pixels"] {
            assert!(row.values[value] > 0.0, "{value} of {}", row.id);
        }
        for stage in ["primary_rays", "short_tests", "collect", "long_tests", "shade", "render"] {
            assert!(row.seconds[stage].min().unwrap() > 0.0, "{stage} of {}", row.id);
        }
    }
    let hard = one_thread.iter().filter(|row| word(row, "mode") == "ray-trace");
    assert!(hard.clone().all(|row| keys(row) == "device lights mode scene size threads"));
    assert_eq!(hard.count(), 8);
}

#[test]
fn pictures_refer_to_the_reference() {
    let (results, _) = whole();
    let reference = "figure 1: area shadows, 225 per light";
    let others = results.pictures.iter().filter(|picture| picture.reference.as_deref() == Some(reference));
    assert_eq!((results.pictures.len(), others.count()), (10, 9));
    assert_eq!((results.pictures[0].id.as_str(), &results.pictures[0].reference), (reference, &None));
    assert!(results.pictures.iter().all(|picture| picture.png.starts_with(b"\x89PNG")));
    let radii = of(results, "figures 12-15");
    assert!(radii.iter().all(|row| row.values["mean_flip"] > 0.0 && row.values["rmse"] > 0.0));
    // Each image has one sample of a pixel. With as many samples of a light, lists then have the reference's bits.
    let figure = of(results, "figure 1");
    assert!(figure.iter().all(|row| row.values["rays"] == row.values["pixels"]), "{figure:?}");
    let lists = figure.iter().find(|row| word(row, "lookup") == "lists").unwrap();
    assert_eq!([lists.values["mean_flip"], lists.values["rmse"]], [0.0; 2]);
}

#[test]
fn without_time_rows_are_left_out_and_named() {
    let (results, _) = run(&Plan { budget: Duration::from_nanos(1), ..tiny(true) });
    assert!(results.rows.is_empty() && results.pictures.is_empty());
    assert!(results.quick && results.notes.iter().any(|note| note.starts_with("Short version: ")));
    let note = results.notes.iter().find(|note| note.starts_with("Dropped because of the time budget, ")).unwrap();
    assert!(note.contains("timings: ") && note.contains("figure 11: "), "{note}");
}

#[test]
fn scenes_that_would_not_be_measured_are_refused() {
    let plan = Plan { scenes: vec!["builtin:gazebo".into()], ..tiny(true) };
    let refused = crate::run(Suite::Thesis, &plan, &Listener::default());
    assert!(matches!(refused, Err(BenchError::OwnScenes(Suite::Thesis))), "{refused:?}");
}

#[test]
fn a_suite_can_be_stopped() {
    let stopped_after = |patience| {
        let listener = Listener { patience: Some(patience), ..Listener::default() };
        crate::run(Suite::Thesis, &tiny(true), &listener)
    };
    let at_once = stopped_after(0);
    assert!(matches!(at_once, Err(BenchError::Render(lightmesh::RenderError::Cancelled))), "{at_once:?}");
    // Notes cover the trials and two tasks: the third task is not started.
    let later = stopped_after(3).unwrap();
    assert_eq!((of(&later, "figure 1").len(), of(&later, "figures 12-15").len()), (5, 0));
    assert!(later.notes.iter().any(|note| note.starts_with("Stopped early")), "{:?}", later.notes);
}
