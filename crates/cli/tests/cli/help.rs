//! Help, completions, the manual, and standard output that is closed early.

use std::process::Stdio;

use crate::run::{Done, Place};

/// The flags of `render` that other programs rely on.
const FLAGS: [&str; 54] = [
    "--mode",
    "--bounces",
    "--size",
    "--device",
    "--threads",
    "--step",
    "--radius",
    "--weight",
    "--lookup",
    "--samples",
    "--accel",
    "--grid",
    "--grid-file",
    "--mesh-file",
    "--camera",
    "--camera-name",
    "--up",
    "--light",
    "--falloff",
    "--smooth",
    "--instances",
    "--ambient",
    "--layers",
    "--transfer",
    "--exposure",
    "--view",
    "--bit-depth",
    "--dither",
    "--exr-type",
    "--exr-compression",
    "--exr-parts",
    "--background",
    "--partial",
    "--allow-outside",
    "--strict",
    "--seed",
    "--stats",
    "--progress",
    "--quiet",
    "--memory-limit",
    "--short-tests",
    "--output",
    "--help",
    "--crop",
    "--ground",
    "--turntable",
    "--sun",
    "--sun-hours",
    "--animation",
    "--frames",
    "--fps",
    "--resume",
    "--skip-existing",
    "--overwrite",
];

#[test]
fn help_and_manual_know_every_flag() {
    let place = Place::new();
    let help = place.good(&["render", "--help"]).stdout;
    let manual = place.good(&["man", "render"]).stdout.replace("\\-", "-");
    for flag in FLAGS {
        let known =
            |text: &str| text.split([' ', '\n', ',', '\\']).any(|word| word == flag || word == format!("fB{flag}"));
        assert!(known(&help), "{flag} in {help}");
        assert!(known(&manual), "{flag} in {manual}");
    }
    for default in ["light-mesh", "1024x1024", "auto", "smooth", "area 225, half-ball 4", "2.1", "srgb"] {
        let stated = help.lines().any(|line| line.contains("default: ") && line.contains(default));
        assert!(stated, "default {default} in {help}");
    }
}

#[test]
fn the_manual_has_a_page_for_each_subcommand() {
    let place = Place::new();
    let page = place.good(&["man"]).stdout;
    assert!(page.contains(".TH lightmesh 1") && page.contains("lightmesh\\-render(1)"), "{page}");
    std::fs::create_dir(place.path("man")).unwrap();
    place.good(&["man", "-o", "man"]);
    for name in [
        "lightmesh",
        "lightmesh-render",
        "lightmesh-info",
        "lightmesh-compare",
        "lightmesh-grid",
        "lightmesh-export",
        "lightmesh-bench",
    ] {
        assert!(place.read(&format!("man/{name}.1")).len() > 200, "{name}");
    }
    assert!(place.refused(&["man", "paint"]).contains("unknown subcommand `paint`; available: render, info"));
    assert!(place.refused(&["man", "-o", "none"]).contains("the directory none does not exist"));
}

#[test]
fn shells_complete_flags() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = place.good(&["completions", shell]).stdout;
        assert!(script.contains("memory-limit"), "{shell}");
    }
    place.refused(&["completions", "cmd"]);
}

#[test]
fn a_variable_sets_a_flag_unless_the_flag_is_given() {
    let place = Place::new();
    let size = |flags: &[&str]| {
        let base = ["render", "room.toml", "-o", "a.png", "-q", "--stats", "s.json"];
        let run = place.command(&[&base, flags].concat()).env("LIGHTMESH_SIZE", "9x7").output().unwrap();
        assert!(run.status.success(), "{run:?}");
        place.json("s.json")["settings"]["size"].clone()
    };
    assert_eq!(size(&[]), serde_json::json!([9, 7]));
    assert_eq!(size(&["--size", "8x8"]), serde_json::json!([8, 8]));
}

#[test]
fn variables_turn_flags_on_and_off() {
    let place = Place::new();
    place.write("odd.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nmtllib none.mtl\n");
    let strict = |text: &str| {
        let render = ["render", "odd.obj", "-o", "a.png", "--size", "8x6", "--device", "cpu"];
        Done::from(place.command(&render).env("LIGHTMESH_STRICT", text).output().unwrap())
    };
    for off in ["0", "no", "False", "off", ""] {
        assert_eq!(strict(off).code, Some(0), "{off}");
    }
    for on in ["1", "yes", "true", "ON"] {
        let done = strict(on);
        assert!(done.code == Some(2) && done.stderr.contains("(LIGHTMESH_STRICT)"), "{on}: {done:?}");
    }
    let odd = strict("perhaps");
    assert!(odd.code == Some(2) && odd.stderr.contains("'perhaps' for 'LIGHTMESH_STRICT': write 1, yes"), "{odd:?}");
}

#[test]
fn errors_name_the_variable_that_a_value_comes_from() {
    let place = Place::new();
    let render = |variables: &[(&str, &str)], flags: &[&str]| {
        let all = [&["render", "room.toml", "-o", "a.png", "--device", "cpu", "--size", "8x6"], flags].concat();
        Done::from(place.command(&all).envs(variables.iter().copied()).output().unwrap())
    };
    for (name, text) in [("LIGHTMESH_QUALITY", "best"), ("LIGHTMESH_AA", "0"), ("LIGHTMESH_CAMERA", "here")] {
        let done = render(&[(name, text)], &[]);
        let expected = format!("'{text}' for '{name}'");
        assert!(done.code == Some(2) && done.stderr.contains(&expected), "{name}: {done:?}");
        assert_eq!(render(&[(name, "")], &[]).code, Some(0), "an empty variable is none");
    }
    let typed = render(&[("LIGHTMESH_QUALITY", "draft")], &["--quality", "best"]);
    assert!(typed.stderr.contains("'best' for '--quality <"), "{typed:?}");
    let both = render(&[("LIGHTMESH_STUDIO", "1")], &["--no-studio"]);
    assert!(both.code == Some(2) && both.stderr.contains("'LIGHTMESH_STUDIO'"), "{both:?}");
    assert_eq!(render(&[("LIGHTMESH_STUDIO", "no")], &["--no-studio"]).code, Some(0));
}

#[test]
fn usage_errors_and_versions() {
    let place = Place::new();
    assert_eq!(place.run(&[]).code, Some(2));
    place.refused(&["paint"]);
    place.refused(&["render", "room.toml"]);
    place.refused(&["render", "room.toml", "-o", "a.png", "--sise", "1x1"]);
    let version = place.good(&["--version"]).stdout;
    assert!(version.starts_with(concat!("lightmesh ", env!("CARGO_PKG_VERSION"), " (")), "{version}");
    assert!(version.ends_with("kernels for CUDA 12.0 or newer)\n"), "{version}");
}

#[cfg(unix)]
#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let place = Place::new();
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let status = place.command(&["completions", "bash"]).stdout(writer).stderr(Stdio::piped()).output().unwrap();
    assert_eq!((status.status.code(), status.stderr.len()), (Some(0), 0));
}
