//! What is rejected, with which message, and before any work is done.

use crate::run::{Place, text};

/// Renders the room to `a.png` with more flags, at a size that would take minutes.
fn refused(place: &Place, flags: &[&str]) -> String {
    place.refused(&[&["render", "room.toml", "-o", "a.png", "--mode", "area", "--size", "8000x8000"], flags].concat())
}

#[test]
fn a_missing_scene_is_named() {
    let place = Place::new();
    // In parentheses stands what the system says, which differs from one to the other.
    let message = place.refused(&["render", "none.toml", "-o", "a.png"]);
    assert!(message.starts_with("error: cannot read the file ("), "{message}");
    assert!(message.ends_with(" (os error 2)), none.toml; check that it exists and is readable"), "{message}");
    assert_eq!(
        place.refused(&["info", "builtin:castle"]),
        "error: there is no built-in scene `castle`, builtin:castle; available: gazebo, childpark, garden"
    );
}

#[test]
fn a_mistake_in_a_scene_has_a_file_and_a_line() {
    let place = Place::new();
    place.write("bad.toml", "[[sphere]]\ncenter = [0, 0, 0]\nraduis = 1\n");
    let message = place.refused(&["render", "bad.toml", "-o", "a.png"]);
    assert!(message.contains("`raduis`") && message.contains("bad.toml:3"), "{message}");
}

#[test]
fn values_of_another_form_are_shown_the_form() {
    let place = Place::new();
    let size = "error: invalid value '640' for '--size <WxH>': write WIDTHxHEIGHT, both integers of at least 1, for \
                instance 1024x768";
    assert_eq!(place.refused(&["render", "room.toml", "-o", "a.png", "--size", "640"]), size);
    let cases: [(&[&str], &str); 16] = [
        (&["--camera", "1,2,3"], "write POSITION;TARGET;VFOV, the vertical field of view"),
        (&["--camera", "0,0,1;0,0,1;40"], "position and target are the same point"),
        (&["--light", "1,2"], "write POSITION, POSITION;INTENSITY or"),
        (&["--light", "1,2,3;1;-2"], "the radius must be 0 or more, but is -2"),
        (&["--exposure", "bright"], "`bright` is not a valid number"),
        (&["--ambient", "1,2"], "red,green,blue"),
        (&["--step", "-1"], "invalid light-mesh step `-1`: use a number above 0, or auto"),
        (&["--radius", "-1"], "the number must be above 0, but is -1"),
        (&["--radius", "nan"], "`nan` is not a valid number"),
        (&["--samples", "0"], "0 is not in 1..=65535"),
        (&["--threads", "0"], "0 is not in 1..=1024"),
        (&["--grid", "5x5"], "write NXxNYxNZ"),
        (&["--memory-limit", "lots"], "write a number of bytes"),
        (&["--device", "gpu"], "choose auto, cpu, cuda, cuda:N, or several"),
        (&["--seed", "-1"], "invalid value '-1' for '--seed <S>'"),
        (&["--bounces", "x"], "invalid value 'x' for '--bounces <N>'"),
    ];
    for (flags, expected) in cases {
        let message = refused(&place, flags);
        assert!(message.contains(expected), "{flags:?}: {message}");
    }
}

#[test]
fn an_unknown_word_is_answered_with_the_known() {
    let place = Place::new();
    let cases = [
        ("--mode", "light-mesh, ray-trace, area"),
        ("--weight", "constant, quadratic, smooth"),
        ("--lookup", "auto, lists, half-ball, adaptive"),
        ("--quality", "draft, good, final"),
        ("--short-tests", "cells, plain"),
        ("--accel", "auto, grid, bvh"),
        ("--up", "auto, y, z"),
        ("--falloff", "none, inverse-square"),
        ("--transfer", "srgb, linear"),
        ("--progress", "auto, bar, json, openjd, none"),
    ];
    for (flag, known) in cases {
        let done = place.run(&["render", "room.toml", "-o", "a.png", flag, "foo"]);
        assert_eq!(done.code, Some(2));
        assert!(done.stderr.contains(&format!("[possible values: {known}]")), "{done:?}");
    }
    let camera = refused(&place, &["--camera-name", "side"]);
    assert_eq!(camera, "error: there is no camera named `side`, scene room; available: front, top");
}

#[test]
fn flags_that_contradict_each_other_are_refused() {
    let place = Place::new();
    for flags in [
        &["--camera", "0,0,1;0,0,0;40", "--camera-name", "top"][..],
        &["--grid", "2x2x2", "--grid-file", "g"],
        &["--falloff", "none"],
    ] {
        refused(&place, flags);
    }
    assert_eq!(
        refused(&place, &["--accel", "bvh", "--grid", "2x2x2"]),
        "error: --grid specifies a grid, but --accel bvh selects another structure; remove one of them"
    );
}

