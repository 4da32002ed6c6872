//! The comparison must be able to reject.

use super::*;
use crate::{Machine, Program};

const STEADY: [f64; 5] = [1.00, 1.01, 1.02, 1.01, 1.00];

/// Results of one row, with these samples of `render` and, in proportion, of `shade`.
fn results(samples: &[f64]) -> Results {
    let mut row = Row::new("table", [("scene", "garden".into())]);
    row.seconds.insert("render".into(), Samples(samples.to_vec()));
    row.seconds.insert("shade".into(), Samples(samples.iter().map(|seconds| 0.1 * seconds).collect()));
    Results {
        version: Results::VERSION,
        suite: "thesis".into(),
        quick: false,
        program: Program { name: "lightmesh".into(), version: "0".into(), commit: None, command: String::new() },
        machine: Machine { cpu: "one".into(), threads: 2, memory_bytes: 0, os: "linux".into(), gpus: Vec::new() },
        started: String::new(),
        seconds: 0.0,
        rows: vec![row],
        pictures: Vec::new(),
        notes: Vec::new(),
    }
}

fn times(factor: f64, samples: &[f64]) -> Vec<f64> {
    samples.iter().map(|seconds| factor * seconds).collect()
}

#[test]
fn equal_results_pass_and_doctored_ones_fail() {
    let old = results(&STEADY);
    let equal = RunComparison::new(&old, &old);
    assert_eq!((equal.regressions, equal.stages.len(), equal.same_machine), (0, 2, true));
    assert!(equal.stages.iter().all(|stage| stage.verdict == Verdict::Same));

    let slower = RunComparison::new(&old, &results(&times(1.1, &STEADY)));
    assert_eq!(slower.regressions, 1);
    let faster = RunComparison::new(&old, &results(&times(0.9, &STEADY)));
    assert_eq!(faster.regressions, 0);
    assert!(faster.stages.iter().all(|stage| stage.verdict == Verdict::Faster));
}

#[test]
fn noise_is_no_regression_but_a_larger_step_is() {
    let noisy = [1.0, 1.1, 1.2, 1.3, 1.4];
    let old = results(&noisy);
    let verdict = |factor| RunComparison::new(&old, &results(&times(factor, &noisy))).regressions;
    assert_eq!((verdict(1.2), verdict(2.0)), (0, 1));
}

#[test]
fn one_outlier_does_not_widen_the_band() {
    let disturbed = [1.0, 1.0, 1.0, 1.0, 9.0];
    assert_eq!(RunComparison::new(&results(&disturbed), &results(&times(1.1, &disturbed))).regressions, 1);
}

#[test]
fn single_samples_get_a_wide_band() {
    let verdict = |new| RunComparison::new(&results(&[1.0]), &results(&[new])).regressions;
    assert_eq!((verdict(1.3), verdict(1.6)), (0, 1));
}

#[test]
fn stages_are_judged_where_there_is_no_whole() {
    let (mut old, mut new) = (results(&STEADY), results(&times(2.0, &STEADY)));
    for results in [&mut old, &mut new] {
        results.rows[0].seconds.remove("render");
    }
    let comparison = RunComparison::new(&old, &new);
    assert_eq!((comparison.regressions, comparison.stages[0].stage.as_str()), (1, "shade"));
}

#[test]
fn what_takes_no_time_is_not_judged() {
    let tiny = times(1e-6, &STEADY);
    assert_eq!(RunComparison::new(&results(&tiny), &results(&times(3.0, &tiny))).regressions, 0);
    assert!(RunComparison::new(&results(&[0.0; 5]), &results(&STEADY)).stages.is_empty());
}

#[test]
fn rows_of_one_run_alone_are_named() {
    let (mut old, new) = (results(&STEADY), results(&STEADY));
    old.rows[0].id = "other".into();
    let comparison = RunComparison::new(&old, &new);
    assert!(comparison.stages.is_empty());
    assert_eq!((comparison.only_old, comparison.only_new), (vec!["other".into()], vec![new.rows[0].id.clone()]));
}
