//! The memory and the indices that a draft has room for.

use lightmesh_memory::OverBudget;

use super::Draft;
use crate::LoadError;
use crate::build::mesh_part::{MeshPart, Room};

impl Draft {
    /// Reserves memory for what a file is going to add.
    ///
    /// # Errors
    ///
    /// [`LoadError::TooLarge`] if it exceeds 32-bit indices, [`LoadError::Memory`] if there is not enough memory.
    pub(crate) fn reserve(&mut self, room: &Room) -> Result<(), LoadError> {
        let limit = u32::MAX as usize;
        let vertices = self.builder.vertex_count().saturating_add(room.vertices);
        let triangles = self.builder.triangle_count().saturating_add(room.triangles);
        if vertices > limit || triangles > limit {
            return Err(LoadError::TooLarge { path: self.path.clone() });
        }
        self.check_memory(room, vertices, triangles)?;
        if self.builder.reserve(room) {
            Ok(())
        } else {
            let (needed, limit) = (room.bytes(), self.access.budget.limit());
            Err(self.out_of_memory(vertices, triangles, OverBudget { needed, left: 0, limit }))
        }
    }

    /// Fails if there is not enough memory for what is added, of `vertices` and `triangles` in all.
    fn check_memory(&self, room: &Room, vertices: usize, triangles: usize) -> Result<(), LoadError> {
        let checked = self.access.budget.check(room.bytes());
        checked.map_err(|short| self.out_of_memory(vertices, triangles, short))
    }

    /// Fails if there is not enough memory for what bends `vertices` vertices between so many morph targets.
    pub(crate) fn check_bends(&self, vertices: usize, targets: usize) -> Result<(), LoadError> {
        /// Of a vertex of a target, and of one with eight joints.
        const BYTES: u64 = 24 + 48;
        let bytes = (vertices as u64).saturating_mul(1 + targets as u64).saturating_mul(BYTES);
        self.access.budget.check(bytes).map_err(|short| LoadError::Memory {
            path: self.path.clone(),
            what: format!("{targets} morph targets of {vertices} vertices"),
            short,
        })
    }

    fn out_of_memory(&self, vertices: usize, triangles: usize, short: OverBudget) -> LoadError {
        LoadError::Memory {
            path: self.path.clone(),
            what: format!("{vertices} vertices and {triangles} triangles"),
            short,
        }
    }

    /// Fails if there is no room for a part.
    pub(super) fn check_room<P>(&self, part: &MeshPart<P>) -> Result<(), LoadError> {
        let vertices = self.builder.vertex_count() + part.positions.len();
        if vertices > u32::MAX as usize {
            return Err(LoadError::TooLarge { path: self.path.clone() });
        }
        if part.triangles.len() <= self.builder.reserved_triangles() {
            return Ok(());
        }
        self.check_memory(&Room::of(part), vertices, self.builder.triangle_count() + part.triangles.len())
    }
}
