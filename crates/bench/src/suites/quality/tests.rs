use std::collections::BTreeSet;
use std::path::PathBuf;

use lightmesh::Device;
use lightmesh::render::Unobserved;

use super::*;
use crate::{Key, Row};

fn found(plan: Plan) -> Findings {
    let mut findings = Findings::default();
    let plan = Plan { device: Device::Cpu, shrink: 16, repetitions: 1, ..plan };
    run(&plan, &Unobserved, &mut findings).unwrap();
    findings
}

fn value(findings: &Findings, experiment: &str, keys: &[(&str, Key)], name: &str) -> f64 {
    let matches =
        |row: &&Row| row.experiment == experiment && keys.iter().all(|(key, value)| row.keys.get(*key) == Some(value));
    let rows: Vec<&Row> = findings.rows.iter().filter(matches).collect();
    assert_eq!(rows.len(), 1, "{experiment}: {keys:?}");
    rows[0].values[name]
}

#[test]
fn every_experiment_has_rows_of_their_own() {
    let findings = found(Plan { scenes: vec![PathBuf::from("builtin:gazebo")], ..Plan::new(true) });
    let ids: BTreeSet<&str> = findings.rows.iter().map(|row| row.id.as_str()).collect();
    assert_eq!(ids.len(), findings.rows.len(), "ids repeat");
    let count = |experiment: &str| findings.rows.iter().filter(|row| row.experiment == experiment).count();
    // Hard shadows, four numbers of shadow rays; 14 light meshes, three numbers of samples with occluder lists and two with adaptive rays,
    // each with two measures.
    assert_eq!(["reference", "errors", "equal error", "equal time"].map(count), [1, 24, 38, 1]);
    assert_eq!(findings.pictures.len(), 3);
    assert!(findings.pictures[1..].iter().all(|picture| picture.reference.as_ref() == Some(&findings.pictures[0].id)));
}

#[test]
fn more_shadow_rays_come_nearer_to_the_reference_which_has_converged() {
    let findings = found(Plan { scenes: vec![PathBuf::from("builtin:childpark")], ..Plan::new(true) });
    let area = |samples: u32| {
        let keys = [("mode", "area".into()), ("samples", f64::from(samples).into())];
        value(&findings, "errors", &keys, "visibility_rmse")
    };
    let errors = cases::AREA_SAMPLES.map(area);
    assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
    // Lists test the same samples, and so do adaptive rays but for what is thinner than a pixel, here a large one.
    for (lookup, samples, most) in [("lists", 16, 1.01), ("lists", 64, 1.01), ("adaptive", 16, 2.5)] {
        let keys = [("lookup", lookup.into()), ("samples", f64::from(samples).into())];
        let found = value(&findings, "errors", &keys, "visibility_rmse");
        let rays = area(samples);
        assert!((0.99 * rays..most * rays).contains(&found), "{lookup}, {samples}: {found}, {rays}");
    }
    let residue = value(&findings, "reference", &[], "visibility_rmse");
    assert!(0.0 < residue && residue < errors[3], "{residue} {errors:?}");
}

#[test]
fn without_time_the_rival_is_measured_and_what_is_missing_is_said() {
    let scenes = vec![PathBuf::from("builtin:gazebo")];
    let findings = found(Plan { budget: Duration::ZERO, scenes, ..Plan::new(true) });
    assert!(findings.rows.iter().any(|row| row.experiment == "errors"));
    assert!(findings.rows.iter().all(|row| row.experiment != "equal error"));
    assert_eq!(findings.notes.len(), 3, "{:#?}", findings.notes);
}
