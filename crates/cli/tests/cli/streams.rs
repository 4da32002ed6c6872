//! Images on standard output, and scenes on standard input.

use std::fs::{self, File};
use std::io::Write;
use std::process::{Output, Stdio};

use lightmesh::image::Frame;
use serde_json::Value;

use crate::run::{LAMP, Place};

/// Runs a command with this standard input.
fn fed(place: &Place, args: &[&str], input: &[u8]) -> Output {
    let mut command = place.command(args);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // A program that refuses does not read.
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}

const SMALL: [&str; 6] = ["--size", "24x16", "--light", LAMP, "--progress", "json"];

#[test]
fn an_image_on_standard_output_is_all_that_is_there() {
    let place = Place::new();
    for format in ["bmp", "png", "exr", "jpg"] {
        let name = format!("a.{format}");
        place.good(&[&["render", "room.toml", "-o", &name][..], &SMALL].concat());
        let flags = ["-o", "-", "--format", format, "-v", "--stats", "s.json", "--layers", "l.exr"];
        let done = place.command(&[&["render", "room.toml"], &flags[..], &SMALL].concat()).output().unwrap();
        assert!(done.status.success(), "{done:?}");
        assert!(done.stdout == place.read(&name), "{format}");
        assert!(String::from_utf8(done.stderr).unwrap().contains("standard output"));
        assert_eq!(place.json("s.json")["settings"]["size"], serde_json::json!([24, 16]));
    }
    assert_eq!(Frame::load(place.path("l.exr")).unwrap().width(), 24);
}

#[test]
fn standard_output_needs_a_format_and_takes_one_output() {
    let place = Place::new();
    let refused = |flags: &[&str]| place.refused(&[&["render", "room.toml"], flags].concat());
    assert_eq!(refused(&["-o", "-"]), "error: -o - needs the format of the image; add --format bmp, png, exr or jpg");
    let both = "error: -o and --stats both go to standard output; send one of them to a file";
    for stats in ["-", "/dev/stdout"] {
        assert_eq!(refused(&["-o", "-", "--format", "png", "--stats", stats]), both);
        assert_eq!(refused(&["-o", "/dev/stdout", "--format", "png", "--stats", stats]), both);
    }
    assert!(refused(&["-o", "-", "--format", "png", "--layers", "-"]).contains("-o and --layers both go to standard"));
    assert!(refused(&["-o", "-", "--format", "jpg", "--bit-depth", "16"]).contains("cannot save standard output"));
    assert!(refused(&["-o", "a.xyz"]).ends_with("(--format)"));
}

#[test]
fn statistics_and_layers_go_to_standard_output_as_well() {
    let place = Place::new();
    let render =
        |flags: &[&str]| place.command(&[&["render", "room.toml", "-o", "a.png"], flags, &SMALL].concat()).output();
    let stats = render(&["--stats", "-"]).unwrap().stdout;
    assert_eq!(serde_json::from_slice::<Value>(&stats).unwrap()["settings"]["size"], serde_json::json!([24, 16]));
    assert_eq!(Frame::decode(&render(&["--layers", "-"]).unwrap().stdout).unwrap().width(), 24);
}

#[test]
fn a_format_overrides_the_extension() {
    let place = Place::new();
    place.good(&[&["render", "room.toml", "-o", "a.exr"][..], &SMALL].concat());
    for name in ["image", "image.png", "./-"] {
        place.good(&[&["render", "room.toml", "-o", name, "--format", "exr"][..], &SMALL].concat());
        assert!(place.read(name) == place.read("a.exr"), "{name}");
    }
    let warned = |name: &str, format: &str| {
        let done = place.good(&["render", "room.toml", "-o", name, "--format", format, "--size", "24x16"]);
        done.stderr.lines().find(|line| line.starts_with("warning: ")).map(str::to_owned)
    };
    let expected = "warning: -o o.exr is a png file, as --format says, but its extension is that of exr files; name it o.png, or leave \
                    out --format";
    assert_eq!(warned("o.exr", "png").as_deref(), Some(expected));
    for (name, format) in [("o.png", "png"), ("o.JPEG", "jpg"), ("o", "png"), ("o.data", "exr")] {
        assert_eq!(warned(name, format), None, "{name}");
    }
    place.good(&["compare", "a.exr", "image.png", "--max-rmse", "0"]);
}

