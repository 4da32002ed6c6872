//! Numbers that are unusable in computations.

use serde_json::json;

use super::*;

#[test]
fn extras_that_cannot_be_meant_are_refused() {
    for (extras, expected) in [
        (json!({"origin": [0, 1e300, 0]}), "has the origin [0, 1"),
        (json!({"step": 0}), "has step = 0"),
        (json!({"radius": 1e39}), "has radius = inf"),
        (json!({"ambient": [0, -1, 0]}), "has ambient = [0, -1, 0]"),
        (json!({"background": [1e39, 0, 0]}), "has background = [inf, 0, 0]"),
        (json!({"weight": "heavy"}), "has the unknown weight `heavy`"),
    ] {
        let mut document = triangle();
        document["scenes"] = json!([{"nodes": [0], "extras": {"lightmesh": extras}}]);
        let message = error(&document);
        assert!(message.contains(&format!("extras.lightmesh of the scene {expected}")), "{message}");
    }
}

#[test]
fn cameras_and_lights_without_a_place_are_left_out() {
    let mut document = triangle();
    document["cameras"] = json!([{"perspective": {"yfov": 1}}]);
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    document["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let light = json!({"KHR_lights_punctual": {"light": 0}});
    document["nodes"] = json!([
        {"mesh": 0}, {"camera": 0}, {"camera": 0, "translation": [1e308, 0, 0]}, {"extensions": light, "translation": [0, 1e19, 0]}
    ]);
    let scene = open(&document);
    assert_eq!((scene.cameras.len(), scene.lights.len()), (1, 0));
    assert!(
        scene.warnings.iter().any(|warning| warning.starts_with("1 cameras with infinite")),
        "{:?}",
        scene.warnings
    );
    assert!(scene.warnings.iter().any(|warning| warning.starts_with("1 lights with infinite")), "{:?}", scene.warnings);
}

/// Some programs know floats only.
#[test]
fn integers_may_be_written_as_floats() {
    let text = triangle().to_string().replace("\"count\":3", "\"count\":3.0").replace("\"mesh\":0", "\"mesh\":0.0");
    let scene = try_open(text.as_bytes()).unwrap();
    assert_eq!(scene.geometry.mesh.triangles.len(), 1);
    let [warning, ..] = &scene.warnings[..] else { panic!("no warning") };
    assert!(
        warning.ends_with("model.gltf:1: integers are written as floats, 3.0 is the first: read as integers"),
        "{warning}"
    );

    let damaged = text.replace("\"mesh\":0.0", "\"mesh\":0.5");
    assert!(try_open(damaged.as_bytes()).unwrap_err().contains("floating point `0.5`, expected u32"));
    assert!(try_open(text.replace("\"mesh\":0.0", "\"mesh\":-1.0").as_bytes()).is_err());
    assert!(warnings(&triangle()).is_empty(), "{}", warnings(&triangle()));
}

#[test]
fn a_version_may_be_a_number() {
    for version in [json!(2.0), json!(2)] {
        let mut document = triangle();
        document["asset"] = json!({"version": version, "minVersion": version});
        assert!(warnings(&document).contains("model.gltf: its version is a number, not a text: read as `2.0`"));
    }
    let mut document = triangle();
    document["asset"] = json!({"version": 1.0});
    assert!(error(&document).contains("the file has glTF version `1.0`"));
    document["asset"] = json!({"version": [2]});
    assert!(error(&document).contains("expected a string"));
}
