//! What is written where: through pipes and links, with which permissions, never over an input or another output.

use std::fs;
use std::io::Read;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Stdio};

use lightmesh::image::Frame;
use serde_json::Value;

use crate::run::{Done, Place, text};

/// Renders a small image from a shell.
fn run(place: &Place, script: &str, flags: &[&str]) -> Done {
    let small = ["render", "room.toml", "--size", "16x16", "-q"];
    place.shell(script, &[&small, flags].concat()).output().unwrap().into()
}

fn pipe(place: &Place, name: &str) {
    assert!(Command::new("mkfifo").arg(place.path(name)).status().unwrap().success());
}

#[test]
fn standard_output_is_written_through() {
    let place = Place::new();
    let stats = |text: &str| serde_json::from_str::<Value>(text).unwrap()["settings"]["size"].clone();
    let flags = ["-o", "a.png", "--stats", "/dev/stdout"];
    assert_eq!(stats(&run(&place, "\"$0\" \"$@\" | cat", &flags).stdout), serde_json::json!([16, 16]));
    // A file that standard output goes to keeps what it has, and gets what follows.
    run(&place, "(echo before; \"$0\" \"$@\"; echo after) > log", &flags);
    let log = String::from_utf8(place.read("log")).unwrap();
    let json = log.strip_prefix("before\n").and_then(|rest| rest.strip_suffix("after\n")).unwrap();
    assert_eq!(stats(json), serde_json::json!([16, 16]));
    run(&place, "echo 1 > log; \"$0\" \"$@\" >> log", &flags);
    assert!(place.read("log").starts_with(b"1\n{"));
    run(&place, "echo 2 > log; \"$0\" \"$@\" 3>> log", &["-o", "a.png", "--stats", "/dev/fd/3"]);
    assert!(place.read("log").starts_with(b"2\n{"));
    assert_eq!(place.files(), ["a.png", "log", "room.toml"]);
}

#[test]
fn rows_on_standard_output_are_all_that_is_there() {
    let place = Place::new();
    let flags = ["--quick", "--budget", "0.001s", "--device", "cpu", "--json", "/dev/stdout"];
    let done = place.good(&[&["bench", "thesis"], &flags[..]].concat());
    assert_eq!(serde_json::from_str::<Value>(&done.stdout).unwrap()["suite"], "thesis");
}

#[test]
fn pipes_and_devices_stay_what_they_are() {
    let place = Place::new();
    pipe(&place, "pipe.png");
    let mut reader = Command::new("cat").arg(place.path("pipe.png")).stdout(Stdio::piped()).spawn().unwrap();
    let done = run(&place, "\"$0\" \"$@\"", &["-o", "pipe.png", "--stats", "/dev/null"]);
    assert_eq!((done.code, done.stderr.as_str()), (Some(0), ""));
    let mut bytes = Vec::new();
    reader.stdout.take().unwrap().read_to_end(&mut bytes).unwrap();
    reader.wait().unwrap();
    assert_eq!(Frame::decode(&bytes).unwrap().width(), 16);
    assert!(!fs::metadata("/dev/null").unwrap().is_file() && !fs::metadata(place.path("pipe.png")).unwrap().is_file());
    assert_eq!(place.files(), ["pipe.png", "room.toml"]);
}

#[test]
fn links_are_followed_also_to_files_that_do_not_exist() {
    let place = Place::new();
    fs::create_dir(place.path("sub")).unwrap();
    symlink("sub/new.png", place.path("dangling.png")).unwrap();
    place.write("old.json", "");
    symlink("old.json", place.path("link.json")).unwrap();
    let done = run(&place, "\"$0\" \"$@\"", &["-o", "dangling.png", "--stats", "link.json"]);
    assert_eq!(done.code, Some(0), "{done:?}");
    assert_eq!(Frame::load(place.path("sub/new.png")).unwrap().width(), 16);
    assert!(place.json("old.json")["version"].is_u64());
    for (link, file) in [("dangling.png", "sub/new.png"), ("link.json", "old.json")] {
        assert_eq!(fs::read_link(place.path(link)).unwrap(), Path::new(file));
    }
}

#[test]
fn an_existing_file_keeps_its_mode_and_a_new_one_obeys_the_umask() {
    let place = Place::new();
    let mode = |name: &str| fs::metadata(place.path(name)).unwrap().permissions().mode() & 0o7777;
    place.write("a.json", "");
    fs::set_permissions(place.path("a.json"), fs::Permissions::from_mode(0o664)).unwrap();
    for (umask, new) in [("077", 0o600), ("027", 0o640), ("000", 0o666)] {
        let _ = fs::remove_file(place.path("a.png"));
        run(&place, &format!("umask {umask}; \"$0\" \"$@\""), &["-o", "a.png", "--stats", "a.json"]);
        assert_eq!((mode("a.png"), mode("a.json")), (new, 0o664));
    }
}

