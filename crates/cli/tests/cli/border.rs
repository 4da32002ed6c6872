//! What files and their names may do: be read where they may lie, and be shown.

use lightmesh_files::visible;
use serde_json::{Value, json};

use crate::run::{Done, Place};

/// It would set a terminal's title, ring, overwrite its line, turn the direction, hide, and add lines.
const HOSTILE: &str = "a\u{1b}]0;b\u{7}\r\u{9b}2J\u{7f}\u{ad}\u{200b}\u{202e}\u{2066}\u{2028}\u{feff}\nerror: forged";

/// The folder, with a scene of that name and with such names in it.
fn hostile(place: &Place) -> String {
    let file = format!("{HOSTILE}.toml");
    let name = Value::from(HOSTILE).to_string().replace('\u{7f}', "\\u007f").replace('\u{9b}', "\\u009b");
    place.write(
        &file,
        &format!(
            "[camera]\nname = {name}\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\n\
             [[light]]\nkind = \"point\"\nname = {name}\nposition = [0, 5, 5]\n\
             [[material]]\nname = {name}\ntexture = {name}\n\
             [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = {name}\n"
        ),
    );
    file
}

/// Everything can be seen, and nothing begins a line by its name alone.
fn is_visible(done: &Done) {
    for line in done.stdout.lines().chain(done.stderr.lines()) {
        assert_eq!(line, visible(line), "{done:?}");
        assert!(!line.starts_with("error: forged"), "{done:?}");
    }
}

#[cfg(unix)]
#[test]
fn names_do_not_command_the_terminal() {
    let place = Place::new();
    let file = hostile(&place);
    let image = format!("{HOSTILE}.png");
    let small = ["--size", "8x8"];
    let info = place.good(&["info", &file]);
    is_visible(&info);
    let name = visible(HOSTILE);
    for line in [format!("scene   {name}"), format!("camera  `{name}` at"), format!("light   point `{name}`")] {
        assert!(info.stdout.contains(&line), "{line}: {info:?}");
    }
    for progress in ["none", "json"] {
        let done = place.good(&[&["render", &file, "-o", &image, "--progress", progress], &small[..]].concat());
        is_visible(&done);
        assert!(progress == "none" || done.stderr.lines().all(|line| serde_json::from_str::<Value>(line).is_ok()));
    }
    is_visible(&place.good(&["grid", &file, "-o", &format!("{HOSTILE}.grid")]));
    is_visible(&place.good(&["export", &file, "-o", &format!("{HOSTILE}.glb")]));
    is_visible(&place.run(&["render", &file, "-o", &image, "--camera-name", HOSTILE, "--strict"]));
    for args in [
        &["info", &format!("{HOSTILE}.fbx")][..],
        &["info", HOSTILE],
        &["compare", &image, &format!("{HOSTILE}.exr")],
        &["compare", &image, HOSTILE],
        &["report", HOSTILE, "-o", "out"],
        &["bench", "compare", HOSTILE, HOSTILE],
        &["render", "room.toml", "-o", HOSTILE],
        &["render", "room.toml", "-o", "a.png", "--camera-name", HOSTILE],
        &["man", HOSTILE],
    ] {
        let done = place.run(args);
        assert_eq!(done.code, Some(2), "{done:?}");
        is_visible(&done);
    }
    // Here the arguments have lines of their own.
    for args in [
        &["render", "room.toml", "-o", "a.png", "--mode", HOSTILE][..],
        &["info", "room.toml", HOSTILE],
        &["bench", HOSTILE],
        &[HOSTILE],
    ] {
        let done = place.run(args);
        done.stderr.lines().for_each(|line| assert_eq!(line, visible(line), "{done:?}"));
    }
}

