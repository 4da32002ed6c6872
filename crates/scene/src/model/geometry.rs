//! The surfaces that rays can hit: triangles with their materials and textures.

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::{Material, Mesh, Textures};

/// The surfaces of a scene, in one local frame. [`Scene`](crate::Scene) shares them behind an `Arc`: moving a light or a camera does
/// not change them, and what a renderer has built over them stays valid.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Geometry {
    /// World position of the local frame's origin. All `f32` positions, including those of lights and cameras, are relative to it.
    pub origin: DVec3,
    /// The triangles.
    pub mesh: Mesh,
    /// Materials, at least one if there are triangles.
    pub materials: Vec<Material>,
    /// Textures of the materials.
    pub textures: Textures,
}

impl Geometry {
    /// World coordinates of a local point.
    pub fn to_world(&self, local: Vec3) -> DVec3 {
        self.origin + local.as_dvec3()
    }

    /// Local coordinates of a world point.
    pub fn to_local(&self, world: DVec3) -> Vec3 {
        (world - self.origin).as_vec3()
    }

    /// Whether there are surfaces that emit light for which no lights stand: only gather rays find them.
    pub fn glows(&self) -> bool {
        let glows: Vec<bool> =
            self.materials.iter().map(|material| !material.lamp && material.emission != Vec3::ZERO).collect();
        let is_used = |&material: &u32| glows.get(material as usize).is_some_and(|&glows| glows);
        glows.contains(&true) && self.mesh.materials.iter().any(is_used)
    }
}
