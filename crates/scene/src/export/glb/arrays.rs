//! The vertex and index arrays of a GLB file, and the accessors and buffer views that describe them.
//!
//! A primitive has normals for all of its vertices, of unit length, or for none: then it is flat. Flat triangles among others get the normals of
//! their planes. Texture coordinates and colours are left out where they say nothing.

use std::collections::HashMap;
use std::ops::Range;

use glam::{DAffine3, Vec2, Vec3};
use serde_json::{Value, json};

use crate::{Bounds, Geometry, Instance, Material, Mesh};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Where the values of a primitive begin in an array, and how many numbers each of its vertices has there; 0 if it has none.
#[derive(Clone, Copy, Default, PartialEq)]
struct Part {
    first: usize,
    width: usize,
}

/// Triangles of one material.
struct Primitive {
    material: u32,
    first_vertex: usize,
    vertices: usize,
    indices: Range<usize>,
    normals: Part,
    uvs: Part,
    colors: Part,
}

/// A mesh of the file: its name and its primitives.
struct Written {
    name: String,
    primitives: Range<usize>,
}

/// The bytes of all primitives, one after another, by kind.
#[derive(Default)]
pub(super) struct Arrays {
    primitives: Vec<Primitive>,
    meshes: Vec<Written>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    /// Without opacities.
    colors: Vec<[f32; 3]>,
    /// With opacities.
    tints: Vec<[f32; 4]>,
    indices: Vec<u32>,
    /// Scale, rotation and translation of instances.
    scales: Vec<[f32; 3]>,
    rotations: Vec<[f32; 4]>,
    translations: Vec<[f32; 3]>,
    /// Where each list of instances lies in these.
    lists: Vec<Range<usize>>,
}

/// Triangles that become a primitive, by their stored numbers, and how they are changed.
#[derive(Clone, Copy)]
pub(super) struct Triangles<'a> {
    pub(super) numbers: &'a [u32],
    /// Whether the order of corners is reversed.
    pub(super) reversed: bool,
    /// The instance that places them, if they are written where they are.
    pub(super) placed: Option<&'a Instance>,
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

/// Whether opacities of vertices count.
fn counts_opacities(material: Option<&Material>) -> bool {
    material.is_some_and(|material| material.opacity.is_some())
}

impl Arrays {
    /// Adds a mesh of these triangles, a primitive for each material, and returns its number.
    pub(super) fn add_mesh(&mut self, geometry: &Geometry, name: &str, triangles: Triangles) -> usize {
        let first = self.primitives.len();
        let mut order: HashMap<u32, usize> = HashMap::new();
        let mut parts: Vec<(u32, Vec<u32>)> = Vec::new();
        for &number in triangles.numbers {
            let material = geometry.mesh.materials[number as usize];
            let part = *order.entry(material).or_insert_with(|| {
                parts.push((material, Vec::new()));
                parts.len() - 1
            });
            parts[part].1.push(number);
        }
        for (material, numbers) in &parts {
            self.add(geometry, *material, Triangles { numbers, ..triangles });
        }
        self.meshes.push(Written { name: name.to_owned(), primitives: first..self.primitives.len() });
        self.meshes.len() - 1
    }

