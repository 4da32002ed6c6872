//! Where the second rays of a coarse record go: into those parts of the hemisphere in which its first ones see different things. Twin: `guide.cuh`.
//!
//! The square of directions is divided into blocks, of 2×2 of the first rays each. A block gets this share of the second ones:
//!
//! ```text
//! p_b = (1 − g) / B + g σ_b / Σ σ        g: GUIDED; B: number of blocks
//! ```
//!
//! σ_b is the standard deviation of luminance times weight, of the first rays in the block and of those next to it: the edge of a window may
//! be anywhere between two of them. What a block's rays see is divided by how many there are. So the second rays estimate without bias
//! whatever the first ones saw. (Adaptive stratified sampling: Mitchell: *Generating Antialiased Images at Low Sampling Densities*, 1987.)

use glam::Vec2;
use lightmesh_layout::constants::{GUIDE_BLOCK, GUIDE_RING, GUIDED, LAST_DIGIT};

use super::hemisphere_rays::HemisphereRays;
use crate::sampling::random_bits;

/// How many rays go into each block, for some records.
pub(super) struct Guides {
    /// Along each side of the square.
    blocks: u32,
    /// By record and block: the rays of all blocks up to this one.
    ends: Vec<u32>,
}

/// The same for one record.
#[derive(Clone, Copy)]
pub(super) struct Guide<'a> {
    blocks: u32,
    ends: &'a [u32],
}

/// Blocks along each side of the square of directions.
pub(super) fn blocks(first: HemisphereRays) -> u32 {
    first.side() / GUIDE_BLOCK
}

impl Guides {
    /// No record so far.
    pub(super) fn new(first: HemisphereRays) -> Guides {
        Guides { blocks: blocks(first), ends: Vec::new() }
    }

    /// Adds a record: where its rays of `hemisphere` go, by what each of the first ones saw, luminance times weight, row by row.
    pub(super) fn add(&mut self, first: HemisphereRays, hemisphere: HemisphereRays, seen: &[f32]) {
        let count = self.blocks * self.blocks;
        let of_block = |block| deviation(seen, first.side(), block % self.blocks, block / self.blocks);
        let deviations: Vec<f32> = (0..count).map(of_block).collect();
        let total = deviations.iter().fold(0.0, |total, deviation| total + deviation);
        let (guided, even) = if total > 0.0 { (GUIDED / total, 1.0 - GUIDED) } else { (0.0, 1.0) };
        let mut share = 0.0;
        for (block, deviation) in (1..).zip(deviations) {
            share += even / count as f32 + guided * deviation;
            let end = if block < count { (share * hemisphere.len() as f32) as u32 } else { hemisphere.len() as u32 };
            self.ends.push(end);
        }
    }

    /// That of the record that was added after so many others.
    pub(super) fn of(&self, record: usize) -> Guide<'_> {
        let count = (self.blocks * self.blocks) as usize;
        Guide { blocks: self.blocks, ends: &self.ends[record * count..(record + 1) * count] }
    }
}

/// Where the second rays of one record lie in the square [−1, 1]², and their areas relative to those of an even hemisphere: `sides` are those of the first and
/// the second rays, `seen` is luminance times weight of each of the first ones, row by row.
pub fn guided(sides: [u32; 2], seen: &[f32], seed: u64) -> Vec<(Vec2, f32)> {
    let [first, second] = sides.map(HemisphereRays::new);
    let mut guides = Guides::new(first);
    guides.add(first, second, seen);
    (0..second.len() as u32).map(|index| guides.of(0).place(second, seed, index)).collect()
}

/// The standard deviation of what the first rays saw in a block and next to it.
fn deviation(seen: &[f32], side: u32, column: u32, row: u32) -> f32 {
    let around = |block: u32| {
        (GUIDE_BLOCK * block).saturating_sub(GUIDE_RING)..(GUIDE_BLOCK * (block + 1) + GUIDE_RING).min(side)
    };
    let (mut sum, mut square, mut count) = (0.0, 0.0, 0.0);
    for y in around(row) {
        for x in around(column) {
            let value = seen[(y * side + x) as usize];
            sum += value;
            square += value * value;
            count += 1.0;
        }
    }
    let mean = sum / count;
    (square / count - mean * mean).max(0.0).sqrt()
}

impl Guide<'_> {
    /// Where ray number `index` of a hemisphere lies in the square [−1, 1]², and the area that it stands for, relative to that of a ray of an even hemisphere.
    /// In a block, rays are the points of Hammersley's set, scrambled. They depend on its number of rays alone: as something moves, those of other
    /// blocks stay.
    pub(super) fn place(&self, hemisphere: HemisphereRays, seed: u64, index: u32) -> (Vec2, f32) {
        let block = self.ends.partition_point(|&end| end <= index) as u32;
        let first = if block > 0 { self.ends[block as usize - 1] } else { 0 };
        let count = self.ends[block as usize] - first;
        let number = index - first;
        let digits = |bits: u32| (bits >> 8) as f32 * LAST_DIGIT;
        let bits = |key: u64| random_bits(seed, key << 32 | u64::from(block), hemisphere.side() as usize) as u32;
        let (scramble, within) = (bits(0), bits(u64::from(number) + 1));
        let across = (number as f32 + digits(within)) / count as f32;
        let along = digits(number.reverse_bits() ^ scramble);
        let side = self.blocks as f32;
        let x = 2.0 * ((block % self.blocks) as f32 + across) / side - 1.0;
        let y = 2.0 * ((block / self.blocks) as f32 + along) / side - 1.0;
        (Vec2::new(x, y), hemisphere.len() as f32 / (count as f32 * side * side))
    }
}
