//! What the samples of pixels see, by object and by material, counted for mattes.

use lightmesh_image::{MAX_RANKS, Matte};
use rayon::prelude::*;

/// The most objects or materials of a pixel whose samples are counted.
const MATTE_SLOTS: u32 = 8;

/// The samples of each pixel by what they see: up to `MATTE_SLOTS` things, in the order in which samples find them. Further things are not
/// counted.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Samples of a pixel.
    samples: u32,
    slots: usize,
    /// Number and count, by object or material, then pixel, then slot.
    counts: [Vec<[u32; 2]>; 2],
}

/// Things of a pixel of `samples` samples that are counted.
pub(crate) fn slots_of(samples: u32) -> usize {
    samples.min(MATTE_SLOTS) as usize
}

/// The ranks of a matte of a pixel of `samples` samples.
pub(crate) fn ranks_of(samples: u32) -> usize {
    MAX_RANKS.min(samples as usize)
}

impl Counted {
    /// No samples of `pixels` pixels.
    pub fn none(samples: u32, pixels: usize) -> Counted {
        let slots = slots_of(samples);
        Counted { samples, slots, counts: [(); 2].map(|()| vec![[0; 2]; slots * pixels]) }
    }

    /// The slots of each pixel: of objects, and of materials.
    pub fn pixels(&mut self) -> impl IndexedParallelIterator<Item = [&mut [[u32; 2]]; 2]> {
        let [objects, materials] = &mut self.counts;
        let materials = materials.par_chunks_exact_mut(self.slots);
        objects.par_chunks_exact_mut(self.slots).zip(materials).map(|(objects, materials)| [objects, materials])
    }

    /// Writes what pixels see to mattes, from place `first` on.
    pub fn write(&self, mattes: [&mut Matte; 2], first: usize) {
        for (counts, matte) in self.counts.iter().zip(mattes) {
            for (pixel, slots) in counts.chunks_exact(self.slots).enumerate() {
                write_ranks(slots, self.samples, matte, first + pixel);
            }
        }
    }
}

/// Counts a sample of a pixel, by the numbers of what it sees.
#[inline]
pub fn count(slots: &mut [&mut [[u32; 2]]; 2], ids: [u32; 2]) {
    for (slots, id) in slots.iter_mut().zip(ids) {
        if let Some(slot) = slots.iter_mut().find(|slot| slot[0] == id || slot[0] == 0) {
            *slot = [id, slot[1] + 1];
        }
    }
}

/// Writes what a pixel sees: large shares first, then small numbers.
pub(crate) fn write_ranks(slots: &[[u32; 2]], samples: u32, matte: &mut Matte, pixel: usize) {
    let mut sorted = [[0; 2]; MATTE_SLOTS as usize];
    let sorted = &mut sorted[..slots.len()];
    sorted.copy_from_slice(slots);
    sorted.sort_unstable_by_key(|&[id, count]| (std::cmp::Reverse(count), id));
    for (&[id, count], rank) in sorted.iter().zip(&mut matte.ranks) {
        (rank.number[pixel], rank.share[pixel]) = (id, count as f32 / samples as f32);
    }
}

/// Takes `share` of a pixel away from the things numbered in `numbers`.
pub fn take_away(matte: &mut Matte, numbers: &[u32], pixel: usize, mut share: f32) {
    for rank in &mut matte.ranks {
        if share > 0.0 && numbers.binary_search(&rank.number[pixel]).is_ok() {
            let rest = (rank.share[pixel] - share).max(0.0);
            share -= rank.share[pixel] - rest;
            rank.share[pixel] = rest;
            if rest == 0.0 {
                rank.number[pixel] = 0;
            }
        }
    }
    matte.sort(pixel);
}
