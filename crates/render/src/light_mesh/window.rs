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
pub(crate) struct Windows {
    reach: i32,
    side: i32,
    spans: Vec<Vec<Span>>,
}

/// Consecutive template points along x, adjacent both in a mask and in a brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Span {
    /// Index of the brick in the window.
    pub(crate) slot: u16,
    /// The bit of the first point in that brick.
    pub(crate) bit: u8,
    /// Number of points: 1 to 4.
    pub(crate) count: u8,
    /// Index of the word in the mask.
    pub(crate) word: u16,
    /// The bit of the first point in that word.
    pub(crate) shift: u8,
}

/// The bricks around one cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window<'a> {
    low: IVec3,
    side: i32,
    /// Positions of the template points, in their order.
    pub(crate) spans: &'a [Span],
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
    pub(crate) fn new(template: &Template) -> Windows {
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
    pub(crate) fn len(&self) -> usize {
        self.side.pow(3) as usize
    }

    /// The window around `cell`.
    pub(crate) fn around(&self, cell: IVec3) -> Window<'_> {
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
        brick_of((self.low + brick) << BRICK_BITS)
    }
}

#[cfg(test)]
mod tests {
    use super::super::bricks::point_bit;
    use super::*;

    #[test]
    fn a_window_finds_every_template_point_of_every_cell() {
        for radius in [0.5, 1.0, 2.1, 3.1, 4.1, 5.1, 16.0] {
            let template = Template::new(radius).unwrap();
            let windows = Windows::new(&template);
            for place in 0..64 {
                let cell = IVec3::new(40, 44, 48) + IVec3::new(place & 3, place >> 2 & 3, place >> 4);
                let window = windows.around(cell);
                let mut offsets = template.offsets().iter().enumerate();
                for span in window.spans {
                    assert!(usize::from(span.slot) < windows.len());
                    for (point, (index, &offset)) in (0..span.count).zip(&mut offsets) {
                        let brick = window.key(usize::from(span.slot));
                        assert_eq!(brick, brick_of(cell + offset), "R = {radius}, {cell}, {offset}");
                        assert_eq!(u32::from(span.bit + point), point_bit(cell + offset));
                        assert_eq!(usize::from(span.word) * 32 + usize::from(span.shift + point), index);
                    }
                }
                assert_eq!(offsets.next(), None, "R = {radius}, {cell}");
            }
        }
    }

    #[test]
    fn a_span_takes_its_bits_and_no_others() {
        let span = Span { slot: 3, bit: 60, count: 3, word: 1, shift: 29 };
        assert_eq!((span.to_mask(u64::MAX), span.to_brick(u32::MAX)), (0b111 << 29, 0b111 << 60));
        assert_eq!((span.to_mask(1 << 61 | 1 << 63), span.to_brick(1 << 30 | 1 << 28)), (1 << 30, 1 << 61));
    }
}
