//! Primitives that are bent by a skeleton, or between shapes: their vertex attributes (glTF 2.0, 3.7.2.2 and 3.7.3.3).

use std::sync::Arc;

use glam::Vec3;

use super::{
    accessor::{Accessors, Used},
    container::malformed,
    document::{Primitive, Target},
};
use crate::LoadError;
use crate::model::animation::parts::{self, Influences, Morph, Skin};
use crate::model::animation::track::Track;

/// What bends the mesh of a node.
#[derive(Default)]
pub(super) struct Bends {
    pub(super) skin: Option<Arc<Skin>>,
    /// Weights of morph targets, and how they change.
    pub(super) weights: Vec<f64>,
    pub(super) track: Option<Arc<Track>>,
}

impl Bends {
    /// By the weights at rest, the skin, and the weights over time.
    pub(super) fn new(weights: &[f64], skin: Option<Arc<Skin>>, track: Option<&Arc<Track>>) -> Bends {
        Bends { skin, weights: weights.to_vec(), track: track.cloned() }
    }

    /// Whether a primitive is bent.
    pub(super) fn bend(&self, primitive: &Primitive) -> bool {
        let morphs = self.track.is_some() || self.weights.iter().any(|&weight| weight != 0.0);
        (self.skin.is_some() && primitive.attributes.joints_0.is_some()) || (morphs && !primitive.targets.is_empty())
    }

    /// Whether the weights are ever others than at rest.
    pub(super) fn morph_moves(&self) -> bool {
        self.track.as_ref().is_some_and(|track| {
            let mut values = vec![0.0; track.width()];
            track.sample(0.0, &mut values);
            !track.is_constant() || values != self.weights
        })
    }

    /// The shapes between which a primitive is.
    pub(super) fn morph(
        &self,
        accessors: &Accessors,
        primitive: &Primitive,
        vertices: usize,
        used: Used,
    ) -> Result<Option<Morph>, LoadError> {
        if primitive.targets.is_empty() {
            return Ok(None);
        }
        let values = |accessor: Option<u32>| -> Result<Vec<Vec3>, LoadError> {
            let Some(accessor) = accessor else { return Ok(Vec::new()) };
            check_length(accessors, "values of a morph target", accessor, vertices)?;
            Ok(accessors.vectors::<3>(accessor, used)?.iter().map(|&value| value.into()).collect())
        };
        let target = |&Target { position, normal }: &Target| -> Result<parts::Target, LoadError> {
            Ok(parts::Target { positions: values(position)?, normals: values(normal)? })
        };
        let targets = primitive.targets.iter().map(target).collect::<Result<Vec<_>, LoadError>>()?;
        let mut rest = self.weights.clone();
        rest.resize(self.track.as_ref().map_or(targets.len(), |track| track.width()), 0.0);
        Ok(Some(Morph { targets, rest, weights: self.track.clone() }))
    }

    /// The joints of a primitive's vertices, if it has any.
    pub(super) fn influences(
        &self,
        accessors: &Accessors,
        primitive: &Primitive,
        vertices: usize,
        used: Used,
    ) -> Result<Option<(Arc<Skin>, Influences)>, LoadError> {
        let attributes = &primitive.attributes;
        let sets = [(attributes.joints_0, attributes.weights_0), (attributes.joints_1, attributes.weights_1)];
        let sets: Vec<(u32, u32)> = sets.into_iter().filter_map(|(joints, weights)| joints.zip(weights)).collect();
        let Some(skin) = self.skin.as_ref().filter(|_| !sets.is_empty()) else { return Ok(None) };
        let count = used.map_or(vertices, <[u32]>::len);
        let per_vertex = 4 * sets.len();
        let mut influences =
            Influences { per_vertex, joints: vec![0; count * per_vertex], weights: vec![0.0; count * per_vertex] };
        for (set, &(joints, weights)) in sets.iter().enumerate() {
            check_length(accessors, "joints", joints, vertices)?;
            check_length(accessors, "weights of joints", weights, vertices)?;
            let (joints, weights) = (accessors.vectors::<4>(joints, used)?, accessors.vectors::<4>(weights, used)?);
            for (vertex, (joints, weights)) in joints.iter().zip(weights.iter()).enumerate() {
                let own = vertex * per_vertex + 4 * set;
                for (slot, (&joint, &weight)) in joints.iter().zip(weights).enumerate() {
                    if !(joint >= 0.0 && (joint as usize) < skin.joints.len()) {
                        let of = skin.joints.len();
                        let problem = format!("a vertex refers to joint {joint} of {of}");
                        return Err(malformed(accessors.path, problem));
                    }
                    // NaN counts as 0.
                    influences.weights[own + slot] = if weight > 0.0 && weight.is_finite() { weight } else { 0.0 };
                    influences.joints[own + slot] = joint as u16;
                }
            }
        }
        Ok(Some((Arc::clone(skin), influences)))
    }
}

fn check_length(accessors: &Accessors, what: &str, accessor: u32, vertices: usize) -> Result<(), LoadError> {
    match accessors.count(accessor)? {
        count if count == vertices => Ok(()),
        count => Err(malformed(accessors.path, format!("a primitive has {count} {what} for {vertices} vertices"))),
    }
}
