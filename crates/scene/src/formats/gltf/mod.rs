//! glTF 2.0 and GLB: triangles of the node hierarchy, materials with their base colour textures, cameras and punctual lights.
//!
//! Implemented on `serde_json` alone, because the `gltf` crate keeps nodes as `f32`, rejects extensions that we support, copies
//! the binary chunk, and reads accessors element by element.
//!
//! 1. [`container`]: the bytes are read once; JSON and binary chunk are slices of them.
//! 2. [`document`]: the JSON, with numbers in double precision, of which some may be [`integers`]; [`extensions`]: whether the file
//!    can be read.
//! 3. [`nodes`], [`instances`]: the placement of everything.
//! 4. [`materials`] of [`material`] and [`picture`].
//! 5. [`meshes`] through [`accessor`], [`strided`] and [`buffers`]: counted first, then added; data stored in the required
//!    form is borrowed.
//! 6. [`views`]: [`cameras`], [`lights`], what surrounds all ([`environment`]), and our own [`extras`].
//!
//! 7. What moves: [`animations`] of the nodes as a rig ([`rigged`]); what [`bends`] a mesh. The scene itself is shown as its nodes are
//!    placed.
//!
//! Content that is not shown is counted in [`left_out`] and reported as a warning.

mod accessor;
mod animations;
mod bends;
mod buffers;
mod cameras;
mod container;
mod document;
mod environment;
mod extensions;
pub(crate) mod extras;
mod instances;
pub(crate) mod integers;
mod left_out;
mod lights;
mod material;
mod materials;
pub(crate) mod meshes;
mod nodes;
pub(crate) mod picture;
mod rigged;
pub(crate) mod strided;
pub(crate) mod uri;
mod views;

use std::path::Path;

use glam::{DVec3, Vec3};
pub(crate) use picture::affine;

use self::{
    accessor::Accessors,
    bends::Bends,
    buffers::Buffers,
    container::{Container, malformed},
    document::{Document, Node},
    extras::SceneExtras,
    left_out::LeftOut,
    materials::Materials,
    meshes::{Meshes, Shown},
    nodes::Placed,
    picture::Pictures,
    rigged::Rigged,
    uri::Uri,
    views::Views,
};
use crate::build::draft::Draft;
use crate::build::placement::Placement;
use crate::build::quote::quote;
use crate::model::transforms::is_place;
use crate::{LightMeshDefaults, LoadError};

/// Reads a glTF or GLB file into `draft`.
pub(crate) fn read(path: &Path, bytes: Vec<u8>, placement: &Placement, draft: &mut Draft) -> Result<(), LoadError> {
    let container = Container::split(path, &bytes)?;
    let document = container.parse(path, &mut draft.warnings)?;
    extensions::check(path, &document, draft)?;
    refer(path, &document, draft);
    let buffers = Buffers::new(path, &document, container.bin, &draft.access)?;
    let accessors = Accessors { path, document: &document, buffers: &buffers };
    let strides_of_zero = document.buffer_views.iter().filter(|view| view.byte_stride == Some(0)).count();
    let mut left_out = LeftOut { strides_of_zero, ..LeftOut::default() };

    let pictures = Pictures::new(path, &document, &buffers);
    let mut materials = Materials::read(path, &document, pictures, placement, &mut left_out, draft)?;
    let placed = nodes::placed(path, &document, placement.transform, draft)?;
    // What this file adds goes with its own nodes.
    let mover = draft.mover.take();
    let bends = placed.iter().any(|placed| placed.node.skin.is_some() || is_morphed(&document, placed.node));
    let mut rigged = Rigged::new(&accessors, &placed, placement, mover, bends, &mut left_out, draft)?;
    let shown = shown(&accessors, &placed, &mut rigged)?;
    Meshes::new(accessors).add(&shown, &rigged, &mut materials, &mut left_out, placement.object.as_deref(), draft)?;
    draft.empties.extend(placed.iter().filter_map(Placed::empty));
    if placement.part {
        left_out.count_views(&placed);
    } else {
        Views::new(path, &document).add(&placed, &rigged, &mut left_out, draft)?;
        environment::read(path, &document, &buffers, draft)?;
        read_scene_extras(path, &document, draft)?;
    }
    left_out.warn(path, draft);
    draft.mover = mover;
    Ok(())
}

