//! The geometry of a scene: one indexed list of triangles.

use glam::{Vec2, Vec3};

use crate::{Instances, Objects};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest corner.
    pub min: Vec3,
    /// Highest corner.
    pub max: Vec3,
}

impl Bounds {
    /// The empty box: any point enlarges it.
    pub const EMPTY: Bounds = Bounds { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box around `points`.
    #[inline]
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Bounds {
        points.into_iter().fold(Bounds::EMPTY, Bounds::including)
    }

    /// This box enlarged to contain `point`.
    #[inline]
    pub fn including(self, point: Vec3) -> Bounds {
        Bounds { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The box around this one and another.
    pub(crate) fn with_box(self, other: Bounds) -> Bounds {
        self.including(other.min).including(other.max)
    }

    /// The largest absolute value of a coordinate within; 0 if it is empty.
    #[inline]
    pub fn farthest(&self) -> f32 {
        if self.is_empty() { 0.0 } else { self.min.abs().max(self.max.abs()).max_element() }
    }

    /// Whether the box is empty.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The centre.
    #[inline]
    pub fn center(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// Edge lengths; zero if the box is empty.
    #[inline]
    pub fn extent(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    /// Length of the diagonal.
    #[inline]
    pub fn diagonal(&self) -> f32 {
        self.extent().length()
    }
}

/// All triangles of a scene in its local frame. Those of shapes that are placed many times are stored once, see [`Instances`].
///
/// `normals`, `uvs`, `colors` and `opacities` are empty or as long as `positions`. A zero normal means that the vertex has none: its triangles are
/// shaded flat.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertices, local frame.
    pub positions: Vec<Vec3>,
    /// Shading normals by vertex, unit length or zero.
    pub normals: Vec<Vec3>,
    /// Texture coordinates by vertex: u to the right, v downwards, as in glTF.
    pub uvs: Vec<Vec2>,
    /// Colours by vertex, linear: they tint the material, see [`Material`](crate::Material).
    pub colors: Vec<Vec3>,
    /// Opacities by vertex, from 0 to 1: they count where a material is [cut out](crate::Opacity).
    pub opacities: Vec<f32>,
    /// Three vertex indices per triangle, counter-clockwise seen from outside (both sides are rendered).
    pub triangles: Vec<[u32; 3]>,
    /// Material index by triangle.
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

    /// The box around all vertices that a triangle uses.
    pub fn bounds(&self) -> Bounds {
        let used = self.own_triangles().flat_map(|triangle| self.triangles[triangle]);
        let own = Bounds::around(used.map(|vertex| self.positions[vertex as usize]));
        let instances = self.instances.list().iter().map(|instance| instance.bounds);
        instances.fold(own, Bounds::with_box)
    }
}
