//! glTF files.

use serde_json::{Value, json};

use crate::input::Expected::{self, Either, Opens, Refused};
use crate::input::{Input, cut, utf_16};

/// Bytes of the square: four corners, then six indices of two bytes.
pub(crate) const CORNERS: usize = 48;
const INDICES: usize = 12;

/// Every place in the square that refers to something by index.
const REFERENCES: [(&str, Expected); 13] = [
    ("/scene", Refused),
    ("/scenes/0/nodes/0", Refused),
    ("/nodes/0/children/0", Refused),
    ("/nodes/0/mesh", Refused),
    ("/nodes/1/camera", Refused),
    ("/nodes/1/extensions/KHR_lights_punctual/light", Refused),
    ("/meshes/0/primitives/0/attributes/POSITION", Refused),
    ("/meshes/0/primitives/0/indices", Refused),
    ("/meshes/0/primitives/0/material", Opens),
    ("/accessors/0/bufferView", Refused),
    ("/bufferViews/1/buffer", Refused),
    ("/textures/0/source", Opens),
    ("/materials/0/pbrMetallicRoughness/baseColorTexture/index", Opens),
];

/// The largest index that a file can contain.
const BEYOND: &str = "4294967295";
/// Values that are not valid references; the first at least has the right type.
const NO_REFERENCES: [&str; 5] = [BEYOND, "4294967296", "-1", "0.5", "\"0\""];

/// Other values, as JSON, and the expected outcome.
const VALUES: [(&str, &str, Expected); 56] = [
    ("/asset/version", "\"1.0\"", Refused),
    ("/asset/version", "\"3.0\"", Refused),
    ("/materials/0/alphaMode", "\"CLOUDS\"", Opens),
    ("/materials/0/alphaMode", "1", Refused),
    ("/materials/0/alphaCutoff", "-1e38", Opens),
    ("/materials/0/alphaCutoff", "\"0.5\"", Refused),
    ("/asset/version", "2.0", Opens),
    ("/accessors/0/count", "4294967295", Refused),
    ("/accessors/0/count", "18446744073709551615", Refused),
    ("/accessors/0/count", "1e308", Refused),
    ("/accessors/0/count", "5", Refused),
    ("/accessors/0/count", "3", Refused),
    ("/accessors/0/count", "0", Refused),
    ("/accessors/1/count", "4294967295", Refused),
    ("/accessors/1/count", "5", Either),
    ("/accessors/1/count", "0", Either),
    ("/accessors/0/componentType", "5130", Refused),
    ("/accessors/0/componentType", "5121", Either),
    ("/accessors/1/componentType", "5125", Refused),
    ("/accessors/1/componentType", "5126", Refused),
    ("/accessors/0/type", "\"MAT4\"", Refused),
    ("/accessors/0/type", "\"VEC2\"", Refused),
    ("/accessors/0/type", "\"\\u001b[31m\\n\"", Refused),
    ("/accessors/0/byteOffset", "18446744073709551615", Refused),
    ("/accessors/0/byteOffset", "1", Refused),
    ("/accessors/0/bufferView", "null", Either),
    ("/bufferViews/0/byteLength", "4294967295", Refused),
    ("/bufferViews/0/byteLength", "0", Refused),
    ("/bufferViews/0/byteOffset", "18446744073709551615", Refused),
    ("/bufferViews/0/byteStride", "18446744073709551615", Refused),
    ("/bufferViews/0/byteStride", "0", Opens),
    ("/bufferViews/0/byteStride", "1", Refused),
    ("/buffers/0/byteLength", "4294967295", Refused),
    ("/buffers/0/byteLength", "18446744073709551615", Refused),
    ("/buffers/0/byteLength", "0", Opens),
    ("/meshes/0/primitives/0/mode", "7", Either),
    ("/meshes/0/primitives/0/mode", "4294967295", Either),
    ("/meshes/0/primitives/0/mode", "0", Opens),
    ("/meshes/0/primitives", "[]", Opens),
    ("/nodes/0/scale", "[0, 0, 0]", Refused),
    ("/nodes/0/scale", "[1e308, 1e308, 1e308]", Refused),
    ("/nodes/0/scale", "[1e999, 1, 1]", Refused),
    ("/nodes/0/translation", "[1e308, 0, 0]", Opens),
    ("/nodes/0/rotation", "[0, 0, 0, 0]", Opens),
    ("/nodes/0/matrix", "[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]", Either),
    ("/nodes/1/translation", "[1e308, 0, 0]", Either),
    ("/nodes/1/scale", "[0, 0, 0]", Either),
    ("/cameras/0/perspective/yfov", "0", Refused),
    ("/cameras/0/perspective/yfov", "1e308", Refused),
    ("/cameras/0/perspective/yfov", "-1", Refused),
    ("/extensions/KHR_lights_punctual/lights/0/intensity", "1e308", Either),
    ("/extensions/KHR_lights_punctual/lights/0/intensity", "-1", Either),
    ("/extensions/KHR_lights_punctual/lights/0/type", "\"\\u0000\"", Opens),
    ("/materials/0/pbrMetallicRoughness/baseColorFactor", "[1e308, -1, 0, 1]", Either),
    ("/materials/0/pbrMetallicRoughness/roughnessFactor", "1e38", Opens),
    ("/extensionsRequired", "[\"EVIL_extension\"]", Refused),
];

