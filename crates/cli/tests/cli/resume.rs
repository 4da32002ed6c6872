//! `lightmesh render --turntable N --resume`: films that end at any moment, and go on as if they had not.

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use xxhash_rust::xxh3::xxh3_128;

use crate::run::{Done, Place};

/// The manifest of a folder.
const MANIFEST: &str = "manifest.json";
/// A film whose exposure and step are chosen by its first frame, with several files for each frame.
const FILM: [&str; 15] = [
    "render",
    "room.toml",
    "--size",
    "24x16",
    "--turntable",
    "12",
    "-o",
    "f.##.png",
    "--layers",
    "l.##.exr",
    "--exposure",
    "auto",
    "--lookup",
    "half-ball",
    "--quiet",
];
const FRAMES: u32 = 12;

fn kill(mut child: Child) {
    // It may have ended.
    let _ = child.kill();
    child.wait().unwrap();
}

fn film(flags: &[&'static str]) -> Vec<&'static str> {
    [&FILM[..], flags].concat()
}

/// The bytes of all pictures and layers.
fn bytes(place: &Place) -> Vec<(String, Vec<u8>)> {
    let names = (1..=FRAMES).flat_map(|number| [format!("f.{number:02}.png"), format!("l.{number:02}.exr")]);
    names.map(|name| (name.clone(), place.read(&name))).collect()
}

fn assert_same(place: &Place, whole: &[(String, Vec<u8>)]) {
    for ((name, is), (_, should)) in bytes(place).iter().zip(whole) {
        assert!(is == should, "{name} differs from that of an uninterrupted run");
    }
}

/// What the manifest says of a film.
fn record(place: &Place, film: &str) -> Value {
    place.json(MANIFEST)["films"][film].clone()
}

/// Films are killed by what they have written, at a random moment of the next frame, so that slow and busy machines kill no other
/// moments: after none, one, … of the frames that are left.
#[test]
fn a_film_that_is_killed_at_any_moment_ends_as_if_it_had_not() {
    let (place, whole) = (Place::new(), Place::new());
    let begin = Instant::now();
    whole.good(&film(&[]));
    let frame = begin.elapsed() / FRAMES;
    let whole = bytes(&whole);
    let written = || whole.iter().filter(|(name, _)| place.path(name).exists()).count();
    let (mut random, mut parts) = (0x9e37_79b9_u32, 0);
    for kill_number in 0..20 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let begun = written();
        let mut child = place.command(&film(&["--resume"])).stderr(Stdio::null()).spawn().unwrap();
        while written() < begun + kill_number % 5 && child.try_wait().unwrap().is_none() {
            sleep(Duration::from_micros(200));
        }
        sleep(frame.mul_f32((random >> 8) as f32 / (1 << 24) as f32));
        kill(child);
        // What is there is whole, whatever the moment.
        let there: Vec<_> = whole.iter().filter(|(name, _)| place.path(name).exists()).collect();
        there.iter().for_each(|(name, should)| assert!(place.read(name) == *should, "{name}"));
        parts += usize::from(!there.is_empty() && there.len() < whole.len());
        if there.len() == whole.len() {
            // The film begins again.
            let names = place.files().into_iter().filter(|name| name != "room.toml");
            names.for_each(|name| std::fs::remove_file(place.path(&name)).unwrap());
        }
    }
    assert!(parts > 2, "{parts} of 20 kills left a part of the film");
    let done = place.good(&film(&["--resume"]));
    assert_eq!(done.stderr, "");
    assert_same(&place, &whole);
    let left: Vec<String> = place.files().into_iter().filter(|name| name.starts_with(".lightmesh-")).collect();
    assert!(left.is_empty(), "{left:?}");
    assert_eq!(place.files().len(), 2 * FRAMES as usize + 2);
}

#[test]
fn only_frames_that_are_as_recorded_are_kept() {
    let place = Place::new();
    let begun = place.good(&film(&["--resume", "--frames", "1-9"]));
    assert_eq!(begun.stderr, "");
    let recorded = record(&place, "f.##.png");
    assert_eq!(recorded["frames"].as_object().unwrap().len(), 9);
    assert_eq!(recorded["frames"]["3"][0]["bytes"], place.read("f.03.png").len());
    assert!(recorded["chosen"]["exposure"].is_number() && recorded["chosen"]["step"].is_number(), "{recorded}");

    // The first frame, which has chosen for all; one half of a frame; a file of the same size; a file that is cut.
    std::fs::remove_file(place.path("f.01.png")).unwrap();
    std::fs::remove_file(place.path("l.04.exr")).unwrap();
    let mut edited = place.read("f.05.png");
    *edited.last_mut().unwrap() ^= 1;
    std::fs::write(place.path("f.05.png"), edited).unwrap();
    std::fs::write(place.path("f.06.png"), "").unwrap();
    let resume: Vec<&str> = film(&["--resume"]).into_iter().filter(|&flag| flag != "--quiet").collect();
    let done = place.good(&resume);
    assert!(done.stderr.contains("room: 7 frames, 5 kept: "), "{done:?}");

    let whole = Place::new();
    whole.good(&film(&[]));
    assert_same(&place, &bytes(&whole));
    let again = place.good(&resume);
    assert!(again.stderr.contains("no frame is missing: 12 kept"), "{again:?}");
}

#[test]
fn another_scene_and_other_settings_are_refused() {
    let place = Place::new();
    place.good(&film(&["--frames", "1-2"]));
    let refused = |flags: &[&'static str]| place.refused(&film(flags));
    let seed = refused(&["--resume", "--seed", "3"]);
    assert!(seed.contains("manifest.json: the settings of the film f.##.png differ: --seed was 0 and is 3;"), "{seed}");
    assert!(seed.ends_with("or write --overwrite in place of --resume to begin anew"), "{seed}");
    assert!(refused(&["--resume", "--camera-name", "top"]).contains("--camera-name was not given and is top;"));
    // The machine and messages do not matter.
    place.good(&film(&["--resume", "--threads", "1", "--accel", "bvh", "--progress", "none", "--frames", "3"]));

    let scene = String::from_utf8(place.read("room.toml")).unwrap();
    place.write("room.toml", &scene.replace("0.8, 0.8, 0.8", "0.8, 0.8, 0.7"));
    let changed = refused(&["--resume"]);
    assert!(
        changed.contains("the scene of the film f.##.png differs: room.toml, or a file that it refers to"),
        "{changed}"
    );
    place.good(&film(&["--overwrite", "--frames", "1-2"]));
    assert_eq!(record(&place, "f.##.png")["frames"].as_object().unwrap().len(), 2, "the film is begun anew");

    // As another version would write it, with the checksum of the films.
    let text = String::from_utf8(place.read(MANIFEST)).unwrap().replace(env!("CARGO_PKG_VERSION"), "0.0.1");
    let films = text.split_once("\"films\": ").unwrap().1.trim_end().strip_suffix("\n}").unwrap().replace("\n  ", "\n");
    let sum = format!("{:032x}", xxh3_128(format!("{films}\n").as_bytes()));
    let before = place.json(MANIFEST)["xxh3"].as_str().unwrap().to_owned();
    place.write(MANIFEST, &text.replace(&before, &sum));
    assert!(refused(&["--resume"]).contains("was begun by version 0.0.1 of lightmesh, and this is "));
    for flag in ["--overwrite", "--skip-existing"] {
        assert!(refused(&["--resume", flag]).contains("cannot be used with"), "{flag}");
    }
    let piped = ["render", "-", "--scene-format", "toml", "--turntable", "2", "-o", "g.#.png", "--resume"];
    assert!(place.refused(&piped).contains("--resume needs a scene that can be read again"));
}

/// A digit of the manifest decides about all frames that are left.
#[test]
fn an_edited_manifest_is_refused() {
    let place = Place::new();
    let path = |flags: &[&'static str]| film(flags);
    place.good(&path(&["--frames", "1-2"]));
    let text = String::from_utf8(place.read(MANIFEST)).unwrap();
    let exposure = record(&place, "f.##.png")["chosen"]["exposure"].to_string();
    let digit = exposure.chars().last().unwrap();
    let other = format!("{}{}", &exposure[..exposure.len() - 1], (digit as u8 - b'0' + 1) % 10);
    let edited = text.replacen(&exposure, &other, 1);
    assert_ne!(edited, text);
    place.write(MANIFEST, &edited);
    let message = place.refused(&path(&["--resume"]));
    assert!(message.contains("manifest.json is not as it was written: its checksum is another one;"), "{message}");
    assert!(message.ends_with("or remove it and write --overwrite in place of --resume to begin anew"), "{message}");
    // Without resuming, the film is rendered, and the manifest is left as it is.
    let done = place.good(&path(&["--overwrite", "--frames", "1"]));
    assert!(done.stderr.is_empty(), "quiet: {done:?}");
    assert!(place.read(MANIFEST) == edited.as_bytes());
    // How it is typed does not matter.
    let value: Value = serde_json::from_str(&text).unwrap();
    place.write(MANIFEST, &value.to_string());
    place.good(&path(&["--resume", "--frames", "1-3"]));
}

#[test]
fn films_of_one_folder_are_held_apart() {
    let place = Place::new();
    let render = ["render", "room.toml", "--size", "8x6", "--turntable", "3", "-q", "-o"];
    place.good(&[&render[..], &["a.#.png"]].concat());
    place.good(&[&render[..], &["b.#.png", "--seed", "7", "--frames", "2"]].concat());
    // Parts of one film add to each other.
    place.good(&[&render[..], &["b.#.png", "--seed", "7", "--frames", "3", "--resume"]].concat());
    let numbers = |film| record(&place, film)["frames"].as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(
        (numbers("a.#.png"), numbers("b.#.png")),
        (vec!["1".into(), "2".into(), "3".into()], vec!["2".into(), "3".into()])
    );
}

#[test]
fn what_is_not_ours_is_neither_replaced_nor_followed() {
    let place = Place::new();
    let render = ["render", "room.toml", "--size", "8x6", "--turntable", "3", "-o", "a.#.png"];
    place.write("a.2.png", "mine");
    let message = place.refused(&[&render[..], &["--resume"]].concat());
    assert!(message.contains("a.2.png exists"), "without a manifest nothing is replaced: {message}");
    std::fs::remove_file(place.path("a.2.png")).unwrap();
    place.write(MANIFEST, r#"{"name": "of a site"}"#);
    let message = place.refused(&[&render[..], &["--resume"]].concat());
    assert!(message.contains("manifest.json is not a manifest of films ("), "{message}");
    let done = place.good(&render);
    assert!(done.stderr.contains("warning: this film cannot be resumed: "), "{done:?}");
    assert_eq!(place.read(MANIFEST), br#"{"name": "of a site"}"#);
}

/// Files may have 16 blocks of 512 bytes: more than the manifest, and less than an image.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_whole_frames_and_the_film_goes_on() {
    let place = Place::new();
    let render = ["render", "room.toml", "--turntable", "3", "-o", "a.#.bmp", "--quiet", "--resume", "--size", "60x50"];
    let limited: Done = place.shell("ulimit -f 16; exec \"$0\" \"$@\"", &render).output().unwrap().into();
    assert_eq!(limited.code, Some(2), "{limited:?}");
    let message = limited.stderr.lines().last().unwrap();
    assert!(message.starts_with("error: frame 1 of 3: cannot save a.1.bmp: File too large"), "{message}");
    assert!(message.ends_with("nothing was written; check the free disk space"), "{message}");
    assert_eq!(place.files(), [MANIFEST, "room.toml"]);
    place.good(&render);
    let whole = Place::new();
    whole.good(&render);
    for name in ["a.1.bmp", "a.2.bmp", "a.3.bmp"] {
        assert_eq!(place.read(name), whole.read(name), "{name}");
    }
}

/// A folder is in the way of the last frame.
#[test]
fn a_film_that_fails_after_some_frames_says_so_by_its_exit_code() {
    let place = Place::new();
    let flags = ["--size", "400x300", "--mode", "area", "--light", "3,5,2;1;0.5", "-o", "a.#.png", "--turntable", "9"];
    let mut command = place.command(&[&["render", "room.toml"], &flags[..]].concat());
    let child = command.stderr(Stdio::piped()).spawn().unwrap();
    let begin = Instant::now();
    while !place.path("a.1.png").exists() {
        assert!(begin.elapsed() < Duration::from_secs(30));
        sleep(Duration::from_millis(1));
    }
    std::fs::create_dir(place.path("a.9.png")).unwrap();
    let done: Done = child.wait_with_output().unwrap().into();
    assert_eq!(done.code, Some(4), "{done:?}");
    let message = done.stderr.lines().last().unwrap();
    assert!(message.starts_with("error: frame 9 of 9: cannot write a.9.png: it is a directory"), "{message}");
    assert!(message.ends_with("; 8 frames are finished (--resume goes on)"), "{message}");
    assert_eq!(record(&place, "a.#.png")["frames"].as_object().unwrap().len(), 8);
}

#[cfg(unix)]
#[test]
fn a_film_that_is_interrupted_leaves_whole_frames_and_says_how_to_go_on() {
    let place = Place::new();
    let flags =
        ["--size", "200x150", "--mode", "area", "--light", "3,5,2;1;0.5", "-o", "a.##.png", "--turntable", "99"];
    let child = place.command(&[&["render", "room.toml"], &flags[..]].concat()).stderr(Stdio::piped()).spawn().unwrap();
    let begin = Instant::now();
    while !place.path("a.02.png").exists() {
        assert!(begin.elapsed() < Duration::from_secs(30));
        sleep(Duration::from_millis(1));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let done: Done = child.wait_with_output().unwrap().into();
    assert_eq!(done.code, Some(130), "{done:?}");
    let message = done.stderr.lines().last().unwrap();
    assert!(message.starts_with("interrupted: written: "), "{message}");
    assert!(message.ends_with(" of 99 frames are finished (--resume goes on)"), "{message}");
    assert!(!message.contains(MANIFEST), "{message}");
}

#[test]
fn progress_tells_of_each_frame_and_notes_are_said_once() {
    let place = Place::new();
    let render = ["render", "room.toml", "--size", "16x12", "--turntable", "3", "-o", "a.#.png", "--stats", "a.#.json"];
    let done = place.good(&[&render[..], &["--progress", "json", "--exposure", "auto"]].concat());
    let events: Vec<Value> = done.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let frames: Vec<&Value> = events.iter().filter(|event| event["event"] == "frame").collect();
    let [_, second, third] = frames[..] else { panic!("{frames:?}") };
    assert_eq!(second["files"], json!(["a.2.png", "a.2.json"]));
    assert_eq!([&second["number"], &second["index"], &second["count"], &second["kept"]], [2, 2, 3, 0]);
    assert!(second["seconds"].as_f64().unwrap() > 0.0 && third["left"] == 0.0, "{frames:?}");
    let notes: Vec<&Value> =
        events.iter().filter(|event| event["event"] == "note").map(|event| &event["text"]).collect();
    assert!(notes.iter().enumerate().all(|(index, note)| !notes[..index].contains(note)), "{notes:?}");
    std::fs::remove_file(place.path("a.2.png")).unwrap();
    let done = place.good(&[&render[..], &["--progress", "json", "--exposure", "auto", "--resume"]].concat());
    let frame = done.stderr.lines().find(|line| line.starts_with(r#"{"event":"frame","#)).unwrap();
    assert!(frame.contains(r#""number":2,"index":1,"count":1,"kept":2,"#), "{frame}");
}
