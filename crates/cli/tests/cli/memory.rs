//! The end of memory: exit code 3, one line with what, how much and the flag, and no file.

use std::fmt::Write as _;
use std::fs::File;

use crate::run::{Done, Place};

/// An uncompressed TGA image that says it has 16384 by 16384 texels, with enough bytes to be believed.
fn large_picture(place: &Place) {
    let mut bytes = vec![0; 33_000];
    (bytes[2], bytes[16]) = (2, 24);
    bytes[12..16].copy_from_slice(&[0, 64, 0, 64]);
    std::fs::write(place.path("large.tga"), bytes).unwrap();
    place.write("large.mtl", "newmtl a\nmap_Kd large.tga\n");
    place.write("large.obj", "mtllib large.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
}

/// A triangle in a buffer that is said to have `length` bytes, in a file of three gigabytes, most of which are a hole.
fn triangle_in_a_large_file(place: &Place, length: u64) {
    let positions: Vec<u8> =
        [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(place.path("large.bin"), positions).unwrap();
    File::options().write(true).open(place.path("large.bin")).unwrap().set_len(3 << 30).unwrap();
    place.write(
        "large.gltf",
        &format!(
            r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}], "buffers": [{{"uri": "large.bin", "byteLength": {length}}}]}}"#
        ),
    );
}

fn many_meshes(place: &Place) {
    let mut strip = String::new();
    for x in 0..500 {
        writeln!(strip, "v {x} 0 0\nv {x} 1 0").unwrap();
    }
    for first in 1..998 {
        writeln!(strip, "f {first} {} {}", first + 1, first + 2).unwrap();
    }
    place.write("strip.obj", &strip);
    place.write("many.toml", &"[[mesh]]\nfile = \"strip.obj\"\n".repeat(3000));
}

fn render(place: &Place, scene: &str, flags: &[&str]) -> Done {
    place.run(&[&["render", scene, "-o", "a.png", "-q"], flags].concat())
}

/// Checks how a run ended whose task needs too much.
fn assert_refused(place: &Place, done: &Done, what: &str) {
    assert_eq!(done.code, Some(3), "{what}: {done:?}");
    let line = done.stderr.lines().last().unwrap();
    let start = format!("error: there is not enough memory for {what}");
    assert!(line.starts_with(&start) && line.contains("--memory-limit"), "{what}: {line}");
    assert!(line.contains("iB"), "how much: {line}");
    assert!(!place.files().iter().any(|name| name.starts_with("a.png")), "{:?}", place.files());
}

#[test]
fn what_a_file_says_is_checked_before_it_is_allocated() {
    let place = Place::new();
    large_picture(&place);
    assert_refused(
        &place,
        &render(&place, "large.obj", &["--memory-limit", "256M"]),
        "a texture of 16384x16384 texels",
    );
    triangle_in_a_large_file(&place, 3 << 30);
    assert_refused(&place, &render(&place, "large.gltf", &["--memory-limit", "1G"]), "the file: 3.0 GiB");
    many_meshes(&place);
    assert_refused(&place, &render(&place, "many.toml", &["--memory-limit", "64M"]), "");
}

#[test]
fn no_more_of_a_file_is_read_than_is_used() {
    let place = Place::new();
    triangle_in_a_large_file(&place, 36);
    let done = render(&place, "large.gltf", &["--memory-limit", "128M", "--size", "64x64"]);
    assert_eq!(done.code, Some(0), "{done:?}");
}

#[test]
fn what_settings_ask_for_is_checked_before_it_is_allocated() {
    let place = Place::new();
    let limited = |flags: &[&str]| render(&place, "room.toml", &[flags, &["--memory-limit", "200M"]].concat());
    assert_refused(&place, &limited(&["--grid", "500x500x500"]), "a grid of 500x500x500 cells");
    assert_refused(&place, &limited(&["--size", "60000x60000"]), "the image");
    let built =
        place.run(&["grid", "room.toml", "-o", "a.png.grid", "--grid", "500x500x500", "--memory-limit", "200M"]);
    assert_refused(&place, &built, "a grid of 500x500x500 cells");
}

/// What nobody can foresee: how much a parser needs.
#[test]
fn what_cannot_be_foreseen_ends_before_the_limit() {
    let place = Place::new();
    place.write("long.toml", &"[[material]]\nname = \"a\"\nkd = [0.5, 0.5, 0.5]\n".repeat(100_000));
    place.write(
        "long.gltf",
        &format!(r#"{{"asset": {{"version": "2.0"}}, "nodes": [{}{{}}]}}"#, "{},".repeat(1_500_000)),
    );
    for scene in ["long.toml", "long.gltf"] {
        for command in ["render", "info"] {
            let more: &[&str] = if command == "render" { &["-o", "a.png"] } else { &[] };
            let done = place.run(&[&[command, scene, "--memory-limit", "80M"], more].concat());
            assert_refused(&place, &done, &format!("reading {scene}"));
        }
    }
}

/// The same where the system's limit is lower than that of the program, or the only one.
#[test]
#[cfg(target_os = "linux")]
fn the_limit_of_the_address_space_is_seen() {
    let place = Place::new();
    place.write("long.toml", &"[[material]]\nname = \"a\"\nkd = [0.5, 0.5, 0.5]\n".repeat(200_000));
    large_picture(&place);
    let script = "ulimit -v 400000; exec \"$0\" \"$@\"";
    for (scene, size, what) in [
        ("long.toml", "64x64", "reading long.toml"),
        ("large.obj", "64x64", "a texture of 16384x16384 texels"),
        ("room.toml", "16384x16384", "the image"),
    ] {
        let args = ["render", scene, "-o", "a.png", "--size", size, "-q", "--threads", "1"];
        let done: Done = place.shell(script, &args).output().unwrap().into();
        assert_refused(&place, &done, what);
    }
}

/// What is set aside is what it takes: not more for a panorama than its texels with all that is made of them, nor for the light that one pixel gathers
/// than for that of many.
#[test]
fn what_takes_little_fits() {
    let place = Place::new();
    let mut panorama = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1024 +X 2048\n".to_vec();
    panorama.resize(panorama.len() + 4 * 2048 * 1024, 128);
    std::fs::write(place.path("sky.hdr"), panorama).unwrap();
    let pixel = ["--size", "1x1", "--aa", "1", "--memory-limit"];
    for flags in [&["--environment", "sky.hdr", "--ambient-light", "constant", "110M"][..], &["--sky", "clear", "100M"]]
    {
        let [flags @ .., limit] = flags else { unreachable!() };
        let done = render(&place, "room.toml", &[flags, &pixel, &[*limit]].concat());
        assert_eq!(done.code, Some(0), "{flags:?}: {done:?}");
    }
}
