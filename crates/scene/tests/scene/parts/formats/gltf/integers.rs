use lightmesh_scene::internals::formats::gltf::as_integers;

fn converted(json: &str) -> String {
    String::from_utf8(as_integers(json.as_bytes())).unwrap()
}

#[test]
fn whole_numbers_become_integers_in_their_places() {
    assert_eq!(converted(r#"{"count": 24.0, "a": [0.0,-3.00,2.5e1]}"#), r#"{"count": 24  , "a": [0  ,-3   ,25   ]}"#);
    assert_eq!(converted("[1e3]"), "[1000]");
}

#[test]
fn all_else_stays() {
    for json in [
        r#"["24.0", "\"1.0", "\\", 0.5, -0.0, 1e400, 1e300, 7, -7]"#,
        r#"{"1.0": "2.0"#,
        "[1.0.0, 2., -, 1.e5, --1.0, 1.0-2]",
        "\"",
        "\"\\",
        "",
    ] {
        assert_eq!(converted(json), json);
    }
    assert_eq!(as_integers(b"\xff1.0"), b"\xff1  ");
}
