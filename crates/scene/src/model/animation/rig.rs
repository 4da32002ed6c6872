//! What things are fastened to: nodes that move each other.

use std::sync::Arc;

use glam::{DMat4, DQuat, DVec3};

use super::track::Track;

/// Nodes, each after its parent.
#[derive(Clone, Debug, Default)]
pub struct Rig {
    nodes: Vec<Node>,
}

/// A node: its place in its parent, and how that moves.
#[derive(Clone, Debug)]
pub struct Node {
    /// The number of the node that moves this one.
    pub parent: Option<u32>,
    /// The place without any motion.
    pub rest: Place,
    /// Motion by keys of the three parts of a [`Place::Parts`].
    pub translation: Option<Arc<Track>>,
    /// Unit quaternions, or degrees about the fixed axes X, then Y, then Z, so that keys may be several turns apart.
    pub rotation: Option<Arc<Track>>,
    /// Factors by axis.
    pub scale: Option<Arc<Track>>,
}

/// A place in a parent.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// Any affine transform.
    Matrix(DMat4),
    /// Scale, then rotation, then translation.
    Parts {
        /// Where to.
        translation: DVec3,
        /// A unit quaternion.
        rotation: DQuat,
        /// Factors by axis.
        scale: DVec3,
    },
}

impl Place {
    /// At a point in its parent.
    pub fn at(translation: DVec3) -> Place {
        Place::Parts { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
    }

    pub(crate) fn matrix(&self) -> DMat4 {
        match *self {
            Place::Matrix(matrix) => matrix,
            Place::Parts { translation, rotation, scale } => {
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

impl Node {
    /// A node that does not move by itself.
    pub fn fixed(parent: Option<u32>, rest: Place) -> Node {
        Node { parent, rest, translation: None, rotation: None, scale: None }
    }

    /// Whether it is ever elsewhere in its parent than at rest.
    fn moves(&self) -> bool {
        let tracks = [&self.translation, &self.rotation, &self.scale];
        tracks.into_iter().flatten().any(|track| !track.is_constant()) || self.local(0.0) != self.rest.matrix()
    }

    /// Whether it is ever larger or smaller than at rest.
    fn scales(&self) -> bool {
        let Place::Parts { scale: rest, .. } = self.rest else { return false };
        self.scale.as_ref().is_some_and(|track| !track.is_constant() || DVec3::from(track.vector(0.0)) != rest)
    }

    /// From its coordinates to its parent's at `time`.
    fn local(&self, time: f64) -> DMat4 {
        let Place::Parts { translation, rotation, scale } = self.rest else { return self.rest.matrix() };
        let vector = |track: &Option<Arc<Track>>, rest| track.as_ref().map_or(rest, |track| track.vector(time).into());
        let rotation = self.rotation.as_ref().map_or(rotation, |track| {
            if track.width() == 3 {
                let [x, y, z] = track.vector(time).map(f64::to_radians);
                return DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
            }
            let mut values = [0.0; 4];
            track.sample(time, &mut values);
            DQuat::from_array(values)
        });
        DMat4::from_scale_rotation_translation(
            vector(&self.scale, scale),
            rotation,
            vector(&self.translation, translation),
        )
    }
}

impl Rig {
    /// Adds a node, whose parent was added before, and returns its number.
    pub fn add(&mut self, node: Node) -> u32 {
        debug_assert!(node.parent.is_none_or(|parent| (parent as usize) < self.nodes.len()), "parents come first");
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// Whether each node moves, by itself or with its parent.
    pub fn moving(&self) -> Vec<bool> {
        self.with_parents(Node::moves)
    }

    /// Whether each node is enlarged or lessened over time, by itself or with its parent.
    pub fn scaling(&self) -> Vec<bool> {
        self.with_parents(Node::scales)
    }

    /// Whether something holds for each node, or for one that moves it.
    fn with_parents(&self, holds: impl Fn(&Node) -> bool) -> Vec<bool> {
        let mut all: Vec<bool> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            all.push(holds(node) || node.parent.is_some_and(|parent| all[parent as usize]));
        }
        all
    }

    /// Whether a node is enlarged or lessened over time, by itself or with its parent.
    pub(crate) fn scales(&self, number: u32) -> bool {
        let mut up = std::iter::successors(Some(number), |&number| self.nodes[number as usize].parent);
        up.any(|number| self.nodes[number as usize].scales())
    }

    /// From the coordinates of each node to the world's, at `time` or at rest.
    pub fn places(&self, time: Option<f64>) -> Vec<DMat4> {
        let mut places: Vec<DMat4> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let local = time.map_or_else(|| node.rest.matrix(), |time| node.local(time));
            places.push(node.parent.map_or(local, |parent| places[parent as usize] * local));
        }
        places
    }
}