/// Notes all files of buffers and images, although only those in use are read.
fn refer(path: &Path, document: &Document, draft: &mut Draft) {
    let buffers = document.buffers.iter().filter_map(|buffer| buffer.uri.as_deref());
    let images = document.images.iter().filter_map(|image| image.uri.as_deref());
    for uri in buffers.chain(images) {
        if let Uri::File(name) = Uri::new(uri) {
            draft.refer(path, &name);
        }
    }
}

/// The meshes of all nodes.
fn shown<'a>(
    accessors: &Accessors<'a>,
    placed: &[Placed<'a>],
    rigged: &mut Rigged,
) -> Result<Vec<Shown<'a>>, LoadError> {
    let mut all = Vec::new();
    for &Placed { index, node, transform, .. } in placed {
        let Some(mesh) = node.mesh else { continue };
        let instancing = node.extensions.as_ref().and_then(|extensions| extensions.instancing.as_ref());
        let instances = match instancing {
            Some(instancing) => Some((instances::count(accessors, index, instancing)?, instancing)),
            None => None,
        };
        let skin = node.skin.map(|skin| rigged.skin(accessors, skin)).transpose()?;
        let bends = Bends::new(weights_of(accessors.document, node), skin, rigged.weights(index));
        all.push(Shown { mesh, node: (index, node.name.as_deref()), transform, instances, bends, moves: true });
    }
    Ok(all)
}

/// Whether morph targets change the mesh.
fn is_morphed(document: &Document, node: &Node) -> bool {
    weights_of(document, node).iter().any(|&weight| weight != 0.0)
}

/// Weights of the morph targets of a node's mesh: the node's own, or else the mesh's.
fn weights_of<'a>(document: &'a Document, node: &'a Node) -> &'a [f64] {
    let mesh = node.mesh.and_then(|mesh| document.meshes.get(mesh as usize));
    if node.weights.is_empty() { mesh.map_or(&[], |mesh| &mesh.weights) } else { &node.weights }
}

/// Ambient term, background and similar properties, from our own extras.
fn read_scene_extras(path: &Path, document: &Document, draft: &mut Draft) -> Result<(), LoadError> {
    let scene = nodes::scene_index(document).and_then(|index| document.scenes.get(index));
    let extras = scene.and_then(|scene| scene.extras);
    let Some(own) = extras::read::<SceneExtras>(path, "the scene", extras)? else { return Ok(()) };
    let damaged = |problem: String| malformed(path, format!("extras.lightmesh of the scene {problem}"));
    if let Some(origin) = own.origin.map(DVec3::from) {
        if !is_place(origin) {
            return Err(damaged(format!("has the origin {origin}")));
        }
        draft.prefer_origin(origin);
    }
    for (key, value) in [("step", own.step), ("radius", own.radius)] {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
            return Err(damaged(format!("has {key} = {value}")));
        }
    }
    for (key, color) in [("ambient", own.ambient), ("background", own.background)] {
        if let Some(color) = color.map(Vec3::from).filter(|color| !(color.is_finite() && color.min_element() >= 0.0)) {
            return Err(damaged(format!("has {key} = {color}")));
        }
    }
    draft.ambient = own.ambient.map(Vec3::from);
    draft.background = own.background.map(Vec3::from);
    let weight = match own.weight.as_deref() {
        None => None,
        Some(name) => Some(name.parse().map_err(|_| damaged(format!("has the unknown weight `{}`", quote(name))))?),
    };
    draft.light_mesh = LightMeshDefaults { step: own.step, radius: own.radius, weight };
    Ok(())
}