/// An output that cannot be stored is found late; no other output appears then.
#[test]
fn outputs_appear_together_or_not_at_all() {
    let place = Place::new();
    // As on a full disk: files cannot be larger than 4 or 8 KiB.
    let limited = "ulimit -f 8; \"$0\" \"$@\"";
    let large = ["render", "room.toml", "-o", "a.bmp", "--size", "128x128", "--stats", "a.json", "-q"];
    let done = Done::from(place.shell(limited, &large).output().unwrap());
    assert_eq!(done.code, Some(2), "{done:?}");
    assert!(done.stderr.starts_with("error: cannot save a.bmp: ") && done.stderr.contains("; nothing was written; "));
    assert_eq!(place.files(), ["room.toml"]);
    if cfg!(target_os = "linux") {
        let done = run(&place, "\"$0\" \"$@\"", &["-o", "a.png", "--stats", "/dev/full"]);
        assert!(done.stderr.contains("cannot write /dev/full: ") && done.stderr.contains("; nothing was written"));
        assert_eq!((done.code, place.files()), (Some(2), vec!["room.toml".to_owned()]));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_in_which_nothing_can_be_created_is_found_before_rendering() {
    let place = Place::new();
    for flags in [
        &["render", "room.toml", "-o", "/proc/a.png", "--mode", "area", "--size", "8000x8000"][..],
        &["render", "room.toml", "-o", "a.png", "--mode", "area", "--size", "8000x8000", "--stats", "/proc/a.json"],
        &["bench", "thesis", "--json", "/proc/a.json"],
        &["bench", "thesis", "--report", "/proc/report"],
        &["grid", "builtin:garden", "-o", "/proc/a.grid"],
        &["export", "builtin:garden", "-o", "/proc/a.glb"],
    ] {
        let message = place.refused(flags);
        assert!(message.contains(": no file can be created in /proc ("), "{message}");
    }
}

/// Scenes of all formats that refer to files, in the folder of the room, and results of a suite.
fn scenes() -> Place {
    let place = Place::new();
    let pixel = Frame::new(1, 1, vec![[0.5; 3]]).unwrap();
    for name in ["oak.png", "bump.png", "sky.png", "part.png", "shot.png", "other.png"] {
        pixel.save(place.path(name)).unwrap();
    }
    place.write("o.obj", "mtllib o.mtl\nusemtl oak\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    place.write("o.mtl", "newmtl oak\nmap_Kd oak.png\nmap_Bump -bm 2 bump.png\nnewmtl unused\nmap_Kd sky.png\n");
    let header = "ply\nformat ascii 1.0\ncomment TextureFile part.png\nelement vertex 3\nproperty float x\n\
                  property float y\nproperty float z\nproperty float s\nproperty float t\nelement face 1\n\
                  property list uchar int vertex_indices\nend_header\n";
    place.write("p.ply", &format!("{header}0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"));
    place.write(
        "t.toml",
        "[[material]]\nname = \"sky\"\ntexture = \"sky.png\"\n[[mesh]]\nfile = \"o.obj\"\n[[mesh]]\nfile = \"p.ply\"\n",
    );
    fs::write(place.path("s.bin"), [0f32, 0., 0., 1., 0., 0., 0., 1., 0.].map(f32::to_le_bytes).as_flattened())
        .unwrap();
    let gltf = serde_json::json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "s.bin", "byteLength": 36}],
        "images": [{"uri": "oak.png"}],
    });
    place.write("s.gltf", &gltf.to_string());
    place.good(&["export", "o.obj", "-o", "a.mesh.glb", "-q"]);
    place.good(&["grid", "room.toml", "-o", "room.grid", "-q"]);
    place
}

