//! `lightmesh report`.

use crate::run::Place;

/// Results of a suite with a single row.
const RESULTS: &str = r#"{"version": 1, "suite": "any", "quick": true,
    "program": {"name": "lightmesh", "version": "0", "commit": null, "command": "lightmesh bench any"},
    "machine": {"cpu": "a", "threads": 2, "memory_bytes": 1, "os": "b", "gpus": []},
    "started": "2026-01-31T12:00:00Z", "seconds": 1.0,
    "rows": [{"id": "e: scene=room", "experiment": "e", "keys": {"scene": "room"}, "seconds": {"render": [0.25]}}]}"#;

fn results() -> Place {
    let place = Place::new();
    place.write("a.json", RESULTS);
    place
}

#[test]
fn results_become_a_page_and_a_text() {
    let place = results();
    let done = place.good(&["report", "a.json", "a.json", "-o", "out"]);
    assert_eq!(done.stdout, "");
    assert!(done.stderr.contains("report.html"), "{done:?}");
    let text = String::from_utf8(place.read("out/report.md")).unwrap();
    assert!(text.contains("| room | 250 | 250 | 1.0× |"), "{text}");
    assert!(place.read("out/report.html").starts_with(b"<!DOCTYPE html>"));
    assert_eq!(place.good(&["report", "a.json", "-o", "out", "--quiet"]).stderr, "");
}

#[test]
fn what_holds_no_results_is_refused_and_nothing_written() {
    let place = results();
    place.write("b.json", &RESULTS.replace("\"version\": 1", "\"version\": 9"));
    let refused = |args: &[&str]| place.refused(&[&["report"], args].concat());
    assert!(refused(&["none.json", "-o", "out"]).contains("cannot read none.json"));
    assert!(refused(&["room.toml", "-o", "out"]).contains("room.toml does not contain results"));
    assert!(refused(&["a.json", "b.json", "-o", "out"]).contains("b.json has format version 9"));
    assert!(!place.path("out").exists());
    assert!(refused(&["a.json", "-o", "a.json"]).contains("cannot create the folder a.json"));
    refused(&["-o", "out"]);
}
