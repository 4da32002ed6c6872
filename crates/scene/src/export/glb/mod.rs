//! A scene as binary glTF 2.0.
//!
//! Triangles keep their order: each run of triangles with the same material becomes a primitive. In this format a primitive has normals for
//! all of its vertices, of unit length, or for none: then it is flat. Flat triangles among others get the normals of their planes. Vertices
//! are stored in the local frame, below a node that is translated to the frame's origin.

use std::{collections::HashMap, path::Path};

use glam::{DVec3, Vec2, Vec3};
use serde_json::{Map, Value, json};

use super::error::{ExportError, refused};
use super::lights::{own_lights, toward_surface};
use super::pictures::Pictures;
use crate::build::shapes::tangents;
use crate::formats::gltf::extras::{
    CameraExtras, DielectricExtras, FacetExtras, LightExtras, MaterialExtras, OpacityExtras, SceneExtras, ShapeExtras,
};
use crate::model::transforms::upright;
use crate::{
    Camera, Dielectric, Falloff, Fov, Light, LightKind, Material, Mesh, Opacity, OpacityChannel, OpacityMode,
    Projection, Scene,
};

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
    if !scene.geometry.mesh.triangles.is_empty() {
        let pictures = Pictures::new(scene).map_err(|cause| refused(path, cause))?;
        root["materials"] =
            scene.geometry.materials.iter().enumerate().map(|(index, it)| material(it, index, &pictures)).collect();
        if pictures.transformed() {
            extensions.push("KHR_texture_transform");
        }
        let glass: Vec<_> = scene.geometry.materials.iter().filter_map(|material| material.dielectric).collect();
        if !glass.is_empty() {
            extensions.extend(["KHR_materials_ior", "KHR_materials_transmission"]);
        }
        if glass.iter().any(|glass| !glass.thin) {
            extensions.push("KHR_materials_volume");
        }
        let arrays = Arrays::new(&scene.geometry.mesh);
        (root["accessors"], root["bufferViews"], root["meshes"]) = arrays.describe();
        bin = arrays.into_bytes();
        pictures.write(scene, &mut bin, &mut root);
        root["buffers"] = json!([{"byteLength": bin.len()}]);
        nodes.push(json!({"name": scene.name, "mesh": 0, "translation": scene.geometry.origin.to_array()}));
    }
    let mut extras = Map::new();
    if content == Content::Everything {
        if !scene.cameras.is_empty() {
            root["cameras"] = scene.cameras.iter().map(|camera| camera_entry(scene, camera)).collect();
        }
        nodes.extend(scene.cameras.iter().enumerate().map(|(index, camera)| camera_node(scene, index, camera)));
        if own_lights(scene).next().is_some() {
            let lights: Value = own_lights(scene).map(light_entry).collect();
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

/// A run of triangles with the same material, as ranges of the shared arrays.
struct Primitive {
    material: u32,
    first_vertex: usize,
    vertices: usize,
    first_index: usize,
    indices: usize,
    has_normals: bool,
}

/// The normals of a triangle's corners, if each has one; else it is flat.
fn normals_of(mesh: &Mesh, triangle: &[u32; 3]) -> Option<[Vec3; 3]> {
    let normals = triangle.map(|vertex| mesh.normals.get(vertex as usize).copied().unwrap_or_default());
    (!normals.contains(&Vec3::ZERO)).then_some(normals)
}

/// The normal of a flat triangle, as exactly as it can be written.
fn plane_normal(mesh: &Mesh, triangle: &[u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize].as_dvec3());
    // A degenerate triangle has none, but the format asks for one.
    (b - a).cross(c - a).try_normalize().map_or(Vec3::Z, |normal| normal.as_vec3())
}

/// Indices of the buffer views, in the order of the bytes.
#[derive(Default)]
struct Views {
    normals: usize,
    uvs: usize,
    colors: usize,
}

/// The vertex and index arrays of all primitives, one after another.
#[derive(Default)]
struct Arrays {
    primitives: Vec<Primitive>,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    /// Three channels, or four with opacities.
    colors: Vec<f32>,
    channels: usize,
    indices: Vec<u32>,
}

impl Arrays {
    fn new(mesh: &Mesh) -> Arrays {
        let channels = if mesh.opacities.is_empty() { 3 } else { 4 };
        let mut arrays = Arrays { channels, ..Arrays::default() };
        let mut first = 0;
        for run in mesh.materials.chunk_by(|a, b| a == b) {
            arrays.add(mesh, &mesh.triangles[first..first + run.len()], run[0]);
            first += run.len();
        }
        arrays
    }

    fn add(&mut self, mesh: &Mesh, triangles: &[[u32; 3]], material: u32) {
        let (first_vertex, first_index) = (self.positions.len(), self.indices.len());
        let has_normals = triangles.iter().any(|triangle| normals_of(mesh, triangle).is_some());
        let mut renumbered = HashMap::new();
        for triangle in triangles {
            let normals = match normals_of(mesh, triangle) {
                Some(normals) => normals,
                None if has_normals => [plane_normal(mesh, triangle); 3],
                None => [Vec3::ZERO; 3],
            };
            for (vertex, normal) in triangle.iter().zip(normals) {
                let next = renumbered.len() as u32;
                let index = *renumbered.entry((vertex, normal.to_array().map(f32::to_bits))).or_insert_with(|| {
                    let vertex = *vertex as usize;
                    self.positions.push(mesh.positions[vertex].to_array());
                    self.normals.extend(mesh.normals.get(vertex).map(|_| normal.to_array()));
                    self.uvs.extend(mesh.uvs.get(vertex).map(|uv| uv.to_array()));
                    let opacity = mesh.opacities.get(vertex);
                    let color = mesh.colors.get(vertex).copied().or(opacity.map(|_| Vec3::ONE));
                    self.colors.extend(color.iter().flat_map(|color| color.to_array()));
                    self.colors.extend(opacity);
                    next
                });
                self.indices.push(index);
            }
        }
        self.primitives.push(Primitive {
            material,
            first_vertex,
            vertices: renumbered.len(),
            first_index,
            indices: 3 * triangles.len(),
            has_normals,
        });
    }

    /// Accessors, buffer views and the mesh.
    fn describe(&self) -> (Value, Value, Value) {
        let mut accessors = Vec::new();
        let mut accessor = |view: usize, kind: &str, component: u32, offset: usize, count: usize| {
            accessors.push(json!({"bufferView": view, "type": kind, "componentType": component,
                "byteOffset": offset, "count": count}));
            accessors.len() - 1
        };
        const FLOAT: u32 = 5126;
        const UNSIGNED_INT: u32 = 5125;
        let views = self.view_numbers();
        let mut primitives = Vec::new();
        let mut bounds = Vec::new();
        for primitive in &self.primitives {
            let (first, count) = (primitive.first_vertex, primitive.vertices);
            let position = accessor(0, "VEC3", FLOAT, 12 * first, count);
            bounds.push((position, bounds_of(&self.positions[first..first + count])));
            let mut attributes = json!({"POSITION": position});
            if primitive.has_normals {
                attributes["NORMAL"] = json!(accessor(views.normals, "VEC3", FLOAT, 12 * first, count));
            }
            if !self.uvs.is_empty() {
                attributes["TEXCOORD_0"] = json!(accessor(views.uvs, "VEC2", FLOAT, 8 * first, count));
            }
            if !self.colors.is_empty() {
                let kind = if self.channels == 4 { "VEC4" } else { "VEC3" };
                attributes["COLOR_0"] = json!(accessor(views.colors, kind, FLOAT, 4 * self.channels * first, count));
            }
            let indices = accessor(1, "SCALAR", UNSIGNED_INT, 4 * primitive.first_index, primitive.indices);
            primitives.push(json!({"attributes": attributes, "indices": indices, "material": primitive.material}));
        }
        for (index, [min, max]) in bounds {
            accessors[index]["min"] = json!(min);
            accessors[index]["max"] = json!(max);
        }
        (Value::Array(accessors), self.views(), json!([{"primitives": primitives}]))
    }

    /// Positions are in view 0, indices in view 1.
    fn view_numbers(&self) -> Views {
        let normals = 2;
        let uvs = normals + usize::from(!self.normals.is_empty());
        Views { normals, uvs, colors: uvs + usize::from(!self.uvs.is_empty()) }
    }

    /// Positions, indices, and any normals, texture coordinates and colours: the order of the bytes.
    fn views(&self) -> Value {
        let mut offset = 0;
        let arrays = [
            (12 * self.positions.len(), 34962),
            (4 * self.indices.len(), 34963),
            (12 * self.normals.len(), 34962),
            (8 * self.uvs.len(), 34962),
            (4 * self.colors.len(), 34962),
        ];
        let views = arrays.into_iter().filter(|(length, _)| *length > 0).map(|(length, target)| {
            let view = json!({"buffer": 0, "byteOffset": offset, "byteLength": length, "target": target});
            offset += length;
            view
        });
        views.collect()
    }

    fn into_bytes(self) -> Vec<u8> {
        let mut bytes = Vec::new();
        bytes.extend(self.positions.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend(self.indices.iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend(self.normals.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend(self.uvs.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend(self.colors.iter().flat_map(|x| x.to_le_bytes()));
        bytes
    }
}

fn bounds_of(positions: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let bounds = crate::Bounds::around(positions.iter().map(|&position| Vec3::from(position)));
    [bounds.min.to_array(), bounds.max.to_array()]
}

/// Metallic-roughness for other programs (the inverse of the lobe in `formats::gltf::material`), our coefficients in the
/// extras.
fn material(material: &Material, index: usize, pictures: &Pictures) -> Value {
    let clamped = |color: Vec3| color.clamp(Vec3::ZERO, Vec3::ONE).to_array();
    let [r, g, b] = clamped(material.kd);
    let matt = material.ks == Vec3::ZERO && material.dielectric.is_none();
    let (metallic, roughness) = match material.faceted() {
        Some(facets) => (facets.metallic, facets.roughness),
        None if matt => (0.0, 1.0),
        None if material.dielectric.is_some() => (0.0, 0.0),
        None => (0.0, (2.0 / (material.shininess + 2.0)).powf(0.25)),
    };
    let [texture_transform, emission_transform, normal_transform, metallic_roughness_transform] =
        pictures.exact_transforms(index);
    let extras = MaterialExtras {
        ka: material.ka.to_array(),
        kd: material.kd.to_array(),
        ks: material.ks.to_array(),
        shininess: material.shininess,
        emission: material.emission.to_array(),
        ks_tinted: material.ks_tinted.to_array(),
        emission_tinted: material.emission_tinted.to_array(),
        catcher: material.catcher,
        lamp: material.lamp,
        texture_transform,
        emission_transform,
        normal_transform,
        metallic_roughness_transform,
        opacity: material
            .opacity
            .filter(|opacity| !is_standard(opacity, material))
            .map(|it| opacity_extras(&it, index, pictures)),
        dielectric: material.dielectric.map(DielectricExtras::from),
        facets: material.facets.map(FacetExtras::from),
    };
    // What is shown as it is has no image of emitted light that would be multiplied with this.
    let shown =
        if material.texture.is_none() { material.emission + material.emission_tinted } else { material.emission };
    let mut entry = json!({
        "name": material.name,
        "pbrMetallicRoughness":
            {"baseColorFactor": [r, g, b, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness},
        "emissiveFactor": clamped(shown),
        "doubleSided": !material.one_sided,
        "extras": {"lightmesh": extras},
    });
    if let Some(texture) = pictures.of_material(index) {
        entry["pbrMetallicRoughness"]["baseColorTexture"] = texture;
    }
    if let Some(texture) = pictures.roughness_of_material(index) {
        entry["pbrMetallicRoughness"]["metallicRoughnessTexture"] = texture;
    }
    if let Some(texture) = pictures.emission_of_material(index) {
        entry["emissiveTexture"] = texture;
    }
    if let Some((mut texture, map)) = pictures.normals_of_material(index).zip(material.normal_texture) {
        texture["scale"] = json!(map.scale);
        entry["normalTexture"] = texture;
    }
    if let Some(opacity) = material.opacity.filter(|opacity| is_standard(opacity, material)) {
        match opacity.mode {
            OpacityMode::Mask { cutoff } => {
                entry["alphaMode"] = json!("MASK");
                entry["alphaCutoff"] = json!(cutoff);
            }
            OpacityMode::Blend { .. } => entry["alphaMode"] = json!("BLEND"),
        }
        entry["pbrMetallicRoughness"]["baseColorFactor"][3] = json!(opacity.factor);
    }
    if let Some((dielectric, opacity)) = material.dielectric.zip(material.opacity) {
        entry["extensions"] = transmission(&dielectric, &opacity);
        let [r, g, b] = clamped(opacity.filter().unwrap_or(Vec3::ONE));
        entry["pbrMetallicRoughness"]["baseColorFactor"] = json!([r, g, b, 1.0]);
    }
    entry
}

/// Glass for other programs.
fn transmission(Dielectric { ior, thin, absorption }: &Dielectric, opacity: &Opacity) -> Value {
    let mut extensions = json!({
        "KHR_materials_ior": {"ior": ior},
        "KHR_materials_transmission": {"transmissionFactor": 1.0 - opacity.factor},
    });
    if !thin {
        let left = absorption.map(|channel| (-channel).exp()).to_array();
        extensions["KHR_materials_volume"] =
            json!({"thicknessFactor": 1.0, "attenuationColor": left, "attenuationDistance": 1.0});
    }
    extensions
}

/// Whether an `alphaMode` says the same.
fn is_standard(opacity: &Opacity, material: &Material) -> bool {
    let alpha = opacity.texture.is_none() || opacity.channel == OpacityChannel::Alpha;
    alpha
        && material.dielectric.is_none()
        && opacity.texture == material.texture
        && opacity.filter().is_none_or(|filter| filter == Vec3::ONE)
}

fn opacity_extras(opacity: &Opacity, index: usize, pictures: &Pictures) -> OpacityExtras {
    let found = pictures.opacity_of_material(index);
    OpacityExtras {
        factor: opacity.factor,
        cutoff: match opacity.mode {
            OpacityMode::Mask { cutoff } => Some(cutoff),
            OpacityMode::Blend { .. } => None,
        },
        filter: opacity.filter().map(|filter| filter.to_array()),
        texture: found.map(|(texture, _)| texture as u32),
        transform: found.map(|(_, uses)| uses.transform.to_cols_array()),
        channel: found.map(|_| opacity.channel.name().to_owned()),
    }
}

fn camera_entry(scene: &Scene, camera: &Camera) -> Value {
    // Other programs need clipping planes: wide enough to contain the scene from anywhere near it.
    let size = f64::from(scene.geometry.mesh.bounds().diagonal()).max(1.0);
    let shift = (camera.shift != Vec2::ZERO).then_some(camera.shift.to_array());
    let mut own = CameraExtras { shift, ..CameraExtras::default() };
    let mut entry = match camera.projection {
        Projection::Perspective(fov) => {
            let radians = match fov {
                Fov::Vertical(degrees) => f64::from(degrees).to_radians(),
                Fov::Horizontal(_) => f64::from(fov.vertical(1.0)).to_radians(),
            };
            if let Fov::Horizontal(hfov) = fov {
                own.hfov = Some(hfov);
            }
            json!({"type": "perspective", "perspective": {"yfov": radians, "znear": 1e-4 * size}})
        }
        Projection::Orthographic { height } => {
            let mag = 0.5 * f64::from(height);
            let planes = json!({"xmag": mag, "ymag": mag, "znear": 0.0, "zfar": 100.0 * size});
            json!({"type": "orthographic", "orthographic": planes})
        }
    };
    if own != CameraExtras::default() {
        entry["extras"] = json!({"lightmesh": own});
    }
    entry
}

fn camera_node(scene: &Scene, index: usize, camera: &Camera) -> Value {
    let direction = camera.direction.as_dvec3();
    let up = upright(direction, camera.up.as_dvec3()).unwrap_or(camera.up.as_dvec3());
    json!({"name": camera.name, "camera": index, "matrix": look(scene.to_world(camera.position), direction, up)})
}

fn light_entry(light: &Light) -> Value {
    let strongest = f64::from(light.intensity.max_element());
    let color = if strongest > 0.0 { light.intensity.as_dvec3() / strongest } else { DVec3::ONE };
    let shape = match light.kind {
        LightKind::Sphere { radius, .. } => Some(ShapeExtras::Sphere { radius }),
        LightKind::Disk { normal, radius, .. } => {
            Some(ShapeExtras::Disk { normal: light.surface.unwrap_or(normal).to_array(), radius })
        }
        LightKind::Rectangle { half_u, half_v, .. } => {
            let half_v = toward_surface(light, half_u, half_v);
            Some(ShapeExtras::Rectangle { half_u: half_u.to_array(), half_v: half_v.to_array() })
        }
        _ => None,
    };
    let spread = match light.kind {
        LightKind::Point { spread, .. } if spread > 0.0 => Some(spread),
        _ => None,
    };
    let angle = match light.kind {
        LightKind::Directional { angle, .. } if angle > 0.0 => Some(angle),
        _ => None,
    };
    let radius = match light.kind {
        LightKind::Spot { radius, .. } if radius > 0.0 => Some(radius),
        _ => None,
    };
    let kind = match light.kind {
        LightKind::Directional { .. } => "directional",
        LightKind::Spot { .. } => "spot",
        _ => "point",
    };
    let (one_sided, no_falloff) = (light.surface.is_some(), light.falloff == Falloff::None);
    let extras = LightExtras { shape, spread, angle, radius, one_sided, no_falloff };
    let mut entry = json!({"name": light.name, "type": kind, "color": color.to_array(), "intensity": strongest});
    if extras != LightExtras::default() {
        entry["extras"] = json!({"lightmesh": extras});
    }
    if let LightKind::Spot { inner, outer, .. } = light.kind {
        entry["spot"] = json!({"innerConeAngle": inner, "outerConeAngle": outer});
    }
    entry
}

/// Directional lights store their direction in the node; the extras of area lights are in the node's frame.
fn light_node(scene: &Scene, index: usize, light: &Light) -> Value {
    let world = light.position().map_or(DVec3::ZERO, |position| scene.to_world(position));
    let mut node = json!({"name": light.name, "extensions": {"KHR_lights_punctual": {"light": index}}});
    match light.kind {
        LightKind::Directional { direction, .. } | LightKind::Spot { direction, .. } => {
            let direction = direction.as_dvec3();
            node["matrix"] = json!(look(world, direction, tangents(direction).1));
        }
        _ => node["translation"] = json!(world.to_array()),
    }
    node
}

/// The matrix, by columns, of a node that looks along `direction`.
fn look(position: DVec3, direction: DVec3, up: DVec3) -> [f64; 16] {
    let columns = [(direction.cross(up), 0.0), (up, 0.0), (-direction, 0.0), (position, 1.0)];
    let mut matrix = [0.0; 16];
    for (column, (vector, w)) in matrix.chunks_exact_mut(4).zip(columns) {
        column.copy_from_slice(&vector.extend(w).to_array());
    }
    matrix
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