#[cfg(unix)]
#[test]
fn json_means_the_names_themselves() {
    let place = Place::new();
    let file = hostile(&place);
    let done = place.good(&["info", &file, "--json"]);
    is_visible(&done);
    let info: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!((&info["cameras"][0]["name"], &info["lights"][0]["name"]), (&HOSTILE.into(), &HOSTILE.into()));
    let done = place.good(&["render", &file, "-o", "a.png", "--size", "8x8", "--progress", "json"]);
    let events: Vec<Value> = done.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let warning = events.iter().find(|event| event["event"] == "warning").expect("the texture is missing");
    assert!(warning["text"].as_str().unwrap().contains(HOSTILE), "{warning}");
}

#[test]
fn ids_in_results_do_not_command_the_terminal() {
    let place = Place::new();
    let results = json!({
        "version": 1, "suite": HOSTILE, "quick": false, "started": "2026-01-31T12:00:00Z", "seconds": 1.0,
        "program": { "name": "lightmesh", "version": "0", "commit": null, "command": HOSTILE },
        "machine": { "cpu": HOSTILE, "threads": 2, "memory_bytes": 1, "os": HOSTILE, "gpus": [] },
        "rows": [{ "id": HOSTILE, "experiment": HOSTILE, "keys": { "scene": HOSTILE }, "seconds": { "render": [1, 1, 1] } }],
        "notes": [HOSTILE],
    });
    place.write("a.json", &results.to_string());
    let done = place.good(&["bench", "compare", "a.json", "a.json"]);
    assert!(done.stdout.contains(&*visible(HOSTILE)), "{done:?}");
    is_visible(&done);
    let done = place.good(&["bench", "compare", "a.json", "a.json", "--json"]);
    is_visible(&done);
    assert!(done.stdout.contains("\\u202e") && serde_json::from_str::<Value>(&done.stdout).is_ok(), "{done:?}");
    place.good(&["report", "a.json", "-o", "out"]);
    let text = String::from_utf8(place.read("out/report.md")).unwrap();
    assert!(text.contains("forged"), "{text}");
    text.lines().for_each(|line| assert_eq!(line, visible(line)));
}

/// A link out of the folder is not followed, and the message says what allows it.
#[cfg(unix)]
#[test]
fn a_link_out_of_the_folder_needs_permission() {
    let place = Place::new();
    std::fs::create_dir(place.path("scene")).unwrap();
    place.write("secret.obj", "root:x:0:0:root:/root:/bin/bash\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::os::unix::fs::symlink("../secret.obj", place.path("scene/link.obj")).unwrap();
    place.write("scene/room.toml", "[[mesh]]\nfile = \"link.obj\"\n");
    assert_eq!(
        place.refused(&["info", "scene/room.toml"]),
        "error: `link.obj` leads outside the scene's folder, scene/room.toml:2; move the file there, or allow references outside \
         (--allow-outside)"
    );
    let done = place.good(&["info", "scene/room.toml", "--allow-outside"]);
    assert!(done.stdout.contains("1 triangles") && !done.stdout.contains("/bin/bash"), "{done:?}");
    // The file that the user names may lie anywhere.
    place.good(&["info", "scene/link.obj"]);
}

#[cfg(unix)]
#[test]
fn images_of_results_lie_next_to_them() {
    let place = Place::new();
    place.good(&["render", "room.toml", "-o", "secret.png", "--size", "8x8", "-q"]);
    std::fs::create_dir(place.path("run")).unwrap();
    std::os::unix::fs::symlink("../secret.png", place.path("run/link.png")).unwrap();
    for file in ["../secret.png", "link.png"] {
        let results = json!({
            "version": 1, "suite": "any", "quick": true, "started": "2026-01-31T12:00:00Z", "seconds": 1.0,
            "program": { "name": "lightmesh", "version": "0", "commit": null, "command": "lightmesh bench any" },
            "machine": { "cpu": "a", "threads": 2, "memory_bytes": 1, "os": "b", "gpus": [] },
            "rows": [], "pictures": [{ "id": "a", "experiment": "e", "file": file, "title": "a", "keys": {}, "reference": null }],
        });
        place.write("run/a.json", &results.to_string());
        let message = place.refused(&["report", "run/a.json", "-o", "out"]);
        assert!(message.contains("(outside the folder); keep images next to the result file"), "{message}");
    }
}
