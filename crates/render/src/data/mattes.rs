//! What the samples of pixels see, by object and by material, counted for mattes.

use lightmesh_image::{MOST_RANKS, Matte};
use rayon::prelude::*;

/// The most objects or materials of a pixel whose samples are counted.
const MATTE_SLOTS: u32 = 8;

/// The samples of each pixel by what they see: up to [`MATTE_SLOTS`] things, in the order in which samples find them. Further things are not
/// counted.
#[derive(Clone, Debug)]
pub(crate) struct Counted {
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
    MOST_RANKS.min(samples as usize)
}

impl Counted {
    /// No samples of `pixels` pixels.
    pub(crate) fn none(samples: u32, pixels: usize) -> Counted {
        let slots = slots_of(samples);
        Counted { samples, slots, counts: [(); 2].map(|()| vec![[0; 2]; slots * pixels]) }
    }

    /// The slots of each pixel: of objects, and of materials.
    pub(crate) fn pixels(&mut self) -> impl IndexedParallelIterator<Item = [&mut [[u32; 2]]; 2]> {
        let [objects, materials] = &mut self.counts;
        let materials = materials.par_chunks_exact_mut(self.slots);
        objects.par_chunks_exact_mut(self.slots).zip(materials).map(|(objects, materials)| [objects, materials])
    }

    /// Writes what pixels see to mattes, from place `first` on.
    pub(crate) fn write(&self, mattes: [&mut Matte; 2], first: usize) {
        for (counts, matte) in self.counts.iter().zip(mattes) {
            for (pixel, slots) in counts.chunks_exact(self.slots).enumerate() {
                write_ranks(slots, self.samples, matte, first + pixel);
            }
        }
    }
}

/// Counts a sample of a pixel, by the numbers of what it sees.
#[inline]
pub(crate) fn count(slots: &mut [&mut [[u32; 2]]; 2], ids: [u32; 2]) {
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
pub(crate) fn take_away(matte: &mut Matte, numbers: &[u32], pixel: usize, mut share: f32) {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(matte: &Matte, pixel: usize) -> Vec<(u32, f32)> {
        matte.ranks.iter().map(|rank| (rank.number[pixel], rank.share[pixel])).collect()
    }

    /// Counts samples of the last pixel.
    fn count_all(counted: &mut Counted, all: impl IntoIterator<Item = [u32; 2]>) {
        let mut pixels: Vec<_> = counted.pixels().collect();
        let slots = pixels.last_mut().unwrap();
        all.into_iter().for_each(|ids| count(slots, ids));
    }

    #[test]
    fn samples_are_counted_by_what_they_see() {
        let mut counted = Counted::none(16, 2);
        count_all(&mut counted, [3, 2, 2, 7, 3, 2, 9].map(|object| [object, 1]));
        let mut mattes = [6, 6].map(|ranks| Matte::nothing(Vec::new(), ranks, 3));
        let [objects, materials] = &mut mattes;
        counted.write([objects, materials], 1);
        let share = |count: u32| count as f32 / 16.0;
        let rest = [(0, 0.0); 5];
        assert_eq!(seen(objects, 2), [(2, share(3)), (3, share(2)), (7, share(1)), (9, share(1)), rest[0], rest[1]]);
        assert_eq!((seen(materials, 2)[0], &seen(materials, 2)[1..]), ((1, share(7)), &rest[..]));
        assert!(seen(objects, 0).iter().chain(&seen(objects, 1)).all(|seen| *seen == (0, 0.0)));
    }

    #[test]
    fn the_largest_six_of_eight_are_kept_and_others_are_not_counted() {
        let mut counted = Counted::none(64, 1);
        count_all(&mut counted, (1..=9).flat_map(|object| (0..object).map(move |_| [object, 0])));
        let mut mattes = [6, 6].map(|ranks| Matte::nothing(Vec::new(), ranks, 1));
        let [objects, materials] = &mut mattes;
        counted.write([objects, materials], 0);
        assert_eq!(seen(objects, 0).iter().map(|seen| seen.0).collect::<Vec<_>>(), [8, 7, 6, 5, 4, 3]);
    }

    #[test]
    fn what_is_caught_is_taken_away() {
        let mut matte = Matte::nothing(Vec::new(), 3, 1);
        for (rank, seen) in matte.ranks.iter_mut().zip([(4, 0.5), (2, 0.375), (5, 0.125)]) {
            (rank.number[0], rank.share[0]) = seen;
        }
        take_away(&mut matte, &[4, 5], 0, 0.25);
        assert_eq!(seen(&matte, 0), [(2, 0.375), (4, 0.25), (5, 0.125)]);
        take_away(&mut matte, &[4, 5], 0, 0.3125);
        assert_eq!(seen(&matte, 0), [(2, 0.375), (5, 0.0625), (0, 0.0)]);
    }
}
