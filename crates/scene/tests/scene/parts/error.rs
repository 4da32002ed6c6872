use std::path::Path;

use lightmesh_scene::internals::error::suggestion;
use lightmesh_scene::{LoadError, Place};

fn known() -> Vec<String> {
    ["center", "material", "radius"].map(str::to_owned).to_vec()
}

#[test]
fn a_byte_has_a_line_and_a_column() {
    let place = |byte| Place::byte(Path::new("f"), "ab\ncd\n", byte).line;
    assert_eq!([place(0), place(1), place(3), place(4)], [Some((1, 1)), Some((1, 2)), Some((2, 1)), Some((2, 2))]);
}

#[test]
fn a_misspelt_key_is_answered_with_the_nearest() {
    let place = Place::line(Path::new("room.toml"), 7);
    let error = LoadError::UnknownKey { place: place.into(), key: "raduis".into(), known: known() };
    let message = "unknown key `raduis`, room.toml:7; did you mean `radius`? Available: center, material, radius";
    assert_eq!(error.to_string(), message);
}

#[test]
fn a_far_fetched_name_is_answered_with_all() {
    assert_eq!(suggestion("xyz", &known()), "available: center, material, radius");
    assert!(suggestion("xyz", &[]).contains("define it"));
}
