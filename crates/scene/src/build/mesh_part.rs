//! The unit in which geometry is added to a scene.

use glam::{DVec3, Vec2, Vec3};

/// One mesh as stored in a file, before it is placed. Slices are as long as `positions` or empty.
#[derive(Clone, Copy, Debug)]
pub struct MeshPart<'a, P = DVec3> {
    /// Vertices in the part's own coordinates, `Vec3` or `DVec3`.
    pub positions: &'a [P],
    /// Normals by vertex; need not be unit length.
    pub normals: &'a [Vec3],
    /// Texture coordinates by vertex.
    pub uvs: &'a [Vec2],
    /// Linear colours by vertex.
    pub colors: &'a [Vec3],
    /// Opacities by vertex, from 0 to 1.
    pub opacities: &'a [f32],
    /// Three vertex indices per triangle, all in range.
    pub triangles: &'a [[u32; 3]],
}

impl<P> Default for MeshPart<'_, P> {
    fn default() -> Self {
        MeshPart { positions: &[], normals: &[], uvs: &[], colors: &[], opacities: &[], triangles: &[] }
    }
}

/// The memory that a scene needs, if it is known before reading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Room {
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    /// Whether any part has normals.
    pub(crate) normals: bool,
    pub(crate) uvs: bool,
    pub(crate) colors: bool,
    pub(crate) opacities: bool,
}

impl Room {
    /// What a part adds.
    pub(crate) fn of<P>(part: &MeshPart<P>) -> Room {
        Room {
            vertices: part.positions.len(),
            triangles: part.triangles.len(),
            normals: !part.normals.is_empty(),
            uvs: !part.uvs.is_empty(),
            colors: !part.colors.is_empty(),
            opacities: !part.opacities.is_empty(),
        }
    }

    /// Bytes of it, with positions in double precision.
    pub(crate) fn bytes(&self) -> u64 {
        let used = |used: bool, bytes: usize| if used { bytes } else { 0 };
        let vertex = size_of::<DVec3>()
            + used(self.normals, size_of::<Vec3>())
            + used(self.uvs, size_of::<Vec2>())
            + used(self.colors, size_of::<Vec3>())
            + used(self.opacities, size_of::<f32>());
        let triangle = size_of::<[u32; 3]>() + size_of::<u32>();
        (self.vertices as u64 * vertex as u64).saturating_add(self.triangles as u64 * triangle as u64)
    }

    /// The memory for this, and for `count` times `more`.
    pub(crate) fn and(&self, more: &Room, count: usize) -> Room {
        let sum = |a: usize, b: usize| a.saturating_add(b.saturating_mul(count));
        Room {
            vertices: sum(self.vertices, more.vertices),
            triangles: sum(self.triangles, more.triangles),
            normals: self.normals || more.normals,
            uvs: self.uvs || more.uvs,
            colors: self.colors || more.colors,
            opacities: self.opacities || more.opacities,
        }
    }
}
