//! Vertices at the same position are one point.

use super::steps::count_step;
use crate::Position;

/// By vertex: its point, named by the first vertex there. Positions are the same if their coordinates are equal; 0 equals −0.
///
/// Vertices are sorted by a hash of their positions. Where hashes are equal, by chance or by malice, the positions themselves decide, so
/// that O(n log n) steps are enough for all.
pub fn weld<P: Position>(positions: &[P]) -> Vec<u32> {
    let place = |entry: u64| bits(positions[entry as u32 as usize]);
    let hash = |entry: u64| entry >> 32;
    let mut entries: Vec<u64> = positions
        .iter()
        .zip(0_u32..)
        .map(|(&position, vertex)| u64::from(mixed(bits(position))) << 32 | u64::from(vertex))
        .collect();
    entries.sort_unstable_by(|&a, &b| {
        count_step();
        hash(a).cmp(&hash(b)).then_with(|| place(a).cmp(&place(b))).then(a.cmp(&b))
    });
    let mut points = vec![0; positions.len()];
    for same in entries.chunk_by(|&a, &b| hash(a) == hash(b) && place(a) == place(b)) {
        same.iter().for_each(|&vertex| points[vertex as u32 as usize] = same[0] as u32);
    }
    points
}

/// Bits that are equal for equal coordinates.
fn bits<P: Position>(position: P) -> [u64; 3] {
    position.to_double().to_array().map(|coordinate| (coordinate + 0.0).to_bits())
}

/// A hash of 32 bits.
fn mixed(bits: [u64; 3]) -> u32 {
    // The odd number nearest to 2⁶⁴ divided by the golden ratio: Knuth, The Art of Computer Programming, volume 3, section 6.4.
    const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
    let hash = bits.into_iter().fold(0, |hash: u64, bits| {
        let hash = (hash.rotate_left(5) ^ bits).wrapping_mul(GOLDEN);
        hash ^ hash >> 32
    });
    hash as u32
}
