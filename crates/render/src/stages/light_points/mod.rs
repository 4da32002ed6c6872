//! Step 3: each light point that some object point uses, once. Formula (7).
//!
//! In: masks by cell. Out: [`UsedPoints`](crate::light_mesh::UsedPoints), a bitmap over bricks in ascending order, however
//! many threads marked it.

pub(crate) mod cpu;
#[cfg(test)]
mod tests;

use glam::IVec3;

use crate::light_mesh::{BrickKey, Template, brick_of};

/// The block of bricks around one cell that the template reaches into: at most `side`³ bricks.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    low: IVec3,
    side: i32,
}

impl Window {
    /// The widest window that the template needs, whatever the place of the cell in its brick.
    pub(crate) fn new(template: &Template) -> Window {
        // Offsets run from 1 − reach to reach; a run of n points meets at most (n + 2) / 4 + 1 bricks.
        Window { low: IVec3::ZERO, side: (2 * template.reach() + 2) / 4 + 1 }
    }

    /// Number of bricks.
    pub(crate) fn len(&self) -> usize {
        self.side.pow(3) as usize
    }

    /// Moves the window to `cell`.
    pub(crate) fn place(&mut self, template: &Template, cell: IVec3) {
        self.low = (cell + 1 - template.reach()) >> 2;
    }

    /// The place in the window of the brick that holds lattice point `index`.
    #[inline(always)]
    pub(crate) fn slot(&self, index: IVec3) -> usize {
        let brick: IVec3 = (index >> 2) - self.low;
        ((brick.z * self.side + brick.y) * self.side + brick.x) as usize
    }

    /// The key of the brick at `slot`.
    pub(crate) fn key(&self, slot: usize) -> BrickKey {
        let slot = slot as i32;
        let brick = IVec3::new(slot % self.side, slot / self.side % self.side, slot / (self.side * self.side));
        brick_of((self.low + brick) << 2)
    }
}
