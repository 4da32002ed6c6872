//! Known answers for glTF features that the shared models do not show, and damaged files.

mod animations;
mod containers;
mod damage;
mod environment;
mod extensions;
mod geometry;
mod integers;
mod materials;
mod meshes;
mod numbers;
mod picture;
mod shared;
mod strided;
mod uri;
mod views;

use std::f64::consts::FRAC_PI_2;
use std::fs;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lightmesh_scene::{LoadOptions, Scene};
use serde_json::{Value, json};

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

/// All warnings, one per line.
fn warnings(document: &Value) -> String {
    open(document).warnings.join("\n").replace(&std::env::temp_dir().display().to_string(), "")
}

fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// Adds an accessor with its own buffer and view, and returns its index.
fn add_accessor(document: &mut Value, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
    let view = add_view(document, bytes);
    let accessors = document["accessors"].as_array_mut().unwrap();
    accessors.push(json!({"bufferView": view, "componentType": component, "count": count, "type": kind}));
    accessors.len() - 1
}

/// Adds a view of its own buffer, and returns its index.
fn add_view(document: &mut Value, bytes: &[u8]) -> usize {
    let buffers = document["buffers"].as_array_mut().unwrap();
    let uri = format!("data:;base64,{}", STANDARD.encode(bytes));
    buffers.push(json!({"byteLength": bytes.len(), "uri": uri}));
    let buffer = buffers.len() - 1;
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": buffer, "byteLength": bytes.len()}));
    views.len() - 1
}

/// Adds an accessor of floats.
fn add_floats(document: &mut Value, numbers: &[f32], kind: &str, count: usize) -> usize {
    add_accessor(document, &bytes_of(numbers), FLOAT, kind, count)
}

const BYTE: u32 = 5120;
const UNSIGNED_BYTE: u32 = 5121;
const SHORT: u32 = 5122;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// A binary container of these chunks.
fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, data) in chunks {
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(*kind);
        bytes.extend(*data);
    }
    let length = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    bytes
}

/// The triangle's JSON without a URI, and its bytes.
fn separate() -> (String, Vec<u8>) {
    let mut document = triangle();
    let buffer = document["buffers"][0].as_object_mut().unwrap();
    let uri = buffer.remove("uri").unwrap();
    let data = uri.as_str().unwrap().split_once(',').unwrap().1.to_owned();
    (document.to_string(), STANDARD.decode(data).unwrap())
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
