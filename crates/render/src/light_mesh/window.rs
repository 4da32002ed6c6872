//! The bricks around a cell: the positions of the template's points in the sparse store.

use glam::IVec3;

use lightmesh_layout::constants::{BRICK_BITS, POINT_BITS};

use super::bricks::{BrickKey, brick_of, place_of_bit, point_bit};
use super::template::Template;

/// The blocks of bricks that the template reaches into: at most `side`³ around each cell.
///
/// The position of template point k in the block depends only on the position of the cell in its own brick, so it is precomputed
/// for all 64 positions.
#[derive(Clone, Debug)]
pub struct Windows {
    reach: i32,
    side: i32,
    spans: Vec<Vec<Span>>,
}

/// Consecutive template points along x, adjacent both in a mask and in a brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Index of the brick in the window.
    pub slot: u16,
    /// The bit of the first point in that brick.
    pub bit: u8,
    /// Number of points: 1 to 4.
    pub count: u8,
    /// Index of the word in the mask.
    pub word: u16,
    /// The bit of the first point in that word.
    pub shift: u8,
}

/// The bricks around one cell.
#[derive(Clone, Copy, Debug)]
pub struct Window<'a> {
    low: IVec3,
    side: i32,
    /// Positions of the template points, in their order.
    pub spans: &'a [Span],
}

/// Number of bricks of the window around a cell.
pub(crate) fn window_bricks(reach: i32) -> u32 {
    window_side(reach).pow(3) as u32
}

/// Number of bricks of a window along each axis. Offsets run from 1 − reach to reach; a run of n points meets at most (n + 2) / 4 +
/// 1 bricks.
fn window_side(reach: i32) -> i32 {
    (2 * reach + 2) / (1 << BRICK_BITS) + 1
}

impl Windows {
    /// The windows of cells at all places in a brick.
    pub fn new(template: &Template) -> Windows {
        let reach = template.reach();
        let side = window_side(reach);
        let spans = |bit: u32| {
            let cell = place_of_bit(bit);
            let low = (cell + 1 - reach) >> BRICK_BITS;
            let mut spans: Vec<Span> = Vec::new();
            for (index, &offset) in template.offsets().iter().enumerate() {
                let brick: IVec3 = ((cell + offset) >> BRICK_BITS) - low;
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
        Windows { reach, side, spans: (0..1 << POINT_BITS).map(spans).collect() }
    }

    /// Number of bricks of a window.
    #[allow(clippy::len_without_is_empty, reason = "a window is never empty")]
    pub fn len(&self) -> usize {
        self.side.pow(3) as usize
    }

    /// The window around `cell`.
    pub fn around(&self, cell: IVec3) -> Window<'_> {
        Window {
            low: (cell + 1 - self.reach) >> BRICK_BITS,
            side: self.side,
            spans: &self.spans[point_bit(cell) as usize],
        }
    }
}

impl Span {
    /// Whether `point` is the next one in the same row of the same brick and in the same word.
    fn goes_on_with(&self, point: &Span) -> bool {
        let (slot, bit, word) = (self.slot, self.bit + self.count, self.word);
        bit % (1 << BRICK_BITS) != 0 && (slot, bit, word) == (point.slot, point.bit, point.word)
    }

    fn ones(&self) -> u32 {
        (1 << self.count) - 1
    }

    /// These points' bits of a brick, as bits of the mask's word.
    #[inline(always)]
    pub fn to_mask(self, brick: u64) -> u32 {
        ((brick >> self.bit) as u32 & self.ones()) << self.shift
    }

    /// These points' bits of the mask's word, as bits of a brick.
    #[inline(always)]
    pub fn to_brick(self, word: u32) -> u64 {
        u64::from(word >> self.shift & self.ones()) << self.bit
    }
}

impl Window<'_> {
    /// The key of the brick at `slot`.
    pub fn key(&self, slot: usize) -> BrickKey {
        let slot = slot as i32;
        let brick = IVec3::new(slot % self.side, slot / self.side % self.side, slot / (self.side * self.side));
        brick_of((self.low + brick) << BRICK_BITS)
    }
}