/// Every subcommand that writes files, with every kind of file it must keep: the arguments up to the output, and what it would
/// overwrite.
#[test]
fn no_output_overwrites_an_input() {
    let place = scenes();
    let render = ["render", "--size", "8x8"];
    let with = |base: &[&'static str], scene: &'static str, flag: &'static str| [base, &[scene, flag]].concat();
    let bench = ["bench", "rays", "--quick", "--budget", "0.001s", "--device", "cpu", "--scene"];
    let mut cases: Vec<(Vec<&str>, &str)> = Vec::new();
    for (scene, files) in [
        ("o.obj", &["o.obj", "o.mtl", "oak.png", "bump.png", "sky.png"][..]),
        ("p.ply", &["p.ply", "part.png"]),
        ("s.gltf", &["s.gltf", "s.bin", "oak.png"]),
        ("t.toml", &["t.toml", "sky.png", "o.obj", "o.mtl", "oak.png", "p.ply", "part.png"]),
    ] {
        for file in files {
            cases.push((with(&["render", "--size", "8x8", "-o", "new.png"], scene, "--stats"), file));
            cases.push((with(&["grid"], scene, "-o"), file));
            cases.push((with(&bench, scene, "--json"), file));
            if file.ends_with(".png") {
                cases.push((with(&render, scene, "-o"), file));
            }
        }
    }
    cases.push((vec!["render", "room.toml", "--grid-file", "room.grid", "-o", "new.png", "--stats"], "room.grid"));
    cases.push((with(&["export"], "t.toml", "-o"), "t.toml"));
    cases.push((with(&["export"], "a.mesh.glb", "-o"), "a.mesh.glb"));
    cases.push((vec!["compare", "shot.png", "other.png", "--diff"], "shot.png"));
    cases.push((vec!["compare", "shot.png", "other.png", "--diff"], "other.png"));
    for (args, file) in cases {
        let before = place.read(file);
        for name in [file.to_owned(), format!("./{file}"), text(&place.path(file)).to_owned()] {
            let message = place.refused(&[&args[..], &[&name]].concat());
            assert!(message.contains(" are the same file, "), "{args:?} {name}: {message}");
        }
        assert!(place.read(file) == before, "{args:?} {file}");
    }
    // The triangles next to a TOML scene.
    let message = place.refused(&["export", "a.mesh.glb", "-o", "a.toml"]);
    assert!(message.contains("the scene and the triangles of -o are the same file"), "{message}");
}

#[test]
fn no_folder_that_is_filled_has_an_input() {
    let place = scenes();
    fs::create_dir_all(place.path("out/plots")).unwrap();
    fs::create_dir(place.path("a-pictures")).unwrap();
    for folder in ["out/plots", "a-pictures"] {
        fs::copy(place.path("p.ply"), place.path(folder).join("p.ply")).unwrap();
    }
    let bench = ["bench", "quality", "--quick", "--device", "cpu"];
    let message = place.refused(&[&bench[..], &["--scene", "out/plots/p.ply", "--report", "out"]].concat());
    assert!(message.contains("is in a folder that --report fills, out/plots"), "{message}");
    let flags = ["--scene", "a-pictures/p.ply", "--json", "a.json", "--pictures"];
    let message = place.refused(&[&bench[..], &flags].concat());
    assert!(message.contains("is in a folder that --pictures fills, a-pictures"), "{message}");
    let message = place.refused(&[&bench[..], &["--json", "out/report.md", "--report", "out"]].concat());
    assert!(message.contains("--json and --report are the same file"), "{message}");

    let flags = ["--budget", "0.001s", "--json", "out/report.md"];
    place.good(&[&["bench", "thesis", "--quick", "--device", "cpu"], &flags[..]].concat());
    let message = place.refused(&["report", "out/report.md", "-o", "out"]);
    assert!(message.contains("BENCH.json and -o are the same file"), "{message}");
}

#[test]
fn links_do_not_hide_that_files_are_the_same() {
    let place = scenes();
    symlink("new.json", place.path("symbolic.png")).unwrap();
    symlink("oak.png", place.path("image.png")).unwrap();
    fs::hard_link(place.path("o.mtl"), place.path("hard.json")).unwrap();
    let flags = ["-o", "symbolic.png", "--stats", "new.json"];
    let message = place.refused(&[&["render", "room.toml"], &flags[..]].concat());
    assert!(message.contains("-o and --stats are the same file, new.json"), "{message}");
    let message = place.refused(&["render", "o.obj", "-o", "image.png"]);
    assert!(message.contains("a file of the scene and -o are the same file"), "{message}");
    let message = place.refused(&["render", "o.obj", "-o", "new.png", "--stats", "hard.json"]);
    assert!(message.contains("a file of the scene and --stats are the same file"), "{message}");
    // What devices get overwrites nothing.
    symlink("/dev/null", place.path("null.png")).unwrap();
    assert_eq!(run(&place, "\"$0\" \"$@\"", &["-o", "null.png", "--stats", "/dev/null"]).code, Some(0));
}

/// Rust's runtime opens /dev/null in place of a closed standard output, where a picture would be lost without a word.
#[test]
fn closed_standard_output_is_told_before_anything_is_done() {
    let place = Place::new();
    let with = |end: &str, words: &str| -> Done {
        place.shell(&format!("\"$0\" {words} {end}"), &[]).output().unwrap().into()
    };
    let render = "render room.toml --size 16x12 --aa 1";
    let [dash, device] = ["-", "/dev/stdout"].map(|output| format!("{render} -o {output} --format png"));
    for words in [&dash, &device, "info room.toml"] {
        let done = with(">&-", words);
        assert_eq!(done.code, Some(2), "{words}: {done:?}");
        assert!(done.stderr.contains("cannot write to standard output: it is closed"), "{words}: {done:?}");
        assert!(!done.stderr.contains("samples"), "nothing is rendered: {done:?}");
    }
    assert_eq!(with(">&-", &format!("{render} -o a.png")).code, Some(0));
    // Somebody wants nothing.
    assert_eq!(with(">/dev/null", &dash).code, Some(0));
}
