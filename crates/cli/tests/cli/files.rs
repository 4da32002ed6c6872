//! `info --files`: every file that a scene needs, of each format.

use std::path::Path;

use serde_json::Value;

use crate::run::Place;

/// Three corners of a triangle, as the buffer of a glTF file.
fn corners() -> Vec<u8> {
    [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A triangle whose buffer and image are files beside it.
const GLTF: &str = r#"{
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}], "images": [{"uri": "my%20wood.png"}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "corners.bin", "byteLength": 36}]
}"#;

/// A folder with a file of each kind.
fn place() -> Place {
    let place = Place::new();
    place.good(&["render", "room.toml", "-o", "my wood.png", "--size", "8x8", "-q"]);
    place.good(&["render", "room.toml", "-o", "street.exr", "--size", "16x8", "-q"]);
    std::fs::write(place.path("corners.bin"), corners()).unwrap();
    place.write("model.gltf", GLTF);
    place.write("floor.mtl", "newmtl wood\nmap_Kd my wood.png\nnewmtl gone\nmap_Kd gone.png\n");
    place.write("floor.obj", "mtllib floor.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl wood\nf 1/1 2/1 3/1\n");
    place.write("bare.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
    let mesh = |file: &str| format!("[[mesh]]\nfile = \"{file}\"\n");
    let environment = "[environment]\nfile = \"street.exr\"\n";
    place.write("all.toml", &(environment.to_owned() + &mesh("floor.obj") + &mesh("model.gltf") + &mesh("bare.stl")));
    place
}

/// The lines that are printed, sorted after the scene's own.
fn listed(place: &Place, scene: &str) -> Vec<String> {
    let done = place.good(&["info", scene, "--files"]);
    let mut lines: Vec<String> = done.stdout.lines().map(str::to_owned).collect();
    lines[1..].sort();
    lines
}

#[test]
fn every_file_of_a_scene_is_listed_after_its_own() {
    let place = place();
    assert_eq!(listed(&place, "bare.stl"), ["bare.stl"]);
    assert_eq!(listed(&place, "model.gltf"), ["model.gltf", "corners.bin", "my wood.png"]);
    assert_eq!(listed(&place, "floor.obj"), ["floor.obj", "floor.mtl", "my wood.png"]);
    let all =
        ["all.toml", "bare.stl", "corners.bin", "floor.mtl", "floor.obj", "model.gltf", "my wood.png", "street.exr"];
    assert_eq!(listed(&place, "all.toml"), all);
    let json: Value = serde_json::from_str(&place.good(&["info", "floor.obj", "--files", "--json"]).stdout).unwrap();
    assert_eq!(json["files"].as_array().unwrap().len(), 3);
    assert_eq!(place.good(&["info", "builtin:gazebo", "--files"]).stdout, "");
}

/// What is listed is all that is needed: a copy of it renders the same picture.
#[test]
fn a_copy_of_the_files_is_the_scene() {
    let (place, copy) = (place(), Place::new());
    for file in listed(&place, "all.toml") {
        std::fs::copy(place.path(&file), copy.path(&file)).unwrap();
    }
    let picture = |place: &Place| {
        let done = place.good(&["render", "all.toml", "-o", "picture.png", "--size", "24x16", "--quality", "draft"]);
        assert!(!done.stderr.contains("my wood.png") && !done.stderr.contains("street.exr"), "{done:?}");
        place.read("picture.png")
    };
    assert_eq!(picture(&copy), picture(&place));
}

#[cfg(unix)]
#[test]
fn files_that_must_not_be_read_are_not_listed() {
    let place = Place::new();
    std::fs::create_dir(place.path("scene")).unwrap();
    place.good(&["render", "room.toml", "-o", "secret.png", "--size", "8x8", "-q"]);
    place.write("scene/floor.mtl", "newmtl wood\nmap_Kd ../secret.png\n");
    place.write("scene/floor.obj", "mtllib floor.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl wood\nf 1/1 2/1 3/1\n");
    assert_eq!(listed(&place, "scene/floor.obj"), ["scene/floor.obj", "scene/floor.mtl"]);
    let done = place.good(&["info", "scene/floor.obj", "--files", "--allow-outside"]);
    assert!(done.stdout.lines().any(|line| Path::new(line).ends_with("secret.png")), "{done:?}");
}
