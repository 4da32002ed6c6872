//! `lightmesh render --turntable`: the frames of a film.

use lightmesh::image::Frame;

use crate::run::Place;

/// A red ball to the right and a blue one to the left of a camera.
const BALLS: &str = "\
[camera]
position = [0, 1, 9]
target = [0, 0, 0]
vfov = 40
[ambient]
intensity = [1, 1, 1]
[[material]]
name = \"red\"
kd = [1, 0, 0]
[[material]]
name = \"blue\"
kd = [0, 0, 1]
[[sphere]]
center = [1.5, 0, 0]
radius = 1
material = \"red\"
[[sphere]]
center = [-1.5, 0, 0]
radius = 1
material = \"blue\"
";

fn balls() -> Place {
    let place = Place::new();
    place.write("balls.toml", BALLS);
    place
}

/// By how much the right half of an image is redder than the left one.
fn redness(place: &Place, name: &str) -> f32 {
    let frame = Frame::load(place.path(name)).unwrap();
    let width = frame.width() as usize;
    let redness = |(index, color): (usize, &[f32; 3])| {
        let red = color[0] - color[2];
        if index % width < width / 2 { -red } else { red }
    };
    frame.color().iter().enumerate().map(redness).sum()
}

#[test]
fn the_camera_goes_once_around() {
    let place = balls();
    let render = ["render", "balls.toml", "--size", "32x24"];
    let film = [&render[..], &["--turntable", "4", "-o", "f.##.exr", "--stats", "f.##.json"]].concat();
    let done = place.good(&film);
    let summary = done.stderr.lines().last().unwrap();
    assert!(summary.starts_with("balls: 4 frames: "), "{summary}");
    assert!(done.stderr.contains("frame 3 of 4: ") && place.path("f.04.json").exists(), "{done:?}");
    let [front, right, back, left] = [1, 2, 3, 4].map(|number| redness(&place, &format!("f.{number:02}.exr")));
    // The key light stays where it is.
    assert!(front > 10.0 && back < -0.5 * front, "{front} {back}");
    assert!(right.abs() < 0.3 * front && left.abs() < 0.3 * front, "{right} {left}");

    place.good(&[&render[..], &["-o", "alone.exr"]].concat());
    assert_eq!(place.read("f.01.exr"), place.read("alone.exr"), "frame 1 is the image without --turntable");
}

#[test]
fn a_frame_does_not_depend_on_those_before() {
    let place = balls();
    let film = ["render", "balls.toml", "--size", "32x24", "--turntable", "9", "--sky", "clear", "--ground"];
    place.good(&[&film[..], &["-o", "all.#.exr", "--frames", "1-7x3"]].concat());
    place.good(&[&film[..], &["-o", "one.%d.exr", "--frames", "7"]].concat());
    assert_eq!(place.read("all.7.exr"), place.read("one.7.exr"));
    assert!(!place.path("all.2.exr").exists() && place.path("all.4.exr").exists());
}

#[test]
fn what_is_chosen_for_the_first_frame_holds_for_all() {
    let place = balls();
    let film = ["render", "balls.toml", "--size", "16x12", "--turntable", "3", "-o", "f.#.png", "--exposure", "auto"];
    let done = place.good(&[&film[..], &["--lookup", "half-ball", "--stats", "f.#.json"]].concat());
    assert_eq!(done.stderr.matches("exposure auto: using").count(), 1, "{done:?}");
    let [first, last] = ["f.1.json", "f.3.json"].map(|name| {
        let stats: serde_json::Value = serde_json::from_slice(&place.read(name)).unwrap();
        [stats["settings"]["exposure"].clone(), stats["settings"]["step"].clone()]
    });
    assert_eq!(first, last);
}

#[test]
fn frames_that_exist_are_kept_or_replaced_as_the_user_says() {
    let place = balls();
    let film = ["render", "balls.toml", "--size", "8x6", "--turntable", "3", "-o", "f.#.png"];
    place.write("f.2.png", "mine");
    let message = place.refused(&film);
    assert!(message.contains("f.2.png exists; add --skip-existing"), "{message}");
    assert!(!place.path("f.1.png").exists());
    let done = place.good(&[&film[..], &["--skip-existing"]].concat());
    assert!(done.stderr.contains("balls: 2 frames, 1 left as they were: "), "{done:?}");
    assert_eq!(place.read("f.2.png"), b"mine");
    let done = place.good(&[&film[..], &["--skip-existing"]].concat());
    assert!(done.stderr.contains("no frame is missing: 3 left as they were"), "{done:?}");
    place.good(&[&film[..], &["--overwrite", "--frames", "2"]].concat());
    assert_ne!(place.read("f.2.png"), b"mine");
}

#[test]
fn films_that_cannot_be_written_are_refused_at_once() {
    let place = balls();
    let film = ["render", "balls.toml", "--size", "8x6", "--turntable", "3"];
    for (flags, sentence) in [
        (&["-o", "f.png"][..], "-o f.png is one file, but a film has one for each frame; write ####"),
        (&["-o", "f.#.png", "--stats", "f.json"], "--stats f.json is one file"),
        (&["-o", "f.#.png", "--frames", "2-4"], "--frames 2-4: the film ends with frame 3"),
        (&["-o", "f.#.png", "--frames", "0-2"], "the film ends with frame 3"),
    ] {
        let message = place.refused(&[&film[..], flags].concat());
        assert!(message.contains(sentence), "{message}");
    }
}