/// URIs of the buffer, without which there is no geometry.
const BUFFERS: [&str; 14] = [
    "none.bin",
    "../a.bin",
    "..%2fa.bin",
    "/etc/passwd",
    "file:///etc/passwd",
    "https://example.org/a.bin",
    "a%00.bin",
    "a\0.bin",
    "\u{1b}[31m\n.bin",
    ".",
    "",
    "data:",
    "data:;base64,*",
    "data:;base64,AAAA",
];

pub(crate) fn inputs() -> Vec<Input> {
    let mut all = vec![Input::new("gltf", "a square as it should be", text(&square(true)), Opens)];
    all.extend(cut("gltf", "square", text(&square(true)).as_bytes()));
    for (place, expected) in REFERENCES {
        all.extend(NO_REFERENCES.map(|value| changed(place, value, if value == BEYOND { expected } else { Refused })));
    }
    all.extend(VALUES.map(|(place, value, expected)| changed(place, value, expected)));
    all.extend(BUFFERS.map(|uri| {
        let oddity = format!("buffer `{}`", uri.escape_debug());
        Input::new("gltf", oddity, text(&with(square(true), "/buffers/0/uri", uri.into())), Refused).blaming("")
    }));
    all.extend(BUFFERS.map(|uri| {
        let oddity = format!("image `{}`", uri.escape_debug());
        Input::new("gltf", oddity, text(&with(square(true), "/images/0/uri", uri.into())), Opens)
    }));
    all.extend(hierarchies());
    all.extend(texts());
    all
}

pub(crate) fn text(document: &Value) -> String {
    document.to_string()
}

fn with(mut document: Value, place: &str, value: Value) -> Value {
    let (parent, key) = place.rsplit_once('/').unwrap();
    let parent = document.pointer_mut(parent).unwrap_or_else(|| panic!("{place}"));
    match key.parse::<usize>() {
        Ok(index) => parent[index] = value,
        Err(_) => parent[key] = value,
    }
    document
}

/// The square with a value that `serde_json` may be unable to represent.
fn changed(place: &str, value: &str, expected: Expected) -> Input {
    const MARK: &str = "the value";
    let document = text(&with(square(true), place, MARK.into())).replace(&format!("\"{MARK}\""), value);
    Input::new("gltf", format!("{place} = {value}"), document, expected)
}

/// Corners and indices.
pub(crate) fn bytes() -> Vec<u8> {
    let corners: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let indices: [u16; 6] = [0, 1, 2, 0, 2, 3];
    corners.iter().flat_map(|c| c.to_le_bytes()).chain(indices.iter().flat_map(|i| i.to_le_bytes())).collect()
}

