//! `EXT_mesh_gpu_instancing`: one node that shows its mesh many times.

use std::borrow::Cow;

use glam::{DMat4, DQuat, DVec3, Quat, Vec3};

use super::{accessor::Accessors, container::malformed, document::Instancing, nodes};
use crate::LoadError;

/// Where a node's mesh stands: an own transform for each instance, below that of the node.
pub(super) struct Instances<'a> {
    pub(super) count: usize,
    translations: Option<Cow<'a, [[f32; 3]]>>,
    rotations: Option<Cow<'a, [[f32; 4]]>>,
    scales: Option<Cow<'a, [[f32; 3]]>>,
}

impl<'a> Instances<'a> {
    /// Reads the attributes of node number `node`.
    pub(super) fn read(
        accessors: &Accessors<'a>,
        node: usize,
        instancing: &Instancing,
    ) -> Result<Instances<'a>, LoadError> {
        let find = |name: &str| instancing.attributes.get(name).copied();
        let translations = find("TRANSLATION").map(|index| accessors.vectors(index)).transpose()?;
        let rotations = find("ROTATION").map(|index| accessors.vectors(index)).transpose()?;
        let scales = find("SCALE").map(|index| accessors.vectors(index)).transpose()?;
        let lengths = [
            translations.as_deref().map(<[_]>::len),
            rotations.as_deref().map(<[_]>::len),
            scales.as_deref().map(<[_]>::len),
        ];
        let mut counts = lengths.into_iter().flatten();
        // Without any of the three all instances stand in one place, and show as one.
        let count = counts.next().unwrap_or(1);
        if let Some(other) = counts.find(|&other| other != count) {
            let problem = format!("the instances of node {node} are {count} by one attribute and {other} by another");
            return Err(malformed(accessors.path, problem));
        }
        Ok(Instances { count, translations, rotations, scales })
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
