//! Wavefront OBJ with MTL.
//!
//! Not based on tobj, which, with a check of each line before it, took four times as long and six times the file's size in memory.
//!
//! - Every combination of position, texture coordinate and normal becomes one vertex. A corner without a normal makes its whole face
//!   flat, one without a texture coordinate removes the texture from it.
//! - Texture coordinates have v upwards in these files and are flipped.
//! - Colours after a position's coordinates (`v x y z r g b`) are treated as sRGB in [0, 1], as Blender and MeshLab write
//!   them; if one is above 1, their range is 0 to 255. A fourth coordinate w is the weight of free-form surfaces and has
//!   no meaning for faces.
//! - What other programs read is read with a warning: faces above their points, indices of attributes that the file lacks, words behind
//!   numbers. What may mean several things, such as `1,5`, is an error.
//! - Smoothing groups (`s`) matter for smooth normals, which faces get if no face of the file has normals and the options ask for them. Faces
//!   above the first `s` of a file are in no group, if there is one; without any, all are in the same.
//! - Points, lines and free-form surfaces are ignored with a warning; groups of other kinds have no effect.

mod error;
mod face;
pub(crate) mod lines;
pub(crate) mod map;
mod mtl;
mod parse;
pub(crate) mod smoothing;

use std::{
    collections::{HashMap, HashSet},
    path::Path,
};

use glam::{DVec3, Vec2, Vec3};

use self::parse::{Content, Points};
use super::{
    text,
    vertices::{Corner, NONE},
};
use crate::build::draft::Draft;
use crate::build::loaded_mesh::LoadedMesh;
use crate::build::placement::Placement;
use crate::build::quote::list;
use crate::model::colors;
use crate::{LoadError, Objects};

/// Reads an OBJ file and its material libraries into `draft`.
pub(crate) fn read(path: &Path, mut bytes: Vec<u8>, placement: &Placement, draft: &mut Draft) -> Result<(), LoadError> {
    draft.access.check_content(path, &bytes)?;
    let mut content = parse::parse(path, text::with_line_feeds(&mut bytes), draft.smooths())?;
    // From here on its memory is needed for the vertices.
    drop(bytes);
    draft.warnings.extend(std::mem::take(&mut content.warnings));
    let mut materials = std::mem::take(&mut content.material_of_triangle);
    match placement.material {
        Some(material) => {
            mtl::refer(path, &content.libraries, draft);
            materials.fill(material);
        }
        None => {
            let indices = find_materials(path, &content, draft)?;
            materials.iter_mut().for_each(|material| *material = indices[*material as usize]);
        }
    }
    if placement.object.is_some() {
        content.objects = Objects::default();
    }
    let mesh = mesh(content, materials);
    draft.begin_object(placement.object_in(path));
    draft.take(mesh, &placement.transform)
}

/// The scene's index of each material that the file uses. All materials of the libraries are in the scene.
fn find_materials(path: &Path, content: &Content, draft: &mut Draft) -> Result<Vec<u32>, LoadError> {
    let entries = mtl::read_libraries(path, &content.libraries, draft)?;
    let first = draft.materials.len() as u32;
    let mut by_name = HashMap::new();
    for (index, entry) in entries.iter().enumerate() {
        by_name.entry(entry.name.as_str()).or_insert(index);
    }
    let found: Vec<Option<usize>> = content.materials.iter().map(|name| by_name.get(name.as_str()).copied()).collect();
    let used: HashSet<usize> = found.iter().copied().flatten().collect();
    for (index, entry) in entries.iter().enumerate() {
        let material = entry.material(used.contains(&index), draft);
        draft.materials.push(material);
    }
    let missing: Vec<&str> = content
        .materials
        .iter()
        .zip(&found)
        .filter(|(_, found)| found.is_none())
        .map(|(name, _)| name.as_str())
        .filter(|name| !name.is_empty())
        .collect();
    if !missing.is_empty() {
        let names = list(missing.iter().map(|name| name.as_ref()));
        draft.warnings.push(format!("{}: no library has the material {names}; light grey is used", path.display()));
    }
    Ok(found
        .into_iter()
        .map(|found| found.map_or_else(|| draft.default_material(), |index| first + index as u32))
        .collect())
}

/// The vertices that faces use, with the attributes that any of them has.
fn mesh(content: Content, materials: Vec<u32>) -> LoadedMesh<DVec3> {
    let Content { points, corners, triangles, groups, objects, .. } = content;
    let Points { positions, uvs, normals, colors } = points;
    let has = |kind: usize| corners.iter().any(|corner| corner[kind] != NONE);
    let at = |corner: &Corner, kind: usize| Some(corner[kind] as usize).filter(|_| corner[kind] != NONE);
    let gathered =
        |kind: usize| has(kind).then_some(&corners).into_iter().flatten().map(move |corner| at(corner, kind));
    let colors = linear_colors(colors);
    LoadedMesh {
        uvs: gathered(1).map(|uv| uv.map_or(Vec2::ZERO, |uv| uvs[uv])).collect(),
        normals: gathered(2).map(|normal| normal.map_or(Vec3::ZERO, |normal| normals[normal])).collect(),
        colors: if colors.is_empty() {
            Vec::new()
        } else {
            corners.iter().map(|corner| colors[corner[0] as usize]).collect()
        },
        positions: corners.iter().map(|corner| positions[corner[0] as usize]).collect::<Vec<DVec3>>(),
        triangles,
        materials,
        groups,
        objects,
    }
}

/// The file's colours, converted to linear; a position without one is white.
fn linear_colors(encoded: Vec<Vec3>) -> Vec<Vec3> {
    let largest = encoded.iter().fold(1.0, |largest: f32, color| largest.max(color.max_element()));
    let scale = if largest > 1.0 { 255.0 } else { 1.0 };
    let linear = |color: Vec3| if color.is_nan() { Vec3::ONE } else { colors::linear(color / scale) };
    encoded.into_iter().map(linear).collect()
}
