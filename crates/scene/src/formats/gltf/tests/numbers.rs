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