    fn add(&mut self, Geometry { mesh, materials, .. }: &Geometry, material: u32, triangles: Triangles) {
        let own = materials.get(material as usize);
        let stored = || {
            triangles.numbers.iter().map(|&number| {
                let [a, b, c] = mesh.triangles[number as usize];
                if triangles.reversed { [a, c, b] } else { [a, b, c] }
            })
        };
        let vertices = || stored().flatten().map(|vertex| vertex as usize);
        let has_normals = stored().any(|triangle| normals_of(mesh, &triangle).is_some());
        let needs_uvs = own.is_some_and(Material::needs_uvs);
        let has_uvs = !mesh.uvs.is_empty() && (needs_uvs || vertices().any(|vertex| mesh.uvs[vertex] != Vec2::ZERO));
        let has_opacities = counts_opacities(own)
            && !mesh.opacities.is_empty()
            && vertices().any(|vertex| mesh.opacities[vertex] != 1.0);
        let has_colors =
            has_opacities || (!mesh.colors.is_empty() && vertices().any(|vertex| mesh.colors[vertex] != Vec3::ONE));
        let part = |exists: bool, first: usize, width: usize| Part { first, width: if exists { width } else { 0 } };
        let (first_vertex, first_index) = (self.positions.len(), self.indices.len());
        let normals = part(has_normals, self.normals.len(), 3);
        let uvs = part(has_uvs, self.uvs.len(), 2);
        let colors = match has_opacities {
            true => part(true, self.tints.len(), 4),
            false => part(has_colors, self.colors.len(), 3),
        };
        let mut renumbered = HashMap::new();
        for triangle in stored() {
            let corners = match normals_of(mesh, &triangle) {
                Some(normals) => normals,
                None if has_normals => [plane_normal(mesh, &triangle); 3],
                None => [Vec3::ZERO; 3],
            };
            let mut written = [0; 3];
            for ((vertex, normal), written) in triangle.into_iter().zip(corners).zip(&mut written) {
                let next = renumbered.len() as u32;
                *written = *renumbered.entry((vertex, normal.to_array().map(f32::to_bits))).or_insert_with(|| {
                    let vertex = vertex as usize;
                    let place = triangles.placed;
                    self.positions
                        .push(place.map_or(mesh.positions[vertex], |it| it.place.point(mesh.positions[vertex])));
                    if has_normals {
                        self.normals.push(place.map_or(normal, |it| it.back.normal_back(normal)));
                    }
                    if has_uvs {
                        self.uvs.push(mesh.uvs[vertex]);
                    }
                    // The format allows no more than 1.
                    let color = mesh.colors.get(vertex).copied().unwrap_or(Vec3::ONE).clamp(Vec3::ZERO, Vec3::ONE);
                    if has_opacities {
                        self.tints.push(color.extend(mesh.opacities[vertex].clamp(0.0, 1.0)).to_array());
                    } else if has_colors {
                        self.colors.push(color.to_array());
                    }
                    next
                });
            }
            self.indices.extend(written);
        }
        let (vertices, indices) = (renumbered.len(), first_index..self.indices.len());
        self.primitives.push(Primitive { material, first_vertex, vertices, indices, normals, uvs, colors });
    }

    /// The number of a mesh that has the same content as this one, which was added last, and is then left out again.
    pub(super) fn merged(&mut self, mesh: usize, others: &[usize]) -> usize {
        let Some(&same) = others.iter().find(|&&other| self.are_same(other, mesh)) else { return mesh };
        let first = self.meshes[mesh].primitives.start;
        let Some(from) = self.primitives.get(first) else { return mesh };
        self.positions.truncate(from.first_vertex);
        self.indices.truncate(from.indices.start);
        self.normals.truncate(from.normals.first);
        self.uvs.truncate(from.uvs.first);
        let first_of = |width: usize, otherwise: usize| {
            let with = self.primitives[first..].iter().filter(|it| it.colors.width == width);
            with.map(|primitive| primitive.colors.first).min().unwrap_or(otherwise)
        };
        let (colors, tints) = (first_of(3, self.colors.len()), first_of(4, self.tints.len()));
        self.colors.truncate(colors);
        self.tints.truncate(tints);
        self.primitives.truncate(first);
        self.meshes.truncate(mesh);
        same
    }

    fn are_same(&self, one: usize, other: usize) -> bool {
        let [one, other] = [one, other].map(|mesh| &self.primitives[self.meshes[mesh].primitives.clone()]);
        one.len() == other.len() && one.iter().zip(other).all(|(one, other)| self.content(one) == self.content(other))
    }

