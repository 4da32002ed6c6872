//! The hierarchy of nodes, traversed without recursion: a chain may be as long as the file.

use std::path::Path;

use glam::{DMat4, DQuat, DVec3};

use super::{
    container::malformed,
    document::{Document, Node},
};
use crate::build::draft::Draft;
use crate::build::geometry_check::is_affine;
use crate::model::animation::rig;
use crate::{Empty, LoadError, Place};

/// A node with its transform to world coordinates.
pub(super) struct Placed<'a> {
    pub(super) index: usize,
    /// The index of its parent.
    pub(super) parent: Option<usize>,
    pub(super) node: &'a Node,
    pub(super) transform: DMat4,
    /// That of what it is in.
    pub(super) outer: DMat4,
}

impl Placed<'_> {
    /// Index of the node's light.
    pub(super) fn light(&self) -> Option<u32> {
        self.node.extensions.as_ref()?.light.as_ref().map(|reference| reference.light)
    }

    /// Its transform without its own turn and factors.
    pub(super) fn unturned(&self) -> DMat4 {
        DMat4 { w_axis: self.transform.w_axis, ..self.outer }
    }

    /// The node as a place, if it has a name and nothing else.
    pub(super) fn empty(&self) -> Option<Empty> {
        let Node { name, mesh, camera, .. } = self.node;
        let name = name.as_deref().filter(|name| !name.is_empty())?;
        let is_empty = mesh.is_none() && camera.is_none() && self.light().is_none();
        is_empty.then(|| Empty { name: name.to_owned(), transform: self.transform })
    }
}

/// The nodes of the document's scene, depth first, with all of them placed by `transform`.
pub(super) fn placed<'a>(
    path: &Path,
    document: &'a Document,
    transform: DMat4,
    draft: &mut Draft,
) -> Result<Vec<Placed<'a>>, LoadError> {
    let mut stack: Vec<(u32, Option<usize>, DMat4)> =
        roots(path, document, draft)?.into_iter().rev().map(|root| (root, None, transform)).collect();
    let mut placed = Vec::new();
    let mut seen = vec![false; document.nodes.len()];
    while let Some((index, parent, outer)) = stack.pop() {
        let node = document
            .nodes
            .get(index as usize)
            .ok_or_else(|| malformed(path, format!("there is no node {index}, but it is referenced")))?;
        if std::mem::replace(&mut seen[index as usize], true) {
            return Err(no_tree(path, format!("node {index} has two parents or is its own ancestor")));
        }
        let own_place = place(node);
        if let rig::Place::Matrix(matrix) = &own_place
            && !is_affine(matrix)
        {
            let (path, row) = (path.display(), matrix.row(3));
            draft.warnings.push(format!(
                "{path}: the matrix of node {index} ends in the row {row} and not in 0, 0, 0, 1: it may be transposed, and the row is ignored"
            ));
        }
        let transform = outer * own_place.matrix();
        let own = index as usize;
        stack.extend(node.children.iter().rev().map(|&child| (child, Some(own), transform)));
        placed.push(Placed { index: own, parent, node, transform, outer });
    }
    Ok(placed)
}

/// Index of the scene that is read: the default one, else the first. `None` if the document names none and has none.
pub(super) fn scene_index(document: &Document) -> Option<usize> {
    document.scene.map(|scene| scene as usize).or((!document.scenes.is_empty()).then_some(0))
}

/// The roots of the scene, or all nodes that have no parent.
fn roots(path: &Path, document: &Document, draft: &mut Draft) -> Result<Vec<u32>, LoadError> {
    if let Some(index) = scene_index(document) {
        let count = document.scenes.len();
        let scene = document.scenes.get(index);
        let scene = scene.ok_or_else(|| malformed(path, format!("there is no scene {index}: the file has {count}")))?;
        if count > 1 {
            let path = path.display();
            draft.warnings.push(format!("{path}: of {count} scenes only scene {index} is loaded"));
        }
        return Ok(scene.nodes.to_vec());
    }
    let mut is_child = vec![false; document.nodes.len()];
    for &child in document.nodes.iter().flat_map(|node| &node.children) {
        if let Some(is_child) = is_child.get_mut(child as usize) {
            *is_child = true;
        }
    }
    let roots: Vec<u32> = (0..).zip(is_child).filter(|(_, is_child)| !is_child).map(|(index, _)| index).collect();
    if roots.is_empty() && !document.nodes.is_empty() {
        return Err(no_tree(path, "every node is the child of another".to_owned()));
    }
    Ok(roots)
}

/// The node's place in its parent.
pub(super) fn place(node: &Node) -> rig::Place {
    if let Some(matrix) = &node.matrix {
        return rig::Place::Matrix(DMat4::from_cols_array(matrix));
    }
    let vector = |value: &Option<Box<[f64; 3]>>, none| value.as_deref().map_or(none, |&value| DVec3::from(value));
    let rotation = node.rotation.as_deref().map_or(DQuat::IDENTITY, |&xyzw| rotation(DQuat::from_array(xyzw)));
    rig::Place::Parts {
        translation: vector(&node.translation, DVec3::ZERO),
        rotation,
        scale: vector(&node.scale, DVec3::ONE),
    }
}

/// A unit quaternion; one without a length means no rotation.
pub(super) fn rotation(rotation: DQuat) -> DQuat {
    let unit = rotation.normalize();
    if unit.is_finite() { unit } else { DQuat::IDENTITY }
}

fn no_tree(path: &Path, problem: String) -> LoadError {
    LoadError::Malformed {
        place: Place::file(path).into(),
        problem,
        remedy: "nodes must form a tree; export the file again".to_owned(),
    }
}
