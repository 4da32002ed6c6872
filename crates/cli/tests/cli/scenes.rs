//! `lightmesh info`, `grid` and `export`.

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
        // Not to the last bit: the camera's upper side is written at a right angle to its direction.
        place.good(&["compare", "original.exr", "copy.exr", "--max-rmse", "1e-6"]);
    }
    let refused = place.refused(&["export", "room.toml", "-o", "room.obj"]);
    assert!(refused.contains("`.obj` is not a format that can be written"), "{refused}");
}
