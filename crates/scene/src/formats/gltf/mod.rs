//! glTF 2.0 and GLB, through the `gltf` crate: triangles of the node hierarchy, materials, cameras and punctual lights.
//!
//! The crate keeps numbers of the JSON as `f32`; where a node lies far from the origin that would lose its place, so
//! [`exact`] reads those once more in double precision. Accessors are checked against their buffers before they are read.
//! Images are not decoded. Skins, morph targets and animations are left out.

mod accessor;
mod container;
mod exact;
pub(crate) mod extras;
mod material;
mod primitive;
#[cfg(test)]
mod tests;
mod views;

use std::path::Path;

use glam::DMat4;
use gltf::{Document, Node};

use self::{container::Container, exact::Exact, primitive::Primitives};
use crate::{
    LoadError,
    draft::{Draft, Placement},
    error::Place,
};

/// Reads a glTF or GLB file into `draft`.
pub(crate) fn read(path: &Path, placement: &Placement, draft: &mut Draft) -> Result<(), LoadError> {
    let Container { document, exact, buffers, warnings } = Container::open(path)?;
    draft.warnings.extend(warnings);
    let mut loader = Loader { path, placement, document: &document, exact: &exact, left_out: LeftOut::default() };
    let mut primitives = Primitives::new(path, &document, &exact, &buffers, placement, draft)?;
    for (node, transform) in loader.placed_nodes(draft)? {
        if let Some(mesh) = node.mesh() {
            primitives.add(&mesh, &transform, draft)?;
        }
        loader.read_views(&node, &transform, draft)?;
    }
    if !placement.part {
        loader.read_scene_extras(draft)?;
    }
    primitives.warn(draft);
    loader.left_out.warn(path, draft);
    Ok(())
}

/// Cameras and lights that were not taken.
#[derive(Default)]
struct LeftOut {
    cameras: usize,
    lights: usize,
}

impl LeftOut {
    fn warn(&self, path: &Path, draft: &mut Draft) {
        if self.cameras + self.lights > 0 {
            let (path, cameras, lights) = (path.display(), self.cameras, self.lights);
            draft.warnings.push(format!("{path}: {cameras} cameras and {lights} lights of a mesh file were left out"));
        }
    }
}

struct Loader<'a> {
    path: &'a Path,
    placement: &'a Placement,
    document: &'a Document,
    exact: &'a Exact,
    left_out: LeftOut,
}

impl<'a> Loader<'a> {
    /// The nodes of the scene with their transforms to the world, depth first.
    fn placed_nodes(&self, draft: &mut Draft) -> Result<Vec<(Node<'a>, DMat4)>, LoadError> {
        let mut stack: Vec<(Node, DMat4)> =
            self.roots(draft).into_iter().rev().map(|node| (node, self.placement.transform)).collect();
        let mut placed = Vec::new();
        let mut seen = vec![false; self.document.nodes().len()];
        while let Some((node, parent)) = stack.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                return Err(LoadError::Malformed {
                    place: Place::file(self.path).into(),
                    problem: format!("node {} has two parents or is its own ancestor", node.index()),
                    remedy: "nodes must form a tree; export the file again".to_owned(),
                });
            }
            let transform = parent * self.exact.transform(node.index());
            let children: Vec<Node> = node.children().collect();
            stack.extend(children.into_iter().rev().map(|child| (child, transform)));
            placed.push((node, transform));
        }
        Ok(placed)
    }

    /// The root nodes of the default scene, else of the first, else all that are no one's child.
    fn roots(&self, draft: &mut Draft) -> Vec<Node<'a>> {
        let count = self.document.scenes().len();
        if let Some(scene) = self.scene() {
            if count > 1 {
                let (path, index) = (self.path.display(), scene.index());
                draft.warnings.push(format!("{path}: of {count} scenes only number {index} is read"));
            }
            return scene.nodes().collect();
        }
        let mut is_child = vec![false; self.document.nodes().len()];
        self.document.nodes().flat_map(|node| node.children()).for_each(|child| is_child[child.index()] = true);
        self.document.nodes().filter(|node| !is_child[node.index()]).collect()
    }

    fn scene(&self) -> Option<gltf::Scene<'a>> {
        self.document.default_scene().or_else(|| self.document.scenes().next())
    }
}
