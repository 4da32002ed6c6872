//! A scene as binary glTF 2.0.
//!
//! Objects are nodes of their names, with a primitive for each material; what is placed many times is stored once ([`objects`]). Named places
//! without a surface are nodes, too. Vertices are stored in the local frame, below nodes that are translated to the frame's origin.

mod arrays;
pub(super) mod material;
mod objects;
pub(super) mod pictures;
mod views;

use std::path::Path;

use glam::{DVec3, Vec3};
use serde_json::{Map, Value, json};

use self::material::material;
use self::objects::{Objects, empty_node};
use self::pictures::Pictures;
use self::views::{camera_entry, camera_node, light_entry, light_node};
use super::error::{ExportError, refused};
use super::lights::own_lights;
use crate::Scene;
use crate::formats::gltf::extras::SceneExtras;

/// Which content is written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    /// Triangles and their materials.
    Triangles,
    /// Also cameras, lights and all other content.
    Everything,
}

/// The bytes of a GLB file.
pub(super) fn encode(scene: &Scene, content: Content, path: &Path) -> Result<Vec<u8>, ExportError> {
    let mut nodes = Vec::new();
    let mut root = json!({"asset": {"version": "2.0", "generator": "lightmesh"}, "scene": 0});
    let mut bin = Vec::new();
    let mut extensions = Vec::new();
    let objects = Objects::new(scene);
    if !objects.is_empty() {
        let pictures = Pictures::new(scene).map_err(|cause| refused(path, cause))?;
        let materials = scene.geometry.materials.iter().enumerate().map(|(index, it)| material(it, index, &pictures));
        let materials: Vec<Value> = materials.collect();
        let uses = |name: &str| materials.iter().any(|material| material["extensions"].get(name).is_some());
        extensions.extend(material::EXTENSIONS.into_iter().filter(|name| uses(name)));
        if pictures.transformed() {
            extensions.push("KHR_texture_transform");
        }
        if objects.has_lists() {
            extensions.push("EXT_mesh_gpu_instancing");
            // Who does not know it would show one place of each.
            root["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
        }
        root["materials"] = Value::Array(materials);
        let lists = objects.arrays.describe(&mut root);
        nodes = objects.nodes(&lists);
        bin = objects.arrays.into_bytes();
        pictures.write(scene, &mut bin, &mut root);
        root["buffers"] = json!([{"byteLength": bin.len()}]);
    }
    nodes.extend(scene.empties.iter().map(empty_node));
    let mut extras = Map::new();
    if content == Content::Everything {
        if !scene.cameras.is_empty() {
            root["cameras"] = scene.cameras.iter().map(|camera| camera_entry(scene, camera)).collect();
        }
        nodes.extend(scene.cameras.iter().enumerate().map(|(index, camera)| camera_node(scene, index, camera)));
        if own_lights(scene).next().is_some() {
            let bounds = scene.geometry.mesh.bounds();
            let lights: Value = own_lights(scene).map(|light| light_entry(&bounds, light)).collect();
            extensions.push("KHR_lights_punctual");
            root["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}});
        }
        nodes.extend(own_lights(scene).enumerate().map(|(index, light)| light_node(scene, index, light)));
        extras.insert("lightmesh".to_owned(), json!(scene_extras(scene)));
    }
    if !extensions.is_empty() {
        root["extensionsUsed"] = json!(extensions);
    }
    let mut entry = json!({"name": scene.name});
    // glTF forbids empty arrays and unnecessary empty objects.
    if !nodes.is_empty() {
        entry["nodes"] = (0..nodes.len()).collect();
        root["nodes"] = Value::Array(nodes);
    }
    if !extras.is_empty() {
        entry["extras"] = Value::Object(extras);
    }
    root["scenes"] = json!([entry]);
    container(&root, bin, path)
}

/// Header, JSON chunk and binary chunk, each padded to four bytes (glTF 2.0, section 4.4).
fn container(root: &Value, mut bin: Vec<u8>, path: &Path) -> Result<Vec<u8>, ExportError> {
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    bin.resize(bin.len().next_multiple_of(4), 0);
    let bin_chunk = if bin.is_empty() { 0 } else { 8 + bin.len() };
    let bytes = 20 + json.len() + bin_chunk;
    let length = u32::try_from(bytes).map_err(|_| ExportError::TooLarge { path: path.to_owned(), bytes })?;

    let mut glb = Vec::with_capacity(bytes);
    glb.extend(b"glTF");
    glb.extend(2u32.to_le_bytes());
    glb.extend(length.to_le_bytes());
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        glb.extend((data.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(data);
    };
    chunk(b"JSON", &json);
    if !bin.is_empty() {
        chunk(b"BIN\0", &bin);
    }
    Ok(glb)
}

fn scene_extras(scene: &Scene) -> SceneExtras {
    SceneExtras {
        origin: (scene.geometry.origin != DVec3::ZERO).then_some(scene.geometry.origin.to_array()),
        ambient: scene.lights.ambient.map(Vec3::into),
        background: scene.lights.background.map(Vec3::into),
        step: scene.light_mesh.step,
        radius: scene.light_mesh.radius,
        weight: scene.light_mesh.weight.map(|weight| weight.name().to_owned()),
    }
}