#[test]
fn an_unwritable_output_is_found_before_rendering() {
    let place = Place::new();
    std::fs::create_dir(place.path("folder.png")).unwrap();
    let render = |output: &str, flags: &[&str]| {
        let base = ["render", "room.toml", "-o", output, "--mode", "area", "--size", "8000x8000"];
        place.refused(&[&base, flags].concat())
    };
    assert_eq!(
        render("a.foo", &[]),
        "error: cannot save a.foo: unknown image format; use one of these extensions: bmp, png, exr, jpg, jpeg (--format)"
    );
    assert_eq!(
        render("no/a.png", &[]),
        "error: cannot write no/a.png: the directory no does not exist; create it first"
    );
    assert!(render("folder.png", &[]).contains("it is a directory"));
    assert!(render("a.png", &["--layers", "a.jpg"]).contains("only OpenEXR files can store them"));
    assert!(render("a.png", &["--layers", "no/a.exr"]).contains("does not exist"));
    assert!(
        render("a.png", &["--stats", "no/a.json"]).contains("cannot write no/a.json: the directory no does not exist")
    );
    let wide = place.refused(&["render", "room.toml", "-o", "a.jpg", "--size", "70000x2"]);
    assert!(wide.contains("too many for jpg (65535 pixels per side)"), "{wide}");
}

#[test]
fn no_output_overwrites_another_file_of_the_run() {
    let place = Place::new();
    assert_eq!(
        place.refused(&["render", "room.toml", "-o", "a.exr", "--layers", "./a.exr"]),
        "error: -o and --layers are the same file, ./a.exr; give them different names"
    );
    assert!(refused(&place, &["--stats", "room.toml"]).contains("the scene and --stats are the same file"));
    assert!(refused(&place, &["--stats", "a.png"]).contains("-o and --stats are the same file"));
    let same = ["room.toml", "-o", text(&place.path("room.toml"))].map(str::to_owned);
    for subcommand in ["grid", "export"] {
        let message = place.refused(&[subcommand, &same[0], &same[1], &same[2]]);
        assert!(message.contains("the scene and -o are the same file"), "{message}");
    }
}

#[test]
fn grids_that_do_not_fit_are_refused() {
    let place = Place::new();
    place.good(&["grid", "builtin:gazebo", "-o", "gazebo.grid", "-q"]);
    let other = refused(&place, &["--grid-file", "gazebo.grid"]);
    assert!(other.contains("gazebo.grid: belongs to another scene") && other.contains("lightmesh grid"), "{other}");
    assert!(refused(&place, &["--grid-file", "none.grid"]).contains("none.grid: cannot be read"));
    place.write("notes.txt", "not a grid, but long enough to have a header of the right size");
    assert!(refused(&place, &["--grid-file", "notes.txt"]).contains("notes.txt: is not a grid file"));
    assert!(refused(&place, &["--grid", "4000x4000x4000"]).contains("4000x4000x4000 cells"));
}

#[test]
fn what_is_wrong_in_a_render_names_value_remedy_and_flag() {
    let place = Place::new();
    let message = |flags: &[&str]| {
        let done = place.run(&[&["render", "room.toml", "-o", "a.png"], flags].concat());
        done.stderr.lines().last().unwrap().to_owned()
    };
    let cases: [(&[&str], &[&str]); 5] = [
        (&["--step", "1e-9"], &["light-mesh step h = 0.000000001", "or more (--step)"]),
        (&["--radius", "99"], &["R = 99", "2.1 is a good choice (--radius)"]),
        (&["--size", "100000x100000"], &["size = 100000x100000", "below 4294967295 (--size)"]),
        (
            &["--size", "60000x60000", "--memory-limit", "1G"],
            &["not enough memory for the image", "GiB are needed", "left of 1.0 GiB"],
        ),
        (&["--memory-limit", "1M"], &["not enough memory for ", "--memory-limit"]),
    ];
    for (flags, parts) in cases {
        let message = message(flags);
        assert!(parts.iter().all(|part| message.contains(part)), "{flags:?}: {message}");
    }
    let flags = ["--size", "16x16", "--lookup", "half-ball"];
    let chosen = place.good(&[&["render", "room.toml", "-o", "a.png"], &flags[..]].concat()).stderr;
    assert!(chosen.contains("chosen for this image (--step sets another)"), "{chosen}");
}

#[test]
fn what_the_machine_cannot_do_has_exit_code_3() {
    let place = Place::new();
    for flags in [&["--device", "cuda:4096"][..], &["--memory-limit", "1M"]] {
        let done = place.run(&[&["render", "room.toml", "-o", "a.png"], flags].concat());
        assert_eq!(done.code, Some(3), "{flags:?}: {done:?}");
        assert!(done.stderr.lines().last().unwrap().starts_with("error: "), "{done:?}");
    }
    assert_eq!(place.files(), ["room.toml"]);
}
