//! Fragments on the CPU.

use std::cell::OnceCell;
use std::ops::Range;

use glam::Vec3;
use lightmesh_layout::constants::{CONTRAST_FLOOR, PIXEL_SHARED, PIXEL_SPLIT};
use lightmesh_trace::accel::Hit;
use rayon::prelude::*;

use crate::antialiasing::Antialiasing;
use crate::counters::Tally;
use crate::data::picture::{Picture, light_groups_of};
use crate::data::rays::{RayList, Sampled};
use crate::data::samples::PixelSamples;
use crate::data::wave::HostWave;
use crate::sampling::Pattern;
use crate::stages::pixel_samples::same_surface::{Facet, is_transmissive, mirrored_samples};

/// Number of pixels per task.
const BATCH: usize = 1024;

/// The shared fragments, the single samples and the mirror samples of the pixels that count, with what they see.
pub(crate) fn fragments(
    wave: &HostWave,
    samples: &mut PixelSamples,
    film: &mut Picture,
    all: &Antialiasing,
) -> [(RayList, Vec<Hit>); 3] {
    // 1. Which shared pixels are split?
    if !all.apart {
        let indices = 0..samples.state.len() as u32;
        let split: Vec<u32> =
            indices.into_par_iter().filter(|&index| is_split(wave, samples, film, all, index)).collect();
        split.into_iter().for_each(|index| samples.state[index as usize] |= PIXEL_SPLIT);
    }

    // 2. The fragments of the others.
    let kept = kept_pixels(film);
    let of_batch = |pixels: &[u32]| {
        let mut lists = [(); 3].map(|()| (wave.rays.empty(), Vec::new()));
        for &pixel in pixels.iter().filter(|pixel| kept.contains(pixel)) {
            Pixel { wave, samples, all, pixel }.add_fragments(&mut lists);
        }
        wave.context.piece(pixels.len(), || ());
        lists
    };
    let parts: Vec<[(RayList, Vec<Hit>); 3]> = wave.rays.pixels.par_chunks(BATCH).map(of_batch).collect();
    let mut lists = [0, 1, 2].map(|list| {
        let count = parts.iter().map(|part| part[list].1.len()).sum();
        let mut rays = wave.rays.empty();
        rays.reserve(count);
        (rays, Vec::with_capacity(count))
    });
    for part in parts {
        for ((rays, hits), (part_rays, mut part_hits)) in lists.iter_mut().zip(part) {
            rays.append(part_rays);
            hits.append(&mut part_hits);
        }
    }
    let found = lists[..2].iter().flat_map(|(_, hits)| hits).filter(|hit| hit.is_some()).count();
    Tally::add(&wave.context.tally.surface_points, found as u64);
    if !all.apart {
        let sampled = Sampled { hits: samples.hits.clone(), first: samples.first, count: samples.numbers.len() };
        lists.iter_mut().for_each(|(rays, _)| rays.sampled = Some(sampled.clone()));
        // 3. Begin anew.
        for (index, _) in samples.state.iter().enumerate().filter(|(_, state)| **state != PIXEL_SHARED) {
            film.color[index] = [0.0; 3];
            if let Some(caught) = &mut film.caught {
                caught[index] = 0.0;
            }
            if let Some(layers) = &mut film.layers {
                layers.used[index] = 0;
                layers.visibility.iter_mut().for_each(|plane| plane[index] = 0.0);
                light_groups_of(layers).for_each(|plane| plane[index] = [0.0; 3]);
            }
        }
    }
    lists
}

