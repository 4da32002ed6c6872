//! Known answers for glTF features that the shared models do not show, and damaged files.

use std::{f64::consts::FRAC_PI_2, fs};

use base64::{Engine, engine::general_purpose::STANDARD};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};

use crate::{Fov, LightKind, Projection, Scene};

/// A document with one triangle, (0,0,0) (1,0,0) (0,1,0), its indices as bytes, in a data URI.
fn triangle() -> Value {
    let positions = [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut bytes: Vec<u8> = positions.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0, 1, 2]);
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 3},
        ],
        "buffers": [{"byteLength": 39,
            "uri": format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bytes))}],
    })
}

fn try_open(bytes: &[u8]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.gltf");
    fs::write(&path, bytes).unwrap();
    Scene::open(path).map_err(|error| error.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

fn open(document: &Value) -> Scene {
    try_open(document.to_string().as_bytes()).unwrap()
}

fn error(document: &Value) -> String {
    try_open(document.to_string().as_bytes()).unwrap_err()
}

#[test]
fn a_data_uri_with_byte_indices_is_read() {
    let scene = open(&triangle());
    assert_eq!(scene.mesh.triangles.len(), 1);
    assert_eq!(scene.mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    // glTF's default material is a white rough metal.
    assert_eq!((scene.materials.len(), scene.materials[0].kd), (1, Vec3::ONE));
}

#[test]
fn a_mesh_without_indices_is_read() {
    let mut document = triangle();
    document["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}});
    assert_eq!(open(&document).mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn nested_nodes_keep_the_digits_of_the_file() {
    let mut document = triangle();
    document["scenes"][0]["nodes"] = json!([1]);
    document["nodes"] = json!([
        {"mesh": 0, "scale": [2, 2, 2]},
        {"children": [2], "translation": [1000000.125, -300000.0625, 0]},
        {"children": [0], "rotation": [0, 0, (FRAC_PI_2 / 2.0).sin(), (FRAC_PI_2 / 2.0).cos()]},
    ]);
    let scene = open(&document);
    let corners = scene.mesh.corners(0).map(|c| scene.to_world(c) - DVec3::new(1_000_000.125, -300_000.062_5, 0.0));
    let expected = [DVec3::ZERO, DVec3::new(0.0, 2.0, 0.0), DVec3::new(-2.0, 0.0, 0.0)];
    for (corner, expected) in corners.iter().zip(expected) {
        assert!(corner.distance(expected) < 1e-6, "{corners:?}");
    }
}

#[test]
fn a_mirroring_node_keeps_the_front() {
    let mut document = triangle();
    document["nodes"][0]["scale"] = json!([1, 1, -1]);
    let [a, b, c] = open(&document).mesh.corners(0);
    assert!((b - a).cross(c - a).z < 0.0);
}

#[test]
fn nodes_that_are_no_tree_are_refused() {
    for children in [json!([0]), json!([1, 1])] {
        let mut document = triangle();
        document["nodes"] = json!([{"mesh": 0, "children": children}, {"mesh": 0}]);
        assert!(error(&document).contains("nodes must form a tree"));
    }
}

/// The triangle with cameras and lights of all kinds.
fn furnished() -> Value {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    document["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "color": [1, 0.5, 0.25], "intensity": 40},
        {"type": "directional"},
        {"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
    ]}});
    document["cameras"] = json!([
        {"type": "perspective", "perspective": {"yfov": FRAC_PI_2, "znear": 0.1}},
        {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 10}},
    ]);
    let down = json!([-(FRAC_PI_2 / 2.0).sin(), 0, 0, (FRAC_PI_2 / 2.0).cos()]);
    document["nodes"] = json!([
        {"mesh": 0},
        {"camera": 0, "translation": [0, 5, 0], "rotation": down, "name": "top"},
        {"camera": 1, "translation": [0, 0, 5]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 2, 3], "scale": [5, 5, 5]},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}, "rotation": down},
        {"extensions": {"KHR_lights_punctual": {"light": 2}}, "translation": [1, 2, 3]},
    ]);
    document["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4, 5]);
    document
}

#[test]
fn cameras_and_lights_follow_their_nodes() {
    let scene = open(&furnished());
    let [top, plan] = &scene.cameras[..] else { panic!("{:?}", scene.cameras) };
    assert_eq!((top.name.as_str(), top.position), ("top", Vec3::new(0.0, 5.0, 0.0)));
    assert!(top.direction.distance(Vec3::NEG_Y) < 1e-6 && top.up.distance(Vec3::NEG_Z) < 1e-6, "{top:?}");
    assert_eq!(top.projection, Projection::Perspective(Fov::Vertical(90.0)));
    assert_eq!((plan.direction, plan.projection), (Vec3::NEG_Z, Projection::Orthographic { height: 4.0 }));

    let position = Vec3::new(1.0, 2.0, 3.0);
    let [point, sun, spot] = &scene.lights[..] else { panic!("{:?}", scene.lights) };
    assert_eq!(point.kind, LightKind::Point { position, spread: 0.0 });
    assert_eq!(point.intensity, Vec3::new(40.0, 20.0, 10.0));
    let LightKind::Directional { direction } = sun.kind else { panic!("{sun:?}") };
    assert!(direction.distance(Vec3::NEG_Y) < 1e-6);
    assert_eq!(spot.kind, LightKind::Spot { position, direction: Vec3::NEG_Z, inner: 0.25, outer: 0.5 });
}

#[test]
fn an_unknown_required_extension_is_refused_by_name() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    document["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    assert!(error(&document).contains("KHR_draco_mesh_compression, model.gltf; "));
}

#[test]
fn ranges_that_do_not_fit_are_refused() {
    #[rustfmt::skip]
    let changes: [(&str, Value, &str); 12] = [
        ("/meshes/0/primitives/0/attributes/POSITION", json!(9), "accessor 9, which is not there"),
        ("/accessors/0/count", json!(4), "accessor 0 reaches beyond its buffer"),
        ("/accessors/0/count", json!(u64::MAX), "accessor 0 reaches beyond its buffer"),
        ("/accessors/0/byteOffset", json!(u64::MAX - 8), "accessor 0 reaches beyond its buffer"),
        ("/accessors/1/bufferView", json!(7), "Index out of bounds"),
        ("/accessors/1/count", json!(9), "accessor 1 reaches beyond its buffer"),
        ("/accessors/1/componentType", json!(5126), "reaches beyond|no unsigned integers"),
        ("/accessors/0/type", json!("VEC2"), "holds Vec2 where Vec3 is expected"),
        ("/bufferViews/0/byteLength", json!(u64::MAX), "reaches beyond its buffer"),
        ("/bufferViews/0/byteStride", json!(8), "8 bytes apart"),
        ("/buffers/0/byteLength", json!(400), "buffer 0 holds 39 bytes of 400"),
        ("/buffers/0/uri", json!("missing.bin"), "missing.bin; check that it exists"),
    ];
    for (pointer, value, expected) in changes {
        let mut document = triangle();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        document.pointer_mut(parent).unwrap()[key] = value;
        let message = error(&document);
        assert!(expected.split('|').any(|expected| message.contains(expected)), "{pointer}: {message}");
        assert!(message.contains("; "), "{message}");
    }
}

#[test]
fn cameras_and_lights_that_say_too_little_are_refused_or_completed() {
    let mut document = furnished();
    document["cameras"][0].as_object_mut().unwrap().remove("perspective");
    assert!(error(&document).contains("; "));
    let mut document = furnished();
    document["cameras"][1]["orthographic"]["ymag"] = json!(0);
    assert!(error(&document).contains("camera 1 has ymag = 0"), "{}", error(&document));
    let mut document = furnished();
    document["extensions"]["KHR_lights_punctual"]["lights"][2]["spot"]["innerConeAngle"] = json!(2);
    assert!(error(&document).contains("light 2 has a cone"), "{}", error(&document));
}

#[test]
fn an_index_beyond_the_vertices_is_refused() {
    let mut document = triangle();
    // The positions read as indices.
    document["accessors"][1]["bufferView"] = json!(0);
    document["accessors"][1]["byteOffset"] = json!(14);
    assert!(error(&document).contains("a primitive asks for vertex 128 of 3"), "{}", error(&document));
}

#[test]
fn quantized_positions_are_read() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let bytes: Vec<u8> = [0u16, 0, 0, 65535, 0, 0, 0, 65535, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    document["buffers"][0] = json!({"byteLength": 18, "uri": format!("data:;base64,{}", STANDARD.encode(bytes))});
    document["bufferViews"] = json!([{"buffer": 0, "byteLength": 18}]);
    document["accessors"] = json!([{"bufferView": 0, "componentType": 5123, "normalized": true, "count": 3,
        "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]);
    document["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}});
    assert_eq!(open(&document).mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

/// Bytes changed at random: an error or a scene, never a panic and never a hang.
#[test]
fn damaged_files_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("whole.glb");
    let text = furnished().to_string();
    try_open(text.as_bytes()).unwrap().export(&path).unwrap();
    let glb = fs::read(&path).unwrap();
    let mut state = 1u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut refused = 0;
    for whole in [text.as_bytes(), &glb[..]] {
        for _ in 0..1500 {
            let mut bytes = whole.to_vec();
            for _ in 0..1 + random(3) {
                let at = random(bytes.len());
                bytes[at] = if random(2) == 0 { random(256) as u8 } else { b'0' + random(10) as u8 };
            }
            if random(8) == 0 {
                bytes.truncate(random(bytes.len()));
            }
            refused += usize::from(try_open(&bytes).is_err());
        }
    }
    assert!(refused > 1000, "{refused}");
}
