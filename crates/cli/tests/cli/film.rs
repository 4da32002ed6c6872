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
fn frames_may_be_a_list() {
    let place = balls();
    let film = ["render", "balls.toml", "--size", "16x12", "--turntable", "9"];
    let done = place.good(&[&film[..], &["-o", "f.#.png", "--frames", "8,2,3-7:2"]].concat());
    let names: Vec<String> = place.files().into_iter().filter(|name| name.starts_with("f.")).collect();
    assert_eq!(names, ["f.2.png", "f.3.png", "f.5.png", "f.7.png", "f.8.png"], "{done:?}");
    let message = place.refused(&[&film[..], &["-o", "g.#.png", "--frames", "2,12"]].concat());
    assert!(message.contains("--frames 2,12: the film ends with frame 9"), "{message}");
    let message = place.refused(&[&film[..], &["-o", "g.#.png", "--frames", "2;3"]].concat());
    assert!(
        message.contains("or several with commas between them, for instance 1-120, 1-120x4 or 7,9,20-30"),
        "{message}"
    );
}

/// Exposure and step of a frame.
fn chosen(place: &Place, name: &str) -> [serde_json::Value; 2] {
    let stats: serde_json::Value = serde_json::from_slice(&place.read(name)).unwrap();
    [stats["settings"]["exposure"].clone(), stats["settings"]["step"].clone()]
}

#[test]
fn exposure_and_step_are_those_of_the_whole_film() {
    let place = balls();
    let film = ["render", "balls.toml", "--size", "16x12", "--turntable", "3", "--exposure", "auto"];
    let film = [&film[..], &["--lookup", "half-ball"]].concat();
    let done = place.good(&[&film[..], &["-o", "f.#.png", "--stats", "f.#.json"]].concat());
    assert_eq!(done.stderr.matches("exposure auto: using").count(), 1, "{done:?}");
    assert!(done.stderr.contains("from 3 frames across the film"), "{done:?}");
    place.good(&[&film[..], &["-o", "g.#.png", "--stats", "g.#.json", "--frames", "3"]].concat());
    assert_eq!(chosen(&place, "f.1.json"), chosen(&place, "f.3.json"));
    assert_eq!(chosen(&place, "f.1.json"), chosen(&place, "g.3.json"));
    assert_eq!(place.read("f.3.png"), place.read("g.3.png"));
}

