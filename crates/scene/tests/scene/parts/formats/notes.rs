use std::path::Path;

use lightmesh_scene::internals::formats::notes::Notes;

#[test]
fn a_million_of_a_kind_are_one_sentence() {
    let mut notes = Notes::default();
    for line in 1..=1_000_000 {
        notes.add("is odd", || (line, "x".to_owned()));
    }
    notes.add("is odder", || (7, "y".to_owned()));
    let warnings: Vec<String> = notes.warnings(Path::new("a.obj")).collect();
    assert_eq!(warnings, ["a.obj:1: `x` is odd (the first of 1000000)", "a.obj:7: `y` is odder"]);
}