    /// All that a primitive consists of.
    fn content<'a>(&'a self, primitive: &Primitive) -> impl PartialEq + use<'a> {
        fn of<T>(values: &[T], Part { first, width }: Part, count: usize) -> &[T] {
            if width > 0 { &values[first..first + count] } else { &[] }
        }
        let (count, colors) = (primitive.vertices, primitive.colors);
        let only = |width: usize| if colors.width == width { colors } else { Part::default() };
        (
            (primitive.material, &self.indices[primitive.indices.clone()]),
            &self.positions[primitive.first_vertex..primitive.first_vertex + count],
            (of(&self.normals, primitive.normals, count), of(&self.uvs, primitive.uvs, count)),
            (of(&self.colors, only(3), count), of(&self.tints, only(4), count)),
        )
    }

    /// Adds a list of instances and returns its number.
    pub(super) fn add_instances(&mut self, places: impl Iterator<Item = DAffine3>) -> usize {
        let first = self.scales.len();
        for place in places {
            let (scale, rotation, translation) = place.to_scale_rotation_translation();
            self.scales.push(scale.as_vec3().to_array());
            self.rotations.push(rotation.as_quat().normalize().to_array());
            self.translations.push(translation.as_vec3().to_array());
        }
        self.lists.push(first..self.scales.len());
        self.lists.len() - 1
    }

    /// Describes all in `root`, and returns the attributes of each list of instances.
    pub(super) fn describe(&self, root: &mut Value) -> Vec<Value> {
        let mut accessors = Accessors::default();
        let views = self.views();
        let of = |array: Array| views.iter().take_while(|(other, ..)| *other != array).count();
        let mut meshes = Vec::new();
        for Written { name, primitives } in &self.meshes {
            let mut written = Vec::new();
            for it in &self.primitives[primitives.clone()] {
                let (first, count) = (it.first_vertex, it.vertices);
                let position = accessors.add(of(Array::Positions), "VEC3", FLOAT, 12 * first, count);
                accessors.bound(position, &self.positions[first..first + count]);
                let mut attributes = json!({"POSITION": position});
                let mut attribute = |name: &str, array: Array, Part { first, width }: Part| {
                    if width > 0 {
                        let kind = ["VEC2", "VEC3", "VEC4"][width - 2];
                        attributes[name] = json!(accessors.add(of(array), kind, FLOAT, 4 * width * first, count));
                    }
                };
                attribute("NORMAL", Array::Normals, it.normals);
                attribute("TEXCOORD_0", Array::Uvs, it.uvs);
                attribute("COLOR_0", if it.colors.width == 4 { Array::Tints } else { Array::Colors }, it.colors);
                let indices =
                    accessors.add(of(Array::Indices), "SCALAR", UNSIGNED_INT, 4 * it.indices.start, it.indices.len());
                written.push(json!({"attributes": attributes, "indices": indices, "material": it.material}));
            }
            meshes.push(json!({"name": name, "primitives": written}));
        }
        let lists = self.lists.iter().map(|list| {
            let mut add = |array: Array, kind: &str, size: usize| {
                accessors.add(of(array), kind, FLOAT, size * list.start, list.len())
            };
            json!({
                "TRANSLATION": add(Array::Translations, "VEC3", 12),
                "ROTATION": add(Array::Rotations, "VEC4", 16),
                "SCALE": add(Array::Scales, "VEC3", 12),
            })
        });
        let lists = lists.collect();
        let mut offset = 0;
        let views = views.iter().map(|&(array, length, stride)| {
            let mut view = json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
            offset += length;
            match array {
                Array::Indices => view["target"] = json!(ELEMENT_ARRAY_BUFFER),
                // Several accessors share the view: it must say how far its elements are apart.
                _ => {
                    view["byteStride"] = json!(stride);
                    view["target"] = json!(ARRAY_BUFFER);
                }
            }
            view
        });
        root["bufferViews"] = views.collect();
        root["accessors"] = Value::Array(accessors.list);
        root["meshes"] = Value::Array(meshes);
        lists
    }

    /// The arrays that there are, with the length of each and of its elements: the order of the bytes.
    fn views(&self) -> Vec<(Array, usize, usize)> {
        let all = [
            (Array::Positions, self.positions.len(), 12),
            (Array::Indices, self.indices.len(), 4),
            (Array::Normals, self.normals.len(), 12),
            (Array::Uvs, self.uvs.len(), 8),
            (Array::Colors, self.colors.len(), 12),
            (Array::Tints, self.tints.len(), 16),
            (Array::Translations, self.translations.len(), 12),
            (Array::Rotations, self.rotations.len(), 16),
            (Array::Scales, self.scales.len(), 12),
        ];
        let used = all.into_iter().filter(|(_, count, _)| *count > 0);
        used.map(|(array, count, size)| (array, count * size, size)).collect()
    }

    /// The bytes in the order of the [views](Arrays::views).
    pub(super) fn into_bytes(self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.views().iter().map(|(_, length, _)| length).sum());
        let mut add = |values: &[f32]| bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        add(bytemuck::cast_slice(&self.positions));
        // The same bytes as a whole number's.
        add(bytemuck::cast_slice(&self.indices));
        add(bytemuck::cast_slice(&self.normals));
        add(bytemuck::cast_slice(&self.uvs));
        add(self.colors.as_flattened());
        add(self.tints.as_flattened());
        add(self.translations.as_flattened());
        add(self.rotations.as_flattened());
        add(self.scales.as_flattened());
        bytes
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Array {
    Positions,
    Indices,
    Normals,
    Uvs,
    Colors,
    Tints,
    Translations,
    Rotations,
    Scales,
}

/// The accessors so far.
#[derive(Default)]
struct Accessors {
    list: Vec<Value>,
}

impl Accessors {
    fn add(&mut self, view: usize, kind: &str, component: u32, offset: usize, count: usize) -> usize {
        self.list.push(json!({"bufferView": view, "type": kind, "componentType": component, "byteOffset": offset,
            "count": count}));
        self.list.len() - 1
    }

    /// The format asks for the bounds of positions.
    fn bound(&mut self, accessor: usize, positions: &[Vec3]) {
        let bounds = Bounds::around(positions.iter().copied());
        self.list[accessor]["min"] = json!(bounds.min.to_array());
        self.list[accessor]["max"] = json!(bounds.max.to_array());
    }
}
