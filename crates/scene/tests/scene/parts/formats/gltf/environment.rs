//! `EXT_lights_image_based`.

use glam::Vec3;
use serde_json::{Value, json};

use super::*;

/// A picture with two halves in a data URI.
fn picture(left: [u8; 4], right: [u8; 4]) -> Value {
    let mut bytes = Vec::new();
    let image = image::RgbaImage::from_fn(16, 16, |x, _| image::Rgba(if x < 8 { left } else { right }));
    image.write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
    json!({"uri": format!("data:image/png;base64,{}", STANDARD.encode(bytes))})
}

/// A triangle in a cube whose faces are grey, one code for each, with a right half that is half as divided.
fn surrounded() -> Value {
    let mut document = triangle();
    let faces = (1..=6u8).map(|face| picture([40 * face, 0, 0, 255], [40 * face, 0, 0, 51]));
    document["images"] = faces.collect();
    document["extensionsUsed"] = json!(["EXT_lights_image_based"]);
    document["extensions"] = json!({"EXT_lights_image_based": {"lights": [{
        "intensity": 2, "irradianceCoefficients": [], "specularImageSize": 16,
        "specularImages": [[0, 1, 2, 3, 4, 5]],
    }]}});
    document["scenes"][0]["extensions"] = json!({"EXT_lights_image_based": {"light": 0}});
    document
}

/// What is seen along a direction.
fn seen(scene: &Scene, direction: Vec3) -> f32 {
    let environment = scene.lights.environment.as_ref().unwrap();
    let [column, row] = environment.texel(direction);
    environment.texels()[(row * environment.size()[0] + column) as usize][0]
}

#[test]
fn six_faces_become_a_panorama() {
    let scene = open(&surrounded());
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let linear = |face: u8| 2.0 * ((f32::from(40 * face) / 255.0 + 0.055) / 1.055).powf(2.4);
    // The left half of each face, and the right one, which is brighter by its divisor.
    for (face, forward, right) in [
        (1, Vec3::X, Vec3::Z),
        (2, -Vec3::X, -Vec3::Z),
        (5, Vec3::Z, -Vec3::X),
        (6, -Vec3::Z, Vec3::X),
        (3, Vec3::Y, -Vec3::X),
        (4, -Vec3::Y, -Vec3::X),
    ] {
        for (aside, factor) in [(-0.6, 1.0), (0.6, 5.0)] {
            let found = seen(&scene, (forward + aside * right).normalize());
            assert!((found / (factor * linear(face)) - 1.0).abs() < 0.05, "face {face}, {aside}: {found}");
        }
    }
    let mut turned = surrounded();
    // By a right angle about Y: what was in +X is in −Z.
    let half = 0.5f64.sqrt();
    turned["extensions"]["EXT_lights_image_based"]["lights"][0]["rotation"] = json!([0, half, 0, half]);
    let turned = open(&turned);
    let before = seen(&scene, (Vec3::X + 0.6 * Vec3::Z).normalize());
    let after = seen(&turned, (-Vec3::Z + 0.6 * Vec3::X).normalize());
    assert!((after / before - 1.0).abs() < 0.05, "{after}, not {before}");
}

#[test]
fn what_cannot_surround_a_scene_is_a_warning() {
    let with = |key: &str, value: Value| {
        let mut document = surrounded();
        document["extensions"]["EXT_lights_image_based"]["lights"][0][key] = value;
        let scene = open(&document);
        assert!(scene.lights.environment.is_none());
        scene.warnings.join("\n")
    };
    assert!(with("specularImages", json!([])).contains("its environment cannot be used (it has no pictures)"));
    assert!(with("specularImages", json!([[0, 1, 2, 3, 4]])).contains("a cube has six faces"));
    assert!(with("specularImages", json!([[0, 1, 2, 3, 4, 9]])).contains("image 9: it is not there"));
    assert!(with("rotation", json!([0, 0, 0, 0])).contains("rotation"));
    assert!(with("intensity", json!(-1)).contains("intensity"));
    let mut document = surrounded();
    document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = json!(3);
    assert!(warnings(&document).contains("there is no light 3"));
    let mut document = surrounded();
    document["images"][2]["uri"] = json!("data:image/png;base64,AAAA");
    assert!(warnings(&document).contains("image 2: it is not a PNG"), "{}", warnings(&document));
}
