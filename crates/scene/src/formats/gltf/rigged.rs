//! The nodes of a file as a rig, if something in it moves or is bent: their motion, and skeletons.

use std::sync::Arc;

use glam::DMat4;

use super::{
    accessor::Accessors,
    animations::{self, NodeTracks, Played},
    container::malformed,
    left_out::LeftOut,
    nodes::{self, Placed},
};
use crate::LoadError;
use crate::build::draft::Draft;
use crate::build::placement::Placement;
use crate::model::animation::parts::Skin;
use crate::model::animation::rig::{Node, Place};
use crate::model::animation::track::Track;

/// The nodes of a file in the rig of the scene.
#[derive(Default)]
pub(super) struct Rigged {
    /// By node of the document.
    numbers: Vec<Option<u32>>,
    /// By number in the rig.
    moving: Vec<bool>,
    scaling: Vec<bool>,
    /// Where they are at rest.
    pub(super) places: Vec<DMat4>,
    /// By node of the document.
    weights: Vec<Option<Arc<Track>>>,
    /// By skin, once a node has used it.
    skins: Vec<Option<Arc<Skin>>>,
}

impl Rigged {
    /// Adds the nodes that are placed to the rig, below the node that moves the whole file. None are, if nothing moves and `bends` says that
    /// nothing is bent.
    pub(super) fn new(
        accessors: &Accessors,
        all: &[Placed],
        placement: &Placement,
        mover: Option<u32>,
        bends: bool,
        left_out: &mut LeftOut,
        draft: &mut Draft,
    ) -> Result<Rigged, LoadError> {
        let document = accessors.document;
        if document.animations.is_empty() && mover.is_none() && !bends {
            return Ok(Rigged::default());
        }
        let Played { mut tracks, names, others, duration } =
            animations::read(accessors, draft.animation_name.as_deref(), left_out)?;
        let animation = &mut draft.animation;
        animation.names.extend(names);
        animation.others.extend(others);
        animation.duration = animation.duration.max(duration);
        let root = animation.rig.add(Node::fixed(mover, Place::Matrix(placement.transform)));
        let count = document.nodes.len();
        let (mut numbers, mut weights) = (vec![None; count], vec![None; count]);
        for placed in all {
            let parent = placed.parent.and_then(|parent| numbers[parent]).unwrap_or(root);
            let NodeTracks { translation, rotation, scale, weights: own } =
                tracks.remove(&(placed.index as u32)).unwrap_or_default();
            let mut rest = nodes::place(placed.node);
            if let (Place::Matrix(matrix), true) =
                (rest, translation.is_some() || rotation.is_some() || scale.is_some())
            {
                let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
                rest = Place::Parts { translation, rotation: nodes::rotation(rotation), scale };
            }
            let node = Node { parent: Some(parent), rest, translation, rotation, scale };
            numbers[placed.index] = Some(animation.rig.add(node));
            weights[placed.index] = own;
        }
        let (moving, scaling, places) = (animation.rig.moving(), animation.rig.scaling(), animation.rig.places(None));
        Ok(Rigged { numbers, moving, scaling, places, weights, skins: vec![None; document.skins.len()] })
    }

    /// The number of a node in the rig, if there is one.
    pub(super) fn number(&self, node: usize) -> Option<u32> {
        self.numbers.get(node).copied().flatten()
    }

    /// The number of a node in the rig, if it moves.
    pub(super) fn mover(&self, node: usize) -> Option<u32> {
        self.number(node).filter(|&number| self.moves(number))
    }

    /// Whether a node of the rig moves.
    pub(super) fn moves(&self, number: u32) -> bool {
        self.moving[number as usize]
    }

    /// Whether what is fastened to a node is stored once for all its places: it stays, or is never enlarged or lessened.
    pub(super) fn may_hold_shapes(&self, node: usize) -> bool {
        self.mover(node).is_none_or(|number| !self.scaling[number as usize])
    }

    /// How the weights of morph targets of a node's mesh change.
    pub(super) fn weights(&self, node: usize) -> Option<&Arc<Track>> {
        self.weights.get(node)?.as_ref()
    }

    /// Skin number `index` of the document.
    pub(super) fn skin(&mut self, accessors: &Accessors, index: u32) -> Result<Arc<Skin>, LoadError> {
        let damaged = |problem: String| malformed(accessors.path, format!("skin {index} {problem}"));
        let skin = accessors.document.skins.get(index as usize);
        let skin = skin.ok_or_else(|| damaged("does not exist, but is referenced".to_owned()))?;
        if let Some(Some(known)) = self.skins.get(index as usize) {
            return Ok(Arc::clone(known));
        }
        let number = |&joint: &u32| {
            let number = self.number(joint as usize);
            number.ok_or_else(|| damaged(format!("has joint {joint}, which is no node of the scene")))
        };
        let joints = skin.joints.iter().map(number).collect::<Result<Vec<u32>, LoadError>>()?;
        let inverse_bind: Vec<DMat4> = match skin.inverse_bind_matrices {
            Some(matrices) => {
                let matrices = accessors.vectors::<16>(matrices, None)?;
                matrices.iter().map(|matrix| DMat4::from_cols_array(&matrix.map(f64::from))).collect()
            }
            None => vec![DMat4::IDENTITY; joints.len()],
        };
        if joints.is_empty() || inverse_bind.len() < joints.len() {
            let problem = format!("has {} inverse bind matrices for {} joints", inverse_bind.len(), joints.len());
            return Err(damaged(problem));
        }
        let skin = Arc::new(Skin { joints, inverse_bind });
        self.skins[index as usize] = Some(Arc::clone(&skin));
        Ok(skin)
    }
}
