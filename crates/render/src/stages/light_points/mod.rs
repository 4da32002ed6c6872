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
    spans: Vec<Vec<Span>>,
}

/// Template points that follow each other along x, in a mask as in a brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Span {
    /// Which brick of the window.
    pub(crate) slot: u16,
    /// Which bit of it the first point is.
    pub(crate) bit: u8,
    /// How many there are: 1 to 4.
    pub(crate) count: u8,
    /// Which word of a mask.
    pub(crate) word: u16,
    /// Which bit of it the first point is.
    pub(crate) shift: u8,
}

/// The bricks around one cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window<'a> {
    low: IVec3,
    side: i32,
    /// Where the template points lie, in their order.
    pub(crate) spans: &'a [Span],
}

/// Bricks of a window along each axis. Offsets run from 1 − reach to reach; a run of n points meets at most (n + 2) / 4 + 1 bricks.
pub(crate) fn window_side(reach: i32) -> i32 {
    (2 * reach + 2) / 4 + 1
}

impl Windows {
    pub(crate) fn new(template: &Template) -> Windows {
        let reach = template.reach();
        let side = window_side(reach);
        let spans = |bit: i32| {
            let cell = IVec3::new(bit & 3, bit >> 2 & 3, bit >> 4);
            let low = (cell + 1 - reach) >> 2;
            let mut spans: Vec<Span> = Vec::new();
            for (index, &offset) in template.offsets().iter().enumerate() {
                let brick: IVec3 = ((cell + offset) >> 2) - low;
                let point = Span {
                    slot: ((brick.z * side + brick.y) * side + brick.x) as u16,
                    bit: point_bit(cell + offset) as u8,
                    count: 1,
                    word: (index / 32) as u16,
                    shift: (index % 32) as u8,
                };
                match spans.last_mut() {
                    Some(span) if span.goes_on_with(&point) => span.count += 1,
                    _ => spans.push(point),
                }
            }
            spans
        };
        Windows { reach, side, spans: (0..64).map(spans).collect() }
    }

    /// Number of bricks of a window.
    pub(crate) fn len(&self) -> usize {
        self.side.pow(3) as usize
    }

    /// The window around `cell`.
    pub(crate) fn around(&self, cell: IVec3) -> Window<'_> {
        Window { low: (cell + 1 - self.reach) >> 2, side: self.side, spans: &self.spans[point_bit(cell) as usize] }
    }
}

impl Span {
    /// Whether `point` is the next one, in the same row of the same brick and in the same word.
    fn goes_on_with(&self, point: &Span) -> bool {
        let (slot, bit, word) = (self.slot, self.bit + self.count, self.word);
        bit % 4 != 0 && (slot, bit, word) == (point.slot, point.bit, point.word)
    }

    fn ones(&self) -> u32 {
        (1 << self.count) - 1
    }

    /// These points' bits of a brick, as bits of the mask's word.
    #[inline(always)]
    pub(crate) fn to_mask(self, brick: u64) -> u32 {
        ((brick >> self.bit) as u32 & self.ones()) << self.shift
    }

    /// These points' bits of the mask's word, as bits of a brick.
    #[inline(always)]
    pub(crate) fn to_brick(self, word: u32) -> u64 {
        u64::from(word >> self.shift & self.ones()) << self.bit
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
