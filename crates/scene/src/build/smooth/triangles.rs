//! Triangles whose corners are numbered.

use glam::DVec3;

use crate::Position;

/// The triangles of a mesh. Their corners are numbered: those of the first triangle are 0, 1 and 2.
pub(super) struct Triangles<'a, P> {
    pub(super) positions: &'a [P],
    pub(super) triangles: &'a [[u32; 3]],
}

impl<P: Position> Triangles<'_, P> {
    pub(super) fn corner_count(&self) -> usize {
        3 * self.triangles.len()
    }

    pub(super) fn vertex(&self, corner: u32) -> u32 {
        self.triangles.as_flattened()[corner as usize]
    }

    /// The position of a corner, of the next one, and of that before it.
    pub(super) fn around(&self, corner: u32) -> [DVec3; 3] {
        [corner, next(corner), next(next(corner))]
            .map(|corner| self.positions[self.vertex(corner) as usize].to_double())
    }
}

/// The next corner of the same triangle.
pub(super) fn next(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}
