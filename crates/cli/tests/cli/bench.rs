//! `lightmesh bench`.

use std::path::Path;

use serde_json::{Value, json};

use crate::run::Place;

/// Results of one row whose render took about `seconds`.
fn results(id: &str, seconds: f64) -> Value {
    let samples: Vec<f64> = [1.0, 1.01, 1.02, 1.01, 1.0].iter().map(|factor| factor * seconds).collect();
    json!({
        "version": 1, "suite": "thesis", "quick": false, "started": "2026-01-31T12:00:00Z", "seconds": 1.0,
        "program": { "name": "lightmesh", "version": "0.1.0", "commit": null, "command": "lightmesh bench thesis" },
        "machine": { "cpu": "one", "threads": 2, "memory_bytes": 1, "os": "linux", "gpus": [] },
        "rows": [{ "id": id, "experiment": "timings", "keys": { "scene": "garden" }, "seconds": { "render": samples } }],
    })
}

fn place() -> Place {
    let place = Place::new();
    for (name, id, seconds) in [("old", "a", 1.0), ("same", "a", 1.0), ("slow", "a", 1.2), ("other", "b", 1.0)] {
        place.write(&format!("{name}.json"), &results(id, seconds).to_string());
    }
    place
}

#[test]
fn suites_are_listed() {
    let place = Place::new();
    let list = place.good(&["bench", "--list"]).stdout;
    let names: Vec<&str> = list.lines().filter_map(|line| line.split(' ').next()).collect();
    assert_eq!(names, ["thesis", "quality", "rays", "shadows", "stages", "antialiasing", "flight", "light", "film"]);
    assert!(
        place
            .refused(&["bench", "speed"])
            .contains("there is no suite `speed`: choose thesis, quality, rays, shadows or stages")
    );
    assert!(place.refused(&["bench", "thesis", "--budget", "soon"]).contains("for instance 15m"));
    assert!(place.refused(&["bench", "thesis", "--json", "no/a.json"]).contains("the directory no does not exist"));
    assert!(
        place.refused(&["bench", "thesis", "--report", "room.toml"]).contains("cannot create the folder room.toml")
    );
    assert!(
        place
            .refused(&["bench", "thesis", "--size", "64"])
            .contains("omit them, or use the suite quality, rays or stages (--scene, --size)")
    );
    place.refused(&["bench", "quality", "--pictures"]);
    place.refused(&["bench"]);
    place.refused(&["bench", "--list", "thesis"]);
}

#[test]
fn equal_results_pass() {
    let place = place();
    let done = place.good(&["bench", "compare", "old.json", "same.json"]);
    assert!(done.stdout.contains("same    a [render]") && done.stderr.is_empty(), "{done:?}");
    // Faster is not a regression.
    place.good(&["bench", "compare", "slow.json", "old.json"]);
}

#[test]
fn a_doctored_result_is_exit_code_1() {
    let place = place();
    let done = place.run(&["bench", "compare", "old.json", "slow.json", "--json"]);
    assert_eq!((done.code, done.stderr.as_str()), (Some(1), "1 row is significantly slower\n"));
    let json: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!((&json["regressions"], &json["stages"][0]["verdict"]), (&json!(1), &json!("slower")));
    assert!((json["stages"][0]["ratio"].as_f64().unwrap() - 1.2).abs() < 1e-9, "{json}");
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let place = place();
    place.write("broken.json", "{\"version\": 1,");
    let mut later = results("a", 1.0);
    later["version"] = json!(9);
    place.write("later.json", &later.to_string());
    let refused = |new: &str| place.refused(&["bench", "compare", "old.json", new]);
    assert!(refused("none.json").contains("cannot read none.json"));
    assert!(refused("broken.json").contains("broken.json does not contain results of a suite"));
    assert!(refused("room.toml").contains("room.toml does not contain results of a suite"));
    assert!(refused("later.json").contains("later.json has format version 9"));
    assert!(refused("other.json").contains("no timed row in common"));
}