#[cfg(target_os = "linux")]
#[test]
fn terminals_get_no_bytes_and_have_no_scene() {
    let place = Place::new();
    for output in ["-", "/dev/stdout"] {
        let args = ["render", "room.toml", "-o", output, "--format", "png", "--color", "never"];
        let (code, shown) = place.on_terminal(place.command(&args));
        assert_eq!(code, Some(2), "{shown}");
        assert!(shown.starts_with("error: -o would write binary data to the terminal; redirect"), "{shown}");
    }
    let (_, shown) = place.on_terminal(place.command(&["export", "room.toml", "-o", "-"]));
    assert!(shown.contains("binary data to the terminal"), "{shown}");
    let (code, shown) = place.on_terminal(place.command(&["info", "-", "--scene-format", "obj"]));
    assert!(code == Some(2) && shown.contains("standard input is a terminal"), "{shown}");
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn scenes_of_all_formats_come_from_standard_input() {
    let place = Place::new();
    place.write("t.obj", TRIANGLE);
    place.good(&["export", "t.obj", "-o", "t.glb"]);
    let corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    place.write("t.stl", &format!("solid t\nfacet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\nendsolid t\n"));
    place.write(
        "t.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    );
    place.write("t.toml", "[[mesh]]\nfile = \"t.obj\"\n");
    for format in ["obj", "glb", "stl", "ply", "toml"] {
        let name = format!("t.{format}");
        let input = place.read(&name);
        let info = |args: &[&str]| {
            let text = fed(&place, &[&["info", "--json"], args].concat(), &input).stdout;
            serde_json::from_slice::<Value>(&text).unwrap_or_else(|_| panic!("{args:?}"))
        };
        assert_eq!(info(&["-", "--scene-format", format]), info(&[&name]), "{format}");
        // STL has another axis up.
        let flags = ["--size", "16x12", "-q", "--mode", "ray-trace"];
        place.good(&[&["render", &name, "-o", "a.bmp"][..], &flags].concat());
        let piped = ["render", "-", "--scene-format", format, "-o", "b.bmp"];
        assert!(fed(&place, &[&piped[..], &flags].concat(), &input).status.success(), "{format}");
        assert!(place.read("a.bmp") == place.read("b.bmp"), "{format}");
    }
    let grid = fed(&place, &["grid", "-", "--scene-format", "obj", "-o", "t.grid"], TRIANGLE.as_bytes());
    assert!(
        grid.status.success() && String::from_utf8(grid.stderr).unwrap().starts_with("standard input, 1 triangles")
    );
    assert!(place.read("t.grid").starts_with(b"LM GRID\0"));
}

#[test]
fn an_export_is_piped_into_a_render() {
    let place = Place::new();
    let script = "\"$0\" export room.toml -o - -q | \"$0\" render - --scene-format glb \"$@\"";
    let done = place.shell(script, &[&["-o", "piped.png"][..], &SMALL].concat()).output().unwrap();
    assert!(done.status.success(), "{done:?}");
    place.good(&["export", "room.toml", "-o", "room.glb", "-q"]);
    place.good(&[&["render", "room.glb", "-o", "file.png"][..], &SMALL].concat());
    place.good(&["compare", "file.png", "piped.png", "--max-rmse", "0"]);
}

#[test]
fn a_scene_on_standard_input_obeys_the_same_rules() {
    let place = Place::new();
    place.write("t.obj", TRIANGLE);
    fs::create_dir(place.path("sub")).unwrap();
    let refused = |args: &[&str], input: &str| {
        let done = fed(&place, args, input.as_bytes());
        assert_eq!((done.status.code(), done.stdout.len()), (Some(2), 0), "{args:?}");
        String::from_utf8(done.stderr).unwrap()
    };
    let message = refused(&["info", "-"], TRIANGLE);
    assert!(message.contains("needs its format; add --scene-format toml, obj, gltf, glb, ply, stl"), "{message}");
    let message = refused(&["info", "-", "--scene-format", "obj"], "v 0 0\n");
    assert!(message.contains(", standard input:1;"), "{message}");
    let message = refused(&["info", "-", "--scene-format", "toml"], "[[mesh]]\nfile = \"/etc/passwd.obj\"\n");
    assert!(message.contains("--allow-outside"), "{message}");
    let strict = ["info", "-", "--scene-format", "obj", "--strict"];
    assert!(refused(&strict, "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").contains("none.mtl"));
    // The file that standard input comes from.
    let mut grid = place.command(&["grid", "-", "--scene-format", "obj", "-o", "t.obj"]);
    let done = grid.stdin(File::open(place.path("t.obj")).unwrap()).output().unwrap();
    assert_eq!(done.status.code(), Some(2));
    assert!(String::from_utf8(done.stderr).unwrap().contains("the scene and -o are the same file"));
    assert_eq!(place.read("t.obj"), TRIANGLE.as_bytes());
}

#[cfg(target_os = "linux")]
#[test]
fn endless_standard_input_ends_with_the_memory() {
    let place = Place::new();
    let args = ["info", "-", "--scene-format", "obj", "--memory-limit", "100M"];
    let done = place.command(&args).stdin(File::open("/dev/zero").unwrap()).output().unwrap();
    assert_eq!(done.status.code(), Some(3), "{done:?}");
    let message = String::from_utf8(done.stderr).unwrap();
    assert!(message.contains("standard input") && message.contains("--memory-limit"), "{message}");
}
