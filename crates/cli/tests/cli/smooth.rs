//! `--smooth`: defaults, the variable, and what the subcommands say of it.

use std::fmt::Write as _;

use crate::run::Place;

/// A column of 24 sides without caps.
fn column(place: &Place) {
    let mut text = String::new();
    for side in 0..24 {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(side) / 24.0).sin_cos();
        writeln!(text, "v {cos:.6} 0 {sin:.6}\nv {cos:.6} 2 {sin:.6}").unwrap();
    }
    for (low, next) in (0..24).map(|side| (2 * side + 1, 2 * ((side + 1) % 24) + 1)) {
        writeln!(text, "f {low} {} {} {next}", low + 1, next + 1).unwrap();
    }
    place.write("column.obj", &text);
}

fn smooth_of(place: &Place, flags: &[&str]) -> serde_json::Value {
    let base = ["render", "column.obj", "-o", "a.png", "-q", "--size", "16x16", "--stats", "s.json"];
    place.good(&[&base, flags].concat());
    place.json("s.json")["settings"]["smooth"].clone()
}

#[test]
fn files_without_normals_are_smooth_except_with_the_half_ball() {
    let place = Place::new();
    column(&place);
    for flags in [&[][..], &["--lookup", "adaptive"], &["--mode", "ray-trace"], &["--mode", "area", "--samples", "4"]] {
        assert_eq!(smooth_of(&place, flags), 30.0, "{flags:?}");
    }
    for flags in
        [["--lookup", "half-ball"], ["--step", "0.5"], ["--radius", "3"], ["--weight", "constant"], ["--smooth", "off"]]
    {
        assert!(smooth_of(&place, &flags).is_null(), "{flags:?}");
    }
    assert_eq!(smooth_of(&place, &["--lookup", "half-ball", "--smooth", "20"]), 20.0);
}

#[test]
fn smooth_and_flat_pictures_differ() {
    let place = Place::new();
    column(&place);
    let render = |name: &str, smooth: &str| {
        place.good(&["render", "column.obj", "-o", name, "-q", "--size", "64x64", "--smooth", smooth]);
    };
    render("flat.png", "off");
    render("creased.png", "14");
    render("smooth.png", "30");
    assert_eq!(place.read("flat.png"), place.read("creased.png"));
    let apart = place.run(&["compare", "flat.png", "smooth.png", "--max-rmse", "0.003"]);
    assert_eq!(apart.code, Some(1), "{apart:?}");
}

#[test]
fn a_variable_turns_it_off_and_verbose_runs_count() {
    let place = Place::new();
    column(&place);
    let notes = |variable: Option<&str>, flags: &[&str]| {
        let base = ["render", "column.obj", "-o", "a.png", "-v", "--size", "8x8"];
        let mut command = place.command(&[&base, flags].concat());
        if let Some(value) = variable {
            command.env("LIGHTMESH_SMOOTH", value);
        }
        let done = command.output().unwrap();
        assert!(done.status.success(), "{done:?}");
        String::from_utf8(done.stderr).unwrap()
    };
    let note = "smooth 30: made 48 normals (--smooth off shows facets)\n";
    assert!(notes(None, &[]).contains(note));
    assert!(!notes(Some("off"), &[]).contains("smooth"));
    assert!(notes(Some("off"), &["--smooth", "30"]).contains(note));
}

#[test]
fn what_is_exported_has_the_normals_and_gives_the_same_picture() {
    let place = Place::new();
    column(&place);
    let render = |scene: &str, name: &str, smooth: &str| {
        place.good(&["render", scene, "-o", name, "-q", "--size", "32x32", "--light", "3,5,2;0.9", "--smooth", smooth]);
    };
    render("column.obj", "smooth.exr", "30");
    render("column.obj", "flat.exr", "off");
    for (flags, picture, normals) in [(&[][..], "smooth.exr", 48), (&["--smooth", "off"], "flat.exr", 0)] {
        for name in ["copy.glb", "copy.toml"] {
            let done = place.good(&[&["export", "column.obj", "-o", name][..], flags].concat());
            let said = format!("column, 48 triangles, 48 smooth normals: {name}\n");
            assert_eq!(done.stderr == said, normals > 0, "{done:?}");
            let info: serde_json::Value = serde_json::from_str(&place.good(&["info", name, "--json"]).stdout).unwrap();
            assert_eq!([&info["normals"], &info["smooth_normals"]], [normals, 0], "{name}");
            render(name, "copy.exr", "30");
            place.good(&["compare", picture, "copy.exr", "--max-rmse", "1e-6"]);
        }
    }
}

#[test]
fn info_counts_normals() {
    let place = Place::new();
    column(&place);
    let people = |flags: &[&str]| place.good(&[&["info", "column.obj"], flags].concat()).stdout;
    assert!(people(&[]).contains("normals 48, 48 of them made from the triangles\n"), "{}", people(&[]));
    assert!(!people(&["--smooth", "off"]).contains("normals"));
}

#[test]
fn what_is_no_angle_is_refused() {
    let place = Place::new();
    column(&place);
    for value in ["-1", "0", "181", "nan", "on"] {
        for command in [
            &["render", "column.obj", "-o", "a.png"][..],
            &["info", "column.obj"],
            &["export", "column.obj", "-o", "a.glb"],
            &["bench", "rays"],
        ] {
            let refused = place.refused(&[command, &["--smooth", value]].concat());
            assert!(refused.contains("--smooth") && refused.contains(value), "{refused}");
        }
    }
}

#[test]
fn normals_that_do_not_fit_into_memory_are_refused_with_the_flags() {
    let place = Place::new();
    // Bumps: without normals there is enough memory for them.
    let mut text = String::from("ply\nformat ascii 1.0\nelement vertex 90000\n");
    text.push_str("property float x\nproperty float y\nproperty float z\nelement face 178802\n");
    text.push_str("property list uchar int vertex_indices\nend_header\n");
    let at = |x: u32, y: u32| x + 300 * y;
    for (x, y) in (0..300).flat_map(|y| (0..300).map(move |x| (x, y))) {
        writeln!(text, "{x} {} {y}", (x + y) % 2).unwrap();
    }
    for (x, y) in (0..299).flat_map(|y| (0..299).map(move |x| (x, y))) {
        let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        writeln!(text, "3 {a} {c} {b}\n3 {a} {d} {c}").unwrap();
    }
    place.write("bumps.ply", &text);
    let info =
        |limit: &str, smooth: &str| place.run(&["info", "bumps.ply", "--memory-limit", limit, "--smooth", smooth]);
    let refused = info("42M", "90");
    assert_eq!(refused.code, Some(3), "{refused:?}");
    assert!(refused.stderr.contains("not enough memory for smooth normals of 178802 triangles"), "{refused:?}");
    assert!(refused.stderr.ends_with("(--memory-limit, --smooth off)\n"), "{refused:?}");
    assert_eq!(info("42M", "off").code, Some(0), "{:?}", info("42M", "off"));
    assert_eq!(info("1G", "90").code, Some(0));
}
