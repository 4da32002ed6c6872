//! `lightmesh render --sun` and `--sun-hours`: the hours of a day.

use lightmesh::image::Frame;

use crate::run::Place;

/// A tower on a floor, and a lamp, which stays.
const TOWER: &str = "[camera]\nposition = [4, 6, 9]\ntarget = [0, 1, 0]\nvfov = 40\n[[plane]]\nname = \"floor\"\npoint = [0, 0, 0]\n\
                     normal = [0, 1, 0]\nsize = [20, 20]\n[[box]]\nname = \"tower\"\ncenter = [0, 1.5, 0]\nsize = [1, 3, 1]\n\
                     [[light]]\nkind = \"point\"\nposition = [2, 3, 4]\nintensity = 0.2\n";

const RENDER: [&str; 6] = ["render", "tower.toml", "--size", "24x18", "--ambient-light", "constant"];

fn tower() -> Place {
    let place = Place::new();
    place.write("tower.toml", TOWER);
    place
}

fn study<'a>(sun: &'a str, flags: &[&'a str]) -> Vec<&'a str> {
    [&RENDER[..], &["--sun", sun], flags].concat()
}

#[test]
fn each_frame_is_that_of_its_sky() {
    let place = tower();
    let options = "clear;turbidity=4;north=30;ground=0.3;strength=2";
    let sun = "54.98,82.9,2026-06-21+07:00,06:00-20:00/7h";
    let done = place.good(&study(sun, &["-o", "day.##.exr", "--sky", options, "--ground"]));
    assert!(done.stderr.contains("frame 2 of 3, 13:00: "), "{done:?}");
    for (number, time) in [(1, "06:00"), (2, "13:00"), (3, "20:00")] {
        let sky = format!("{options};place=54.98,82.9;time=2026-06-21T{time}+07:00");
        place.good(&[&RENDER[..], &["-o", "alone.exr", "--sky", &sky, "--ground"]].concat());
        assert_eq!(place.read(&format!("day.0{number}.exr")), place.read("alone.exr"), "{time}");
    }
    // The same with gathered light and a known exposure.
    let gathered = ["--ambient-light", "mesh", "--exposure", "-1.5", "--size", "16x12"];
    let render = ["render", "tower.toml"];
    let film = ["--sun", sun, "-o", "day.#.png", "--frames", "2-3", "--sky", "clear;alone"];
    place.good(&[&render[..], &gathered, &film].concat());
    let sky = "clear;alone;place=54.98,82.9;time=2026-06-21T20:00+07:00";
    place.good(&[&render[..], &gathered, &["--sky", sky, "-o", "alone.png"]].concat());
    assert_eq!(place.read("day.3.png"), place.read("alone.png"));
    assert!(!place.path("day.1.png").exists());
}

#[test]
fn moments_without_sun_have_no_frame() {
    let place = tower();
    let done = place.good(&study("0,0,2026-03-20Z,00:00-24:00/3h", &["-o", "d.#.png", "--exposure", "auto"]));
    // 09:00, 12:00, 15:00 and 18:00: at 06:00 it has not risen, and at 18:00 not set.
    assert!(done.stderr.contains("5 moments are left out, from 00:00 to 24:00"), "{done:?}");
    assert!(done.stderr.contains("frame 4 of 4, 18:00") && !place.path("d.5.png").exists(), "{done:?}");
    assert_eq!(done.stderr.matches("exposure auto: using").count(), 1, "{done:?}");
    let done = place.good(&study("0,0,2026-03-20Z,00:00-24:00/3h", &["-o", "d.#.png", "--skip-existing"]));
    assert!(done.stderr.contains("no frame is missing"), "{done:?}");
}

#[test]
fn hours_need_no_film() {
    let place = tower();
    let sun = "48,0,2026-06-21Z,08:00-16:00/1h";
    let outputs = ["--sun-hours", "h.csv", "--sun-hours", "h.exr", "--sun-hours", "h.PNG"];
    let done = place.good(&study(sun, &outputs));
    let summary = done.stderr.lines().last().unwrap();
    assert!(summary.starts_with("hours of direct sun, 9 moments 60 min apart: "), "{summary}");
    assert_eq!(place.files(), ["h.PNG", "h.csv", "h.exr", "room.toml", "tower.toml"]);
    let table = String::from_utf8(place.read("h.csv")).unwrap();
    let floor = table.lines().find(|line| line.starts_with("floor,")).unwrap();
    let numbers: Vec<f64> = floor.split(',').skip(1).map(|number| number.parse().unwrap()).collect();
    assert!(numbers[2] > 6.0 && numbers[2] < 8.0 && numbers[4] == 8.0, "{table}");
    // Beside the image there is a legend; full sun is yellow.
    let picture = Frame::load(place.path("h.PNG")).unwrap();
    assert!(picture.width() > 24 && picture.height() > 18);
    let [red, green, blue] = picture.pixel(1, 16).unwrap();
    assert!(red > 0.9 && green > 0.7 && blue < 0.1, "{red} {green} {blue}");

    // With a film, and of a part of the image.
    place.good(&study(sun, &["--sun-hours", "part.csv", "-o", "d.#.png", "--frames", "5", "--crop", "0,9,24,9"]));
    let part = String::from_utf8(place.read("part.csv")).unwrap();
    let pixels: u64 = part.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse::<u64>().unwrap()).sum();
    assert!(pixels <= 24 * 9 && pixels > 100 && place.path("d.5.png").exists(), "{part}");
}

