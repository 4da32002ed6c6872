//! Step 3: each light point that some object point uses, once. Formula (7).
//!
//! In: masks by cell. Out: [`UsedPoints`](crate::light_mesh::UsedPoints), a bitmap over bricks in ascending order, however
//! many threads marked it; on a CUDA device [`DevicePoints`](cuda::DevicePoints), a bitmap over the slots of a table whose order
//! is as fixed.

pub(crate) mod cpu;
pub(crate) mod cuda;
#[cfg(test)]
mod tests;

use glam::IVec3;

use crate::light_mesh::{BrickKey, Template, brick_of, point_bit};

/// The blocks of bricks that the template reaches into: at most `side`³ around each cell.
///
/// Where template point k lies in the block depends only on the place of the cell in its own brick, so it is known
/// beforehand for all 64 places.
#[derive(Clone, Debug)]
pub(crate) struct Windows {
    reach: i32,
    side: i32,
    places: Vec<Vec<Place>>,
}

/// Where a template point lies: which brick of the window, which bit of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) slot: u16,
    pub(crate) bit: u8,
}

/// The bricks around one cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window<'a> {
    low: IVec3,
    side: i32,
    /// Place of each template point.
    pub(crate) places: &'a [Place],
}

/// Bricks of a window along each axis. Offsets run from 1 − reach to reach; a run of n points meets at most (n + 2) / 4 + 1 bricks.
pub(crate) fn window_side(reach: i32) -> i32 {
    (2 * reach + 2) / 4 + 1
}

impl Windows {
    pub(crate) fn new(template: &Template) -> Windows {
        let reach = template.reach();
        let side = window_side(reach);
        let places = |bit: i32| {
            let cell = IVec3::new(bit & 3, bit >> 2 & 3, bit >> 4);
            let low = (cell + 1 - reach) >> 2;
            let place = |&offset: &IVec3| {
                let brick: IVec3 = ((cell + offset) >> 2) - low;
                Place {
                    slot: ((brick.z * side + brick.y) * side + brick.x) as u16,
                    bit: point_bit(cell + offset) as u8,
                }
            };
            template.offsets().iter().map(place).collect()
        };
        Windows { reach, side, places: (0..64).map(places).collect() }
    }

    /// Number of bricks of a window.
    pub(crate) fn len(&self) -> usize {
        self.side.pow(3) as usize
    }

    /// The window around `cell`.
    pub(crate) fn around(&self, cell: IVec3) -> Window<'_> {
        Window { low: (cell + 1 - self.reach) >> 2, side: self.side, places: &self.places[point_bit(cell) as usize] }
    }
}

impl Window<'_> {
    /// The key of the brick at `slot`.
    pub(crate) fn key(&self, slot: usize) -> BrickKey {
        let slot = slot as i32;
        let brick = IVec3::new(slot % self.side, slot / self.side % self.side, slot / (self.side * self.side));
        brick_of((self.low + brick) << 2)
    }
}
