//! Rust programs and the command line make the same files of the same requests.

use std::fs;

use lightmesh::Request;
use lightmesh::render::Unobserved;
use lightmesh::request::files::Files;
use lightmesh::request::table::Value;

use crate::run::{LAMP, Place};

/// A request of these settings, and its flags.
fn both(settings: &[(&str, &str)]) -> (Request, Vec<String>) {
    let (mut request, mut flags) = (Request::default(), Vec::new());
    let common = [("device", "cpu"), ("size", "48x36"), ("quality", "draft")];
    for (name, text) in common.iter().chain(settings) {
        let flag = format!("--{}", name.replace('_', "-"));
        if *text == "on" {
            request.set(name, true).unwrap();
            flags.push(flag);
        } else {
            request.set(name, Value::from(*text)).unwrap();
            flags.extend([flag, (*text).to_owned()]);
        }
    }
    (request, flags)
}

/// Runs `lightmesh render SCENE` with flags.
fn render(place: &Place, scene: &str, flags: &[String], output: &str) {
    let mut line = vec!["render", scene, "-o", output];
    line.extend(flags.iter().map(String::as_str));
    place.good(&line);
}

fn same(place: &Place, a: &str, b: &str, what: &str) {
    let [a, b] = [a, b].map(|name| fs::read(place.path(name)).unwrap());
    assert!(a == b, "{what}: {} and {} bytes differ", a.len(), b.len());
}

#[test]
fn a_picture_is_that_of_the_command_line() {
    let cases: [&[(&str, &str)]; 6] = [
        &[],
        &[("ground", "on"), ("view", "neutral"), ("bit_depth", "16")],
        &[("sky", "clear;sun=35,200"), ("ambient_light", "constant")],
        &[("light", LAMP), ("falloff", "inverse-square"), ("dither", "on")],
        &[("background", "transparent"), ("camera_name", "top"), ("no_studio", "on")],
        &[("exposure", "auto"), ("crop", "4,4,20,20"), ("mode", "ray-trace")],
    ];
    let place = Place::new();
    for settings in cases {
        let (request, mut flags) = both(settings);
        // A switch with a value.
        if let Some(index) = flags.iter().position(|flag| flag == "--dither") {
            flags.insert(index + 1, "on".to_owned());
        }
        render(&place, "room.toml", &flags, "cli.png");
        lightmesh::render(place.path("room.toml"), &request).unwrap().save(place.path("rust.png")).unwrap();
        same(&place, "cli.png", "rust.png", &format!("{settings:?}"));
    }
}

#[test]
fn a_linear_picture_is_that_of_the_command_line() {
    let place = Place::new();
    let (mut request, flags) = both(&[("ground", "on"), ("light", "3,5,2;90"), ("falloff", "inverse-square")]);
    render(&place, "room.toml", &flags, "cli.exr");
    request.set("format", "exr").unwrap();
    lightmesh::render(place.path("room.toml"), &request).unwrap().save(place.path("rust.exr")).unwrap();
    same(&place, "cli.exr", "rust.exr", "exr");
}

#[test]
fn films_and_sun_studies_are_those_of_the_command_line() {
    let place = Place::new();
    let day = "54.98,82.9,2026-06-21+07:00,09:00-15:00/3h";
    for (what, settings) in [("turn", [("turntable", "3")]), ("day", [("sun", day)])] {
        let (request, flags) = both(&settings);
        render(&place, "room.toml", &flags, &format!("cli-{what}.#.png"));
        let output = Some(place.path(&format!("rust-{what}.#.png")));
        let film =
            lightmesh::film(place.path("room.toml"), &request, Files { output, ..Files::default() }, &Unobserved);
        let numbers: Vec<u32> = film.unwrap().map(|frame| frame.unwrap().number).collect();
        assert_eq!(numbers, [1, 2, 3]);
        for number in numbers {
            same(&place, &format!("cli-{what}.{number}.png"), &format!("rust-{what}.{number}.png"), what);
        }
        // All frames are there, also for the command line.
        let resumed = [&flags[..], &["--resume".to_owned()]].concat();
        let mut line = vec!["render", "room.toml", "-o"];
        let pattern = format!("rust-{what}.#.png");
        line.push(&pattern);
        line.extend(resumed.iter().map(String::as_str));
        assert!(place.good(&line).stderr.contains("no frame is missing: 3 kept"), "{what}");
    }
    let (request, flags) = both(&[("sun", day)]);
    for extension in ["png", "csv", "exr"] {
        let file = format!("cli.{extension}");
        let mut line = vec!["render", "room.toml", "--sun-hours", &file];
        line.extend(flags.iter().map(String::as_str));
        place.good(&line);
        let hours = lightmesh::sun_hours(place.path("room.toml"), &request).unwrap();
        hours.save(&place.path(&format!("rust.{extension}"))).unwrap();
        same(&place, &file, &format!("rust.{extension}"), extension);
    }
}

#[test]
fn a_film_that_was_left_goes_on() {
    let place = Place::new();
    let (mut request, _) = both(&[("turntable", "4"), ("resume", "on")]);
    let files = Files { output: Some(place.path("f.#.png")), ..Files::default() };
    let film = |request: &Request| lightmesh::film(place.path("room.toml"), request, files.clone(), &Unobserved);
    let first: Vec<u32> = film(&request).unwrap().take(2).map(|frame| frame.unwrap().number).collect();
    let rest: Vec<u32> = film(&request).unwrap().map(|frame| frame.unwrap().number).collect();
    assert_eq!((first, rest), (vec![1, 2], vec![3, 4]));
    request.set("seed", "3").unwrap();
    let differs = film(&request).err().unwrap().to_string();
    assert!(
        differs.contains("seed was 0 and is 3") && differs.contains("overwrite=True in place of resume=True"),
        "{differs}"
    );
}

#[test]
fn errors_are_in_the_words_of_rust() {
    let place = Place::new();
    let message = |settings: &[(&str, &str)]| {
        let (request, _) = both(settings);
        lightmesh::render(place.path("room.toml"), &request).err().unwrap().to_string()
    };
    let studio = message(&[("studio", "on"), ("light", LAMP)]);
    assert_eq!(studio, "studio and light cannot be given together; leave out one of them");
    let crop = message(&[("crop", "70000,0,20,10")]);
    assert!(
        crop.starts_with("crop=70000,0,20,10 is more than 65536 pixels beyond the image of 48x36 pixels;"),
        "{crop}"
    );
    assert!(message(&[("camera_name", "nobody")]).contains("nobody"));
}
