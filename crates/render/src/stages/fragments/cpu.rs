//! Fragments on the CPU.

use glam::Vec3;
use lightmesh_layout::constants::{CONTRAST_FLOOR, PIXEL_SHARED, PIXEL_SPLIT};
use rayon::prelude::*;

use crate::accel::Hit;
use crate::antialiasing::Antialiasing;
use crate::data::picture::Picture;
use crate::data::rays::{RayList, Sampled};
use crate::data::samples::PixelSamples;
use crate::data::wave::HostWave;
use crate::stages::pixel_samples::alike::{Facet, mirrors};
use crate::stages::pixel_samples::cpu::is_alike;

/// Number of pixels per task.
const BATCH: usize = 1024;

/// The shared fragments and the single samples of the pixels that count.
pub(crate) fn fragments(
    wave: &HostWave,
    samples: &mut PixelSamples,
    film: &mut Picture,
    all: &Antialiasing,
) -> [RayList; 2] {
    // 1. Which shared pixels are split?
    if !all.apart {
        let indices = 0..samples.state.len() as u32;
        let split: Vec<u32> =
            indices.into_par_iter().filter(|&index| is_split(wave, samples, film, all, index)).collect();
        split.into_iter().for_each(|index| samples.state[index as usize] |= PIXEL_SPLIT);
    }

    // 2. The fragments of the others.
    let width = film.size[0];
    let kept = film.kept.start * width..film.kept.end * width;
    let of_batch = |pixels: &[u32]| {
        let mut lists = [wave.rays.empty(), wave.rays.empty()];
        for &pixel in pixels.iter().filter(|pixel| kept.contains(pixel)) {
            Pixel { wave, samples, all, pixel }.add_fragments(&mut lists);
        }
        wave.job.piece(pixels.len(), || ());
        lists
    };
    let parts: Vec<[RayList; 2]> = wave.rays.pixels.par_chunks(BATCH).map(of_batch).collect();
    let mut lists = [wave.rays.empty(), wave.rays.empty()];
    for part in parts {
        lists.iter_mut().zip(part).for_each(|(list, part)| list.append(part));
    }
    if !all.apart {
        let sampled = Sampled { hits: samples.hits.clone(), first: samples.first, count: samples.numbers.len() };
        lists[0].sampled = Some(sampled.clone());
        lists[1].sampled = Some(sampled);
        // 3. Begin anew.
        for (index, _) in samples.state.iter().enumerate().filter(|(_, state)| **state != PIXEL_SHARED) {
            film.color[index] = [0.0; 3];
            if let Some(caught) = &mut film.caught {
                caught[index] = 0.0;
            }
            if let Some(layers) = &mut film.layers {
                layers.used[index] = 0;
                layers.visibility.iter_mut().for_each(|plane| plane[index] = 0.0);
            }
        }
    }
    lists
}

/// Whether the radiance of a shared pixel differs from a neighbour's.
fn is_split(wave: &HostWave, samples: &PixelSamples, film: &Picture, all: &Antialiasing, index: u32) -> bool {
    let is_shared = |index: u32| samples.state[index as usize] & PIXEL_SHARED != 0;
    // The first sample lies on the pixel's surface.
    let hit = |index: u32| samples.hit(samples.first + index, 0);
    let facet = |index: u32| {
        let pixel = samples.first + index;
        Facet::new(wave.scene, wave.rays.spacing, &wave.rays.through(all, pixel, 0), hit(index))
    };
    if !is_shared(index) || !hit(index).is_some() {
        return false;
    }
    let color = |index: u32| Vec3::from_array(film.color[index as usize]);
    around(index, film.size[0], film.rows.len() as u32).any(|other| {
        is_shared(other)
            && hit(other).is_some()
            && differs(color(index), color(other), all.contrast)
            && facet(index).is_near(&facet(other))
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

impl Pixel<'_> {
    /// Adds its shared fragments and its single samples.
    fn add_fragments(&self, lists: &mut [RayList; 2]) {
        let Pixel { wave, samples, all, pixel } = *self;
        let state = samples.state[(pixel - samples.first) as usize];
        if state == PIXEL_SHARED {
            return;
        }
        let count = samples.numbers.len() as u32;
        let singles = all.apart || state & PIXEL_SPLIT != 0;
        let mut rest = if count == u32::BITS { u32::MAX } else { (1 << count) - 1 };
        while rest != 0 {
            let first = rest.trailing_zeros();
            let part = if all.apart { 1 << first } else { self.part(first, rest) };
            rest &= !part;
            let (size, hit) = (part.count_ones(), samples.hit(pixel, first));
            // What sees nothing costs nothing.
            if !all.apart && (!hit.is_some() || !singles && !mirrors(wave.scene, all, hit)) {
                let is_large = 4 * size > count;
                self.add(&mut lists[usize::from(!is_large)], first, part, size as f32 / all.samples as f32);
                continue;
            }
            for sample in (0..count).filter(|sample| part >> sample & 1 != 0) {
                self.add(&mut lists[1], sample, 0, 1.0 / all.samples as f32);
            }
        }
    }

    /// The samples among `rest` that lie on a surface with `first`.
    fn part(&self, first: u32, rest: u32) -> u32 {
        let hit = self.samples.hit(self.pixel, first);
        let others = (0..self.samples.numbers.len() as u32).filter(|sample| rest >> sample & 1 != 0);
        others
            .filter(|&sample| {
                let other = self.samples.hit(self.pixel, sample);
                is_alike(hit, other, || self.facet(first, hit).continues(&self.facet(sample, other)))
            })
            .fold(0, |part, sample| part | 1 << sample)
    }

    fn facet(&self, sample: u32, hit: &Hit) -> Facet {
        let ray = self.wave.rays.through(self.all, self.pixel, self.samples.numbers.start + sample);
        Facet::new(self.wave.scene, self.wave.rays.spacing, &ray, hit)
    }

    fn add(&self, list: &mut RayList, sample: u32, shared: u32, weight: f32) {
        let sample = self.samples.numbers.start + sample;
        list.rays.push(self.wave.rays.through(self.all, self.pixel, sample));
        list.pixels.push(self.pixel);
        list.samples.push(sample + 1);
        list.shared.push(shared);
        list.weights.push(Vec3::splat(weight));
    }
}