#[test]
fn a_polar_night_is_an_answer() {
    let place = tower();
    let files = ["--sun-hours", "h.csv", "--sun-hours", "h.exr", "--sun-hours", "h.png"];
    let done = place.good(&study("78,15,2026-12-21+01:00,00:00-24:00/1h", &files));
    assert!(done.stderr.contains("--sun: 25 moments are left out"), "{done:?}");
    let table = String::from_utf8(place.read("h.csv")).unwrap();
    let floor = table.lines().find(|line| line.starts_with("floor,")).unwrap();
    assert!(floor.contains(",0.0,0.0,0.0,0.0000,"), "{table}");
}

#[test]
fn studies_that_cannot_be_made_are_refused_at_once() {
    let place = tower();
    let day = "48,0,2026-06-21Z,08:00-16:00/1h";
    for (sun, flags, expected) in [
        (day, &["-o", "day.png"][..], "-o day.png is one file, but a film has one for each frame"),
        (day, &["-o", "d.#.png", "--frames", "10"], "--frames 10: the film ends with frame 9"),
        (day, &["-o", "d.#.png", "--sky", "uniform"], "--sun needs a clear sky"),
        (day, &["-o", "d.#.png", "--turntable", "3"], "cannot be used with"),
        (day, &["-o", "d.#.png", "--environment", "p.hdr"], "cannot be used with"),
        (
            day,
            &[],
            "--sun needs an output; add -o film.####.png for a frame of each STEP, --sun-hours hours.png for the hours of direct sun, or both",
        ),
        (day, &["--sun-hours", "h.jpg"], "--sun-hours h.jpg: unknown format; use the extension exr, png or csv"),
        (day, &["--sun-hours", "none/h.csv"], "none"),
        (day, &["--sun-hours", "h.csv", "--sun-hours", "./h.csv"], "are the same file"),
        (day, &["--sun-hours", "h.png", "-o", "h.png"], "has one for each frame"),
        (day, &["--sun-hours", "h.csv", "--layers", "l.exr"], "--output"),
        (
            day,
            &["--sun-hours", "h.csv", "--skip-existing"],
            "--skip-existing is for frames of a film, and hours of direct sun have none; leave it out (files of hours are replaced)",
        ),
        (day, &["--sun-hours", "h.csv", "--overwrite"], "--overwrite is for frames of a film"),
        (day, &["--sun-hours", "h.csv", "--resume"], "or write frames, too (-o film.####.png)"),
        (day, &["--sun-hours", "h.csv", "--frames", "1-2"], "--frames is for frames of a film"),
        (day, &["--sun-hours", "h.csv", "--fps", "12"], "--fps is for frames of a film"),
        (
            "78,15,2026-12-21+01:00,00:00-24:00/1h",
            &["--sun-hours", "h.csv", "-o", "d.#.png"],
            "below the horizon at all of these moments, so there is no frame",
        ),
        ("48,0,2026-06-21Z,16:00-08:00/1h", &["--sun-hours", "h.csv"], "the end must be a time of the same day"),
        ("48,0,2026-06-21,08:00-16:00/1h", &["--sun-hours", "h.csv"], "offset from universal time"),
        ("98,0,2026-06-21Z,08:00-16:00/1h", &["--sun-hours", "h.csv"], "-90 to 90"),
        ("48,0,2026-02-29Z,08:00-16:00/1h", &["--sun-hours", "h.csv"], "the date cannot be `2026-02-29`"),
    ] {
        let before = place.files();
        let done = place.run(&study(sun, flags));
        assert!(done.code == Some(2) && done.stderr.contains(expected), "{sun} {flags:?}: {done:?}");
        assert_eq!(place.files(), before, "{sun} {flags:?}");
    }
    let alone = place.refused(&["render", "tower.toml", "--sun-hours", "h.csv"]);
    assert!(alone.contains("required"), "{alone}");
    let none = place.refused(&["render", "tower.toml", "-o", "d.#.png", "--frames", "1"]);
    assert!(none.contains("nothing in the scene moves"), "{none}");
}