/// A square with a camera and a light, its bytes in a data URI or in a GLB file's chunk.
pub(crate) fn square(alone: bool) -> Value {
    let percent: String = bytes().iter().map(|byte| format!("%{byte:02x}")).collect();
    let length = CORNERS + INDICES;
    let buffer = json!({ "byteLength": length, "uri": format!("data:,{percent}") });
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [
            { "mesh": 0, "children": [1] },
            { "camera": 0, "translation": [0, 0, 3], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        ],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] }],
        "materials": [{
            "alphaMode": "MASK",
            "alphaCutoff": 0.25,
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
        }],
        "textures": [{ "source": 0 }],
        "images": [{ "uri": "none.png" }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": CORNERS },
            { "buffer": 0, "byteOffset": CORNERS, "byteLength": INDICES },
        ],
        "buffers": [if alone { buffer } else { json!({ "byteLength": length }) }],
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "point", "intensity": 10 }] } },
    })
}

fn hierarchies() -> [Input; 7] {
    let nodes = |oddity: &str, nodes: Vec<Value>, expected| {
        Input::new("gltf", oddity, text(&with(square(true), "/nodes", nodes.into())), expected)
    };
    let chain = |count: u32| (0..count).map(|index| json!({ "children": [index + 1] }));
    let leaf = json!({ "mesh": 0 });
    let deep = chain(20_000).chain([leaf.clone()]).collect();
    let grown = chain(400).map(|node| with(node, "/scale", json!([10, 10, 10]))).chain([leaf.clone()]).collect();
    let mut many = square(true);
    many["scenes"][0]["nodes"] = (0..20_000).collect();
    many["nodes"] = vec![leaf.clone(); 20_000].into();
    [
        nodes("a node that is its own child", vec![json!({ "children": [0] })], Refused),
        nodes(
            "two nodes that are each other's child",
            vec![json!({ "children": [1] }), json!({ "children": [0] })],
            Refused,
        ),
        nodes("a child of two", vec![json!({ "children": [1, 1] }), leaf], Refused),
        nodes("a chain of many nodes", deep, Opens),
        nodes("a chain that grows beyond all numbers", grown, Opens),
        nodes("no nodes", vec![], Refused),
        Input::new("gltf", "a mesh in many nodes", text(&many), Opens),
    ]
}

fn texts() -> Vec<Input> {
    let whole = text(&square(true));
    let extras = |value: &str| whole.replacen('{', &format!("{{\"extras\":{value},"), 1);
    let nested = |open: &str, close: &str| format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
    let named = |name: &str| text(&with(square(true), "/nodes/1/name", name.into()));
    let ours = |extras: Value| text(&with(square(true), "/scenes/0/extras", json!({ "lightmesh": extras })));
    vec![
        Input::new("gltf", "empty", "", Refused),
        Input::new("gltf", "an empty object", "{}", Refused),
        Input::new("gltf", "null", "null", Refused),
        Input::new("gltf", "a list", "[]", Refused),
        Input::new("gltf", "an asset alone", r#"{"asset":{"version":"2.0"}}"#, Opens),
        Input::new("gltf", "byte order mark", format!("\u{feff}{whole}"), Opens),
        Input::new("gltf", "UTF-16", utf_16(&whole), Refused),
        Input::new("gltf", "NUL bytes at the end", format!("{whole}\0\0\0"), Opens),
        Input::new("gltf", "another document behind", format!("{whole}{whole}"), Refused),
        Input::new("gltf", "lists within lists", extras(&nested("[", "]")), Either),
        Input::new("gltf", "objects within objects", extras(&nested("{\"a\":", "}")), Either),
        Input::new("gltf", "lists that never end", "[".repeat(100_000), Refused),
        Input::new("gltf", "a name of a megabyte", named(&"x".repeat(1 << 20)), Opens),
        Input::new("gltf", "a name of control characters", named("\0\u{1b}[31m\n\u{7}"), Opens),
        Input::new("gltf", "half a surrogate pair", named("@").replace('@', "\\ud800"), Either),
        Input::new("gltf", "not UTF-8", [whole.as_bytes(), b"\xff"].concat(), Refused),
        Input::new("gltf", "a far origin", ours(json!({ "origin": [1e300, 0, 0] })), Refused),
        Input::new("gltf", "a huge step", ours(json!({ "step": 1e38, "radius": 1e38 })), Either),
        Input::new("gltf", "a step of nothing", ours(json!({ "step": 0, "radius": 1 })), Refused),
        Input::new(
            "gltf",
            "a dark background",
            ours(json!({ "background": [-1, 0, 0], "ambient": [1, 0, 0] })),
            Refused,
        ),
    ]
}