/// How many there will be of each list, but for pixels that will be split.
pub(crate) fn fragment_counts(
    wave: &HostWave,
    samples: &PixelSamples,
    film: &Picture,
    all: &Antialiasing,
) -> [usize; 3] {
    let kept = kept_pixels(film);
    let of_batch = |pixels: &[u32]| {
        let mut counts = [0; 3];
        for &pixel in pixels.iter().filter(|pixel| kept.contains(pixel)) {
            Pixel { wave, samples, all, pixel }.each_fragment(|Fragment { list, .. }| counts[list] += 1);
        }
        counts
    };
    let sum = |a: [usize; 3], b: [usize; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    wave.rays.pixels.par_chunks(BATCH).map(of_batch).reduce(|| [0; 3], sum)
}

/// The pixels that count.
fn kept_pixels(film: &Picture) -> Range<u32> {
    let width = film.size[0];
    film.kept.start * width..film.kept.end * width
}

/// Whether the radiance of a shared pixel differs from a neighbour's.
fn is_split(wave: &HostWave, samples: &PixelSamples, film: &Picture, all: &Antialiasing, index: u32) -> bool {
    let is_shared = |index: u32| samples.state[index as usize] & PIXEL_SHARED != 0;
    // The first sample lies on the pixel's surface.
    let hit = |index: u32| samples.hit(samples.first + index, 0);
    let facet = |index: u32| {
        let pixel = samples.first + index;
        Facet::seen(wave.scene, wave.rays.spacing, &wave.rays.through(all, pixel, 0), hit(index))
    };
    if !is_shared(index) {
        return false;
    }
    let color = |index: u32| Vec3::from_array(film.color[index as usize]);
    let own = OnceCell::new();
    let window = &wave.rays.window;
    let leaves_image = window.leaves_image();
    around(index, film.size[0], film.rows.len() as u32).any(|other| {
        !(leaves_image && window.is_beyond(samples.first + index, samples.first + other))
            && is_shared(other)
            && differs(color(index), color(other), all.contrast)
            && hit(index).is_some()
            && hit(other).is_some()
            && own.get_or_init(|| facet(index)).is_near(&facet(other))
    })
}

/// The pixels of some rows around one of them, and it.
fn around(index: u32, width: u32, rows: u32) -> impl Iterator<Item = u32> {
    let (x, y) = (index % width, index / width);
    let columns = x.saturating_sub(1)..width.min(x + 2);
    (y.saturating_sub(1)..rows.min(y + 2)).flat_map(move |row| columns.clone().map(move |column| row * width + column))
}

/// Whether the difference between two colours can be seen.
fn differs(a: Vec3, b: Vec3, contrast: f32) -> bool {
    let bound = contrast * (a.max(b) + CONTRAST_FLOOR);
    let apart = (a - b).abs();
    apart.x > bound.x || apart.y > bound.y || apart.z > bound.z
}

/// A pixel whose samples are parted.
struct Pixel<'a> {
    wave: &'a HostWave<'a>,
    samples: &'a PixelSamples,
    all: &'a Antialiasing,
    pixel: u32,
}

/// A part of a pixel's samples that is shaded, or a mirror sample.
struct Fragment {
    /// Shared fragments, single samples, mirror samples.
    list: usize,
    /// The first of its samples.
    sample: u32,
    /// All of them, as bits, if they are shared.
    shared: u32,
    /// Its share of the pixel.
    weight: f32,
}

impl Pixel<'_> {
    /// Adds its shared fragments, its single samples and its mirror samples.
    fn add_fragments(&self, lists: &mut [(RayList, Vec<Hit>); 3]) {
        let pattern = self.all.pattern(self.wave.rays.window.number(self.pixel));
        self.each_fragment(|fragment| self.add(&mut lists[fragment.list], &pattern, &fragment));
    }

    /// Hands each of them to `take`.
    fn each_fragment(&self, mut take: impl FnMut(Fragment)) {
        let Pixel { wave, samples, all, pixel } = *self;
        let state = samples.state[(pixel - samples.first) as usize];
        let mut add = |list, sample, shared, weight| take(Fragment { list, sample, shared, weight });
        let (count, single) = (samples.numbers.len() as u32, 1.0 / all.samples as f32);
        if state == PIXEL_SHARED {
            let followed = mirrored_samples(wave.scene, all, samples.hit(pixel, 0), count);
            (0..followed).for_each(|sample| add(2, sample, 0, count as f32 / (followed * all.samples) as f32));
            return;
        }
        if all.apart || state & PIXEL_SPLIT != 0 {
            (0..count).for_each(|sample| add(1, sample, 0, single));
            return;
        }
        let owners = samples.owners_of(pixel);
        let owned = |first: u32| (first..count).filter(move |&sample| u32::from(owners[sample as usize]) == first);
        for first in (0..count).filter(|&sample| u32::from(owners[sample as usize]) == sample) {
            // What sees nothing costs nothing.
            let hit = samples.hit(pixel, first);
            if is_transmissive(wave.scene, hit) {
                owned(first).for_each(|sample| add(1, sample, 0, single));
                continue;
            }
            let part = owned(first).fold(0_u32, |part, sample| part | 1 << sample);
            let size = part.count_ones();
            add(0, first, part, size as f32 / all.samples as f32);
            let followed = mirrored_samples(wave.scene, all, hit, size);
            let weight = size as f32 / (followed * all.samples) as f32;
            owned(first).take(followed as usize).for_each(|sample| add(2, sample, 0, weight));
        }
    }

    fn add(&self, (list, hits): &mut (RayList, Vec<Hit>), pattern: &Pattern, fragment: &Fragment) {
        let &Fragment { sample, shared, weight, .. } = fragment;
        hits.push(*self.samples.hit(self.pixel, sample));
        let sample = self.samples.numbers.start + sample;
        let view = self.wave.rays.view.expect("the rays are a camera's");
        list.rays.push(view.ray_beside(self.pixel, self.all.within(pattern, sample)));
        list.pixels.push(self.pixel);
        list.samples.push(sample + 1);
        list.shared.push(shared);
        list.weights.push(Vec3::splat(weight));
    }
}