#[test]
fn glass_is_told() {
    let place = tower();
    let pane = "[[material]]\nname = \"pane\"\nior = 1.5\nthin = true\n[[plane]]\nname = \"window\"\npoint = [0, 4, 0]\n\
                normal = [0, 1, 0]\nsize = [2, 2]\nmaterial = \"pane\"\n";
    place.write("tower.toml", &format!("{TOWER}{pane}"));
    let sun = "48,0,2026-06-21Z,08:00-16:00/2h";
    let mut tables = Vec::new();
    for (glass, expected) in [
        (&[][..], "count this as open, except where it is at least half opaque; --glass closed counts it as walls"),
        (&["--glass", "closed"], "count this as walls (--glass closed)"),
        (&["--glass", "tinted"], "by the share of light that passes (--glass tinted)"),
    ] {
        let done = place.good(&study(sun, &[&["--sun-hours", "h.csv"], glass].concat()));
        assert!(
            done.stderr.contains("1 material lets light through (pane): ") && done.stderr.contains(expected),
            "{done:?}"
        );
        tables.push(place.read("h.csv"));
    }
    assert!(tables[0] != tables[1] && tables[0] != tables[2] && tables[1] != tables[2]);
    let none = tower().good(&study(sun, &["--sun-hours", "h.csv"]));
    assert!(!none.stderr.contains("lets light through"), "{none:?}");
    let alone = place.run(&[&RENDER[..], &["-o", "a.png", "--glass", "open"]].concat());
    assert!(alone.code == Some(2) && alone.stderr.contains("--sun <"), "{alone:?}");
}

/// Two nodes of a file that have the same name, beside each other on the ground.
const CHAIRS: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"name": "chair", "mesh": 0}, {"name": "chair", "mesh": 0, "translation": [2, 0, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

#[test]
fn objects_of_one_name_have_a_row_each() {
    let place = Place::new();
    place.write("chairs.gltf", CHAIRS);
    let sun = "48,0,2026-06-21Z,10:00-14:00/1h";
    for stored in ["always", "never"] {
        place.good(&[
            "render",
            "chairs.gltf",
            "--size",
            "64x48",
            "--sun",
            sun,
            "--sun-hours",
            "h.csv",
            "--instances",
            stored,
        ]);
        let table = String::from_utf8(place.read("h.csv")).unwrap();
        assert_eq!(table.lines().filter(|line| line.starts_with("chair,")).count(), 2, "{stored}: {table}");
    }
    // Mattes know the names alone: both are in the layers, and read again.
    place.good(&["render", "chairs.gltf", "-o", "a.png", "--size", "64x48", "--layers", "l.exr"]);
    let layers = Frame::load(place.path("l.exr")).unwrap();
    assert_eq!(layers.layers().unwrap().object.names, ["chair", "chair", "ground"]);
}
