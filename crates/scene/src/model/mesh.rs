//! The geometry of a scene: one indexed list of triangles.

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::{instances::Instances, objects::Objects};

/// All triangles of a scene in its local frame. Those of shapes that are placed many times are stored once, see [`Instances`].
///
/// `normals`, `uvs`, `colors` and `opacities` are empty or as long as `positions`. A zero normal means that the vertex has none: its triangles are
/// shaded flat.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Mesh {
    /// Vertices, local frame.
    #[serde(with = "super::packed")]
    pub positions: Vec<Vec3>,
    /// Shading normals by vertex, unit length or zero.
    #[serde(with = "super::packed")]
    pub normals: Vec<Vec3>,
    /// Texture coordinates by vertex: u to the right, v downwards, as in glTF.
    #[serde(with = "super::packed")]
    pub uvs: Vec<Vec2>,
    /// Colours by vertex, linear: they tint the material, see [`Material`](crate::Material).
    #[serde(with = "super::packed")]
    pub colors: Vec<Vec3>,
    /// Opacities by vertex, from 0 to 1: they count where a material is [cut out](crate::Opacity).
    #[serde(with = "super::packed")]
    pub opacities: Vec<f32>,
    /// Three vertex indices per triangle, counter-clockwise seen from outside (both sides are rendered).
    #[serde(with = "super::packed")]
    pub triangles: Vec<[u32; 3]>,
    /// Material index by triangle.
    #[serde(with = "super::packed")]
    pub materials: Vec<u32>,
    /// The object of each stored triangle.
    pub objects: Objects,
    /// Shapes in many places. When their vertices have moved, [`Mesh::find_instance_bounds`] must be called.
    pub instances: Instances,
}

impl Mesh {
    /// The three corners of the stored triangle `index`; of a shape's, in its own coordinates.
    #[inline]
    pub fn corners(&self, index: usize) -> [Vec3; 3] {
        self.triangles[index].map(|vertex| self.positions[vertex as usize])
    }

    /// Number of stored vertices with a normal.
    pub fn normal_count(&self) -> usize {
        self.normals.iter().filter(|&&normal| normal != Vec3::ZERO).count()
    }
}
