//! `lightmesh info`, `grid` and `export`.

use lightmesh::image::Frame;
use serde_json::Value;

use crate::run::Place;

#[test]
fn info_is_for_people_and_programs() {
    let place = Place::new();
    let people = place.good(&["info", "room.toml"]).stdout;
    assert!(people.starts_with("scene   room\n") && people.contains("camera  `front` at 0 2 6"), "{people}");
    let json: Value = serde_json::from_str(&place.good(&["info", "builtin:gazebo", "--json"]).stdout).unwrap();
    assert_eq!(json["triangles"], 300);
    assert_eq!(json["lights"].as_array().unwrap().len(), 3);
    assert!(json["bounds"]["min"].is_array() && json["cameras"][0]["vfov"].is_f64(), "{json}");
    place.refused(&["info"]);
}

#[test]
fn a_grid_is_kept_and_described() {
    let place = Place::new();
    let done = place.good(&["grid", "builtin:gazebo", "-o", "g.grid", "--grid", "15x10x20"]);
    assert!(done.stderr.starts_with("gazebo, 300 triangles: 15x10x20 cells in "), "{done:?}");
    assert!(place.read("g.grid").starts_with(b"LM GRID\0"));
    place.refused(&["grid", "builtin:gazebo", "-o", "no/g.grid"]);
    place.refused(&["grid", "builtin:gazebo", "-o", "h.grid", "--levels", "3"]);
}

#[test]
fn an_exported_scene_gives_the_same_picture() {
    let place = Place::new();
    let render = |scene: &str, name: &str| {
        place.good(&["render", scene, "-o", name, "--size", "32x32", "-q"]);
    };
    render("builtin:gazebo", "original.exr");
    for name in ["copy.glb", "text.toml"] {
        place.good(&["export", "builtin:gazebo", "-o", name, "--quiet"]);
        render(name, "copy.exr");
        // Not to the last bit: the camera's up vector is orthogonalised when written.
        place.good(&["compare", "original.exr", "copy.exr", "--max-rmse", "1e-6"]);
    }
    let refused = place.refused(&["export", "room.toml", "-o", "room.obj"]);
    assert!(refused.contains("`.obj` is not a format that can be written"), "{refused}");
}

/// Seven boxes with names, of two materials, on a plane.
fn boxes() -> String {
    let head = "[camera]\nposition = [4, 6, 14]\ntarget = [3, 0, 0]\nvfov = 40\n[[material]]\nname = \"red\"\nkd = [0.8, 0.1, 0.1]\n\
                [[material]]\nname = \"white\"\nkd = [0.8, 0.8, 0.8]\n";
    let one = |number: usize| {
        let material = ["red", "white"][number % 2];
        format!(
            "[[box]]\nname = \"house {number}\"\ncenter = [{number}, 0.5, 0]\nsize = [0.6, 1, 0.6]\nmaterial = \"{material}\"\n"
        )
    };
    head.to_owned() + &(1..=7).map(one).collect::<String>()
}

#[test]
fn an_exported_scene_keeps_its_objects() {
    let place = Place::new();
    place.write("boxes.toml", &boxes());
    let rows = |scene: &str| -> Vec<String> {
        let sun =
            ["--sun", "48,0,2026-06-21Z,08:00-16:00/1h", "--sun-hours", "h.csv", "--size", "96x64", "--no-studio"];
        place.good(&[&["render", scene][..], &sun].concat());
        let table = String::from_utf8(place.read("h.csv")).unwrap();
        table.lines().skip(1).map(str::to_owned).collect()
    };
    let source = rows("boxes.toml");
    assert_eq!(source.len(), 7, "{source:?}");
    place.good(&["export", "boxes.toml", "-o", "boxes.glb", "-q"]);
    assert_eq!(rows("boxes.glb"), source);
    for name in ["copy.toml", "copy.glb"] {
        place.good(&["export", "boxes.glb", "-o", name, "-q"]);
        assert_eq!(rows(name), source, "{name}");
    }
}

#[test]
fn an_export_says_what_other_programs_do_not_see() {
    let place = Place::new();
    let done = place.good(&["export", "builtin:gazebo", "-o", "gazebo.glb"]);
    assert!(done.stderr.contains("warning: 3 lights the same at any distance: other programs show them"), "{done:?}");
    let done = place.good(&["export", "builtin:gazebo", "-o", "gazebo.toml"]);
    assert!(!done.stderr.contains("warning"), "{done:?}");
}

#[test]
fn info_says_which_way_is_up() {
    let place = Place::new();
    let up = |name: &str| {
        let json: Value = serde_json::from_str(&place.good(&["info", name, "--json"]).stdout).unwrap();
        json["up"].clone()
    };
    place.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    place.write("table.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nf 1 2 3\nf 1 4 5\n");
    assert_eq!(up("sheet.obj")["axis"], "y");
    assert!(
        up("sheet.obj")["reason"].as_str().unwrap().contains("the usual axis of .obj files"),
        "{}",
        up("sheet.obj")
    );
    assert_eq!(up("table.obj"), serde_json::json!({"axis": "z", "reason": "it has a flat ground at its lowest z"}));
    assert!(place.good(&["info", "room.toml"]).stdout.contains("up      y: its cameras are oriented that way"));
}

#[test]
fn the_schema_is_the_published_one() {
    let published =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scene.schema.json")).unwrap();
    let printed: Value = serde_json::from_str(&Place::new().good(&["schema"]).stdout).unwrap();
    assert!(printed == serde_json::from_str::<Value>(&published).unwrap());
}

/// An image of 2 x 2 texels: red, green, blue and white.
const TILES: &[u8] = b"BM\x46\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x02\0\0\0\x02\0\0\0\x01\0\x18\0\0\0\0\0\x10\0\0\0\
    \0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\xff\0\0\xff\xff\xff\0\0\0\0\xff\0\xff\0\0\0";

#[test]
fn an_exported_scene_keeps_its_textures_in_every_byte_of_the_picture() {
    let place = Place::new();
    std::fs::write(place.path("tiles.bmp"), TILES).unwrap();
    let material = "[[material]]\nname = \"tiles\"\nks = 0.2\ntexture = \"tiles.bmp\"\ntexture_scale = [3, 2]\ntexture_rotate = 20\n";
    let look = "[camera]\nposition = [2, 3, 5]\ndirection = [0, 0, -1]\nup = [0, 1, 0]\nvfov = 60\n";
    let shapes = "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [12, 12]\nmaterial = \"tiles\"\n\
                  [[sphere]]\ncenter = [2, 3, 1]\nradius = 1\nmaterial = \"tiles\"\n";
    place.write("tiled.toml", &format!("{look}{material}{shapes}"));
    let render = |scene: &str| {
        place.good(&["render", scene, "-o", "a.exr", "--size", "64x48", "-q", "--mode", "ray-trace", "--bounces", "1"]);
        // The file names the scene.
        Frame::load(place.path("a.exr")).unwrap()
    };
    let original = render("tiled.toml");
    place.write("plain.toml", &format!("{look}[[material]]\nname = \"tiles\"\nks = 0.2\n{shapes}"));
    assert!(original != render("plain.toml"));
    for name in ["copy.glb", "copy.toml"] {
        place.good(&["export", "tiled.toml", "-o", name, "--quiet"]);
        assert!(original == render(name), "{name}");
    }
    assert!(!place.files().contains(&"copy.bmp".to_owned()));
}