/// A red ball that goes up behind a blue one, a camera that goes aside, and a light that goes around.
const MOVING: &str = "\
[camera]
position = [0, 1, 9]
target = [0, 0, 0]
vfov = 40
motion = { key = [{ time = 0, position = [0, 1, 9] }, { time = 1, position = [3, 1, 9] }] }
[ambient]
intensity = 0.3
[[light]]
kind = \"sphere\"
position = [4, 6, 4]
radius = 0.5
motion = { key = [{ time = 0, position = [4, 6, 4] }, { time = 1, position = [-4, 6, 4] }] }
[[material]]
name = \"red\"
kd = [1, 0, 0]
[[sphere]]
center = [1.5, 0, -2]
radius = 1
material = \"red\"
motion = { key = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [0, 2, 0] }] }
[[box]]
center = [-1.5, 0, 0]
size = [1.5, 2, 1.5]
motion = { interpolation = \"linear\", key = [{ time = 0, rotate = [0, 0, 0] }, { time = 1, rotate = [0, 90, 0] }] }
[[plane]]
point = [0, -1, 0]
normal = [0, 1, 0]
size = [12, 12]
";

#[test]
fn frames_of_a_scene_that_moves_equal_those_of_runs_of_their_own() {
    let place = Place::new();
    place.write("moving.toml", MOVING);
    for (name, mode) in [("lists", &["--lookup", "lists"][..]), ("ball", &["--lookup", "half-ball", "--step", "0.3"])] {
        let render = [&["render", "moving.toml", "--size", "32x24", "--fps", "4"], mode].concat();
        let [all, stats] = [format!("{name}.#.exr"), format!("{name}.#.json")];
        let done = place.good(&[&render[..], &["-o", &all, "--stats", &stats]].concat());
        assert!(done.stderr.contains("frame 5 of 5: "), "{done:?}");
        let one = format!("{name}.one.#.exr");
        for frame in ["1", "3", "5"] {
            place.good(&[&render[..], &["-o", &one, "--frames", frame]].concat());
            let file = |pattern: &str| place.read(&pattern.replace('#', frame));
            assert!(file(&all) == file(&one), "{name} {frame}");
        }
        assert_ne!(place.read(&all.replace('#', "1")), place.read(&all.replace('#', "5")));
    }
}

fn only_the_ball_moves() -> String {
    let moves =
        |line: &&str| line.contains("position = [0, 1, 9] }") || line.contains("[-4, 6, 4]") || line.contains("rotate");
    MOVING.lines().filter(|line| !moves(line)).collect::<Vec<_>>().join("\n")
}

#[test]
fn what_a_motion_cannot_change_is_kept() {
    let place = Place::new();
    place.write("ball.toml", &only_the_ball_moves());
    let film = ["render", "ball.toml", "--size", "32x24", "--fps", "8", "--lookup", "half-ball", "--step", "0.3"];
    place.good(&[&film[..], &["-o", "b.#.png", "--stats", "b.#.json"]].concat());
    let tests = |frame: u32| -> [u64; 2] {
        let stats: serde_json::Value = serde_json::from_slice(&place.read(&format!("b.{frame}.json"))).unwrap();
        ["long_tests", "long_tests_saved"].map(|name| stats["counts"][name].as_u64().unwrap())
    };
    assert_eq!(tests(1)[1], 0);
    for frame in 2..=9 {
        let [made, saved] = tests(frame);
        assert!(made > 0 && saved > made, "frame {frame}: {made} made, {saved} saved");
    }
}

#[test]
fn pixels_that_a_motion_does_not_reach_stay_as_they_are() {
    let place = Place::new();
    place.write("ball.toml", &only_the_ball_moves());
    for lookup in ["lists", "half-ball"] {
        let pattern = format!("{lookup}.#.exr");
        place.good(&["render", "ball.toml", "--size", "48x36", "--fps", "2", "--lookup", lookup, "-o", &pattern]);
        let [first, second, third] =
            ["1", "2", "3"].map(|number| Frame::load(place.path(&pattern.replace('#', number))).unwrap());
        // In front of the box on the left, where neither the ball nor its shadow comes.
        let corner = |frame: &Frame| -> Vec<[f32; 3]> {
            frame.color().chunks(48).skip(27).flat_map(|row| &row[..16]).copied().collect()
        };
        assert!(corner(&first) == corner(&second) && corner(&second) == corner(&third), "{lookup}");
        assert!(first.color() != second.color(), "{lookup}");
    }
}

/// A step is asked of frames across the film, for which the scene is built again.
#[test]
fn only_light_points_need_the_scene_at_other_frames() {
    let place = Place::new();
    place.write("moving.toml", MOVING);
    let film = ["render", "moving.toml", "--size", "16x12", "--fps", "25", "--frames", "1-3", "--progress", "json"];
    let builds = |lookup: &str| {
        let done = place.good(&[&film[..], &["--lookup", lookup, "-o", &format!("{lookup}.#.png")]].concat());
        done.stderr.matches(r#"{"event":"begin","stage":"build""#).count()
    };
    // The scene as it is opened, and three frames.
    assert_eq!(["lists", "adaptive", "half-ball"].map(builds), [4, 4, 9]);
}

#[test]
fn scenes_that_do_not_move_have_no_film_of_their_own() {
    let place = balls();
    for flags in [&["--frames", "1-3"][..], &["--fps", "12"]] {
        let message = place.refused(&[&["render", "balls.toml", "-o", "f.#.png"], flags].concat());
        assert!(message.contains("nothing in the scene moves; add --turntable N"), "{message}");
    }
    let message = place.refused(&["render", "balls.toml", "-o", "f.png", "--overwrite"]);
    let expected = "--overwrite is for films; add --turntable, --sun, --frames or --fps, or leave it out";
    assert!(message.contains(expected), "{message}");
    let done = place.run(&["render", "balls.toml"]);
    assert!(done.code == Some(2) && done.stderr.contains("--output") && !done.stderr.contains("--sun"), "{done:?}");
    place.write("moving.toml", MOVING);
    let message = place.refused(&["render", "moving.toml", "-o", "f.#.png", "--frames", "20-30"]);
    assert!(message.contains("the film ends with frame 25"), "{message}");
    let done = place.good(&["render", "moving.toml", "-o", "f.png", "--size", "8x6"]);
    assert!(done.stderr.contains("the scene moves for 1.00 s"), "{done:?}");
    let done = place.good(&["info", "moving.toml"]);
    assert!(done.stdout.contains("moves   1 s: objects move"), "{done:?}");
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
    assert!(done.stderr.contains("balls: 2 frames, 1 kept: "), "{done:?}");
    assert_eq!(place.read("f.2.png"), b"mine");
    let done = place.good(&[&film[..], &["--skip-existing"]].concat());
    assert!(done.stderr.contains("no frame is missing: 3 kept"), "{done:?}");
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
        (&["-o", "f.#.png", "--frames", "0-2"], "--frames 0-2: films begin with frame 1"),
    ] {
        let message = place.refused(&[&film[..], flags].concat());
        assert!(message.contains(sentence), "{message}");
    }
}