#[test]
fn without_time_a_suite_says_what_it_left_out() {
    let place = Place::new();
    let flags = ["--quick", "--budget", "0.001s", "--device", "cpu", "--json", "out.json"];
    let done = place.good(&[&["bench", "thesis"], &flags[..]].concat());
    assert!(done.stdout.contains("note: Dropped because of the time budget, "), "{done:?}");
    assert!(done.stderr.contains("rows 1 to 1 of "), "{done:?}");
    let json = place.json("out.json");
    assert_eq!((&json["suite"], &json["quick"], &json["rows"]), (&json!("thesis"), &json!(true), &json!([])));
    let command = json["program"]["command"].as_str().unwrap();
    assert_eq!(command, "lightmesh bench thesis --quick --budget 0.001s --device cpu --json out.json");
}

#[test]
fn rays_are_counted_on_any_scene() {
    let place = Place::new();
    let flags = ["--quick", "--budget", "0.001s", "--device", "cpu", "--threads", "1", "--json", "out.json"];
    let done = place.good(&[&["bench", "rays", "--scene", "room.toml", "--report", "out"], &flags[..]].concat());
    let page = Path::new("out").join("report.html");
    assert!(done.stderr.contains(&format!("out.json, {}", page.display())), "{done:?}");
    let report = String::from_utf8(place.read("out/report.md")).unwrap();
    assert!(
        report.contains("| Suite | rays, the short version |") && report.contains("scene room, size 512"),
        "{report}"
    );
    let json = place.json("out.json");
    let rows = json["rows"].as_array().unwrap();
    assert!(rows.iter().any(|row| row["keys"]["scene"] == "room" && row["keys"]["rays"] == "primary"), "{json}");
    assert!(place.refused(&["bench", "rays", "--scene", "none.ply"]).contains("none.ply"));
}

#[test]
fn stages_are_timed_and_every_one_is_compared() {
    let place = Place::new();
    let flags = ["--scene", "room.toml", "--size", "16", "--repeat", "3", "--device", "cpu", "--json", "a.json"];
    let done = place.good(&[&["bench", "stages"], &flags[..]].concat());
    assert!(done.stdout.contains("short_tests=plain") && done.stdout.contains("primary_rays "), "{done:?}");
    let mut json = place.json("a.json");
    let row = &mut json["rows"][0];
    assert_eq!((&row["keys"]["size"], row["seconds"]["shade"].as_array().unwrap().len()), (&json!(16.0), 3), "{row}");
    let id = row["id"].as_str().unwrap().to_owned();
    for (file, shade) in [("b.json", [0.01; 3]), ("c.json", [0.02; 3])] {
        json["rows"][0]["seconds"]["shade"] = json!(shade);
        place.write(file, &json.to_string());
    }
    let slower = place.run(&["bench", "compare", "b.json", "c.json"]);
    assert_eq!(slower.code, Some(1), "{slower:?}");
    assert!(slower.stdout.contains(&format!("slower  {id} [shade]\n")), "{slower:?}");
}

#[test]
fn pictures_are_kept_on_request() {
    let place = Place::new();
    let base =
        ["bench", "quality", "--quick", "--scene", "room.toml", "--size", "16", "--device", "cpu", "--repeat", "1"];
    let done = place.good(&[&base[..], &["--json", "a.json", "--pictures"]].concat());
    assert!(done.stderr.contains(", 3 images in "), "{done:?}");
    assert_eq!(place.json("a.json")["pictures"][1]["file"], "a-pictures/equal-time-room-light-mesh.png");
    place.good(&["report", "a.json", "-o", "out"]);
    let done = place.good(&[&base[..], &["--json", "b.json"]].concat());
    assert!(!done.stderr.contains("images"), "{done:?}");
    assert_eq!(place.json("b.json")["pictures"], json!([]));
    assert_eq!(place.files(), ["a-pictures", "a.json", "b.json", "out", "room.toml"]);
}
