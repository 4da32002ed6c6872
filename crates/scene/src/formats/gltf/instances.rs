//! `EXT_mesh_gpu_instancing`: one node that shows its mesh many times.

use std::borrow::Cow;

use glam::{DMat4, DQuat, DVec3, Quat, Vec3};

use super::{accessor::Accessors, container::malformed, document::Instancing, nodes};
use crate::LoadError;

/// Positions of a node's mesh: a separate transform for each instance, below that of the node.
pub(super) struct Instances<'a> {
    count: usize,
    translations: Option<Cow<'a, [[f32; 3]]>>,
    rotations: Option<Cow<'a, [[f32; 4]]>>,
    scales: Option<Cow<'a, [[f32; 3]]>>,
}

/// The attributes that place instances.
const ATTRIBUTES: [&str; 3] = ["TRANSLATION", "ROTATION", "SCALE"];

/// Number of instances of node number `node`, without reading them.
pub(super) fn count(accessors: &Accessors, node: usize, instancing: &Instancing) -> Result<usize, LoadError> {
    let named = ATTRIBUTES.iter().filter_map(|name| instancing.attributes.get(*name));
    let counts = named.map(|&accessor| accessors.count(accessor)).collect::<Result<Vec<usize>, LoadError>>()?;
    // Without any of the three, all instances coincide and look like one.
    let Some((&count, others)) = counts.split_first() else { return Ok(1) };
    match others.iter().find(|&&other| other != count) {
        None => Ok(count),
        Some(other) => {
            let problem = format!("the instances of node {node} are {count} by one attribute and {other} by another");
            Err(malformed(accessors.path, problem))
        }
    }
}

impl<'a> Instances<'a> {
    /// Reads the attributes, whose number of instances was determined before.
    pub(super) fn read(
        accessors: &Accessors<'a>,
        instancing: &Instancing,
        count: usize,
    ) -> Result<Instances<'a>, LoadError> {
        let [translations, rotations, scales] = ATTRIBUTES.map(|name| instancing.attributes.get(name).copied());
        Ok(Instances {
            count,
            translations: translations.map(|accessor| accessors.vectors(accessor, None)).transpose()?,
            rotations: rotations.map(|accessor| accessors.vectors(accessor, None)).transpose()?,
            scales: scales.map(|accessor| accessors.vectors(accessor, None)).transpose()?,
        })
    }

    /// From the mesh's coordinates to the node's, instance by instance.
    pub(super) fn transforms(&self) -> impl Iterator<Item = DMat4> {
        let vector = |all: &Option<Cow<[[f32; 3]]>>, i: usize, none| {
            all.as_ref().map_or(none, |all| Vec3::from(all[i]).as_dvec3())
        };
        (0..self.count).map(move |i| {
            let rotation = self.rotations.as_ref().map_or(DQuat::IDENTITY, |all| Quat::from_array(all[i]).as_dquat());
            DMat4::from_scale_rotation_translation(
                vector(&self.scales, i, DVec3::ONE),
                nodes::rotation(rotation),
                vector(&self.translations, i, DVec3::ZERO),
            )
        })
    }
}
