//! Antialiasing: where the samples of a pixel lie.
//!
//! A pixel's colour is the mean over the area of a filter. Samples are distributed by importance: their distances from the pixel's
//! centre are those that the inverse of the filter's cumulative distribution gives for evenly distributed numbers, so that all of
//! them have the same weight. The numbers are an Owen-scrambled Sobol sequence with a scrambling of its own in each pixel
//! ([`Pattern`]), the same on all devices. The filter is a product of two functions of one coordinate.

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::OnceLock;

use fearless_simd::prelude::*;
use fearless_simd::{Level, f32x8, u32x8};
use lightmesh_layout::constants::{FILTER_PLACES, FILTER_STEPS, MARGIN_ROWS, MOST_SHARED, PIXEL_PATTERN};

use crate::accel::Ray;
use crate::sampling::Pattern;
use crate::settings::Filter;
use crate::simd::{LANES, dispatch};
use crate::view::View;

/// Samples in a wave if none are shared.
const APART: u32 = 8;
/// Number of parts over which a filter is integrated.
const PARTS: usize = 1 << 14;
/// Neighbouring pixels on one surface that differ by this part of the brighter one are sampled one by one, if lights have
/// [`FULL_SAMPLES`].
const CONTRAST: f32 = 0.15;
/// With fewer samples, differences are noise more often.
const FULL_SAMPLES: f32 = 64.0;

/// The samples of an image's pixels.
#[derive(Clone, Debug)]
pub struct Antialiasing {
    /// Number of samples of a pixel.
    pub samples: u32,
    /// Whether each sample is shaded by itself, even where several of a pixel lie on one surface.
    pub apart: bool,
    /// Whether samples in mirrors are followed by further rays.
    pub mirrors: bool,
    /// Whether the surface points of all pixels are needed, also where the samples of a pixel lie on several surfaces.
    pub keeps: bool,
    /// The relative difference to a neighbour from which a pixel's samples are shaded one by one.
    pub contrast: f32,
    pub(crate) seed: u64,
    pub(crate) quantiles: [f32; FILTER_PLACES as usize],
    /// The width in pixels of a square over which evenly spread samples vary as much as over the filter.
    pub(crate) breadth: f32,
}

impl Antialiasing {
    /// `samples` samples of each pixel, distributed by `filter`; `seed` selects their pattern. Lights have `light_samples` samples.
    pub fn new(samples: u32, filter: Filter, seed: u64, light_samples: u32) -> Antialiasing {
        let noise = (FULL_SAMPLES / light_samples.max(1) as f32).sqrt().max(1.0);
        Antialiasing {
            samples,
            apart: samples > MOST_SHARED,
            mirrors: false,
            keeps: false,
            contrast: CONTRAST * noise,
            seed,
            breadth: breadth(table(filter)),
            quantiles: *table(filter),
        }
    }

    /// Samples of a pixel whose hits are held at the same time.
    pub(crate) fn at_once(&self) -> u32 {
        if self.apart { self.samples.min(APART) } else { self.samples }
    }

    /// Rows above and below a band that decide what its pixels share.
    pub(crate) fn margin(&self) -> u32 {
        if self.apart { 0 } else { MARGIN_ROWS }
    }

    /// Where sample number `sample` of pixel number `number` lies, in pixels from its centre: to the right and down.
    #[inline(always)]
    pub(crate) fn aside(&self, number: u32, sample: u32) -> [f32; 2] {
        self.within(&self.pattern(number), sample)
    }

    /// The pattern of the samples of pixel number `number` of the image.
    #[inline(always)]
    pub(crate) fn pattern(&self, number: u32) -> Pattern {
        Pattern::new(self.seed, u64::from(number), PIXEL_PATTERN as usize)
    }

    /// The ray through sample number `sample` of a pixel of a view.
    #[inline(always)]
    pub(crate) fn ray(&self, view: &View, pixel: u32, sample: u32) -> Ray {
        view.ray_beside(pixel, self.aside(view.window().number(pixel), sample))
    }

    /// The rays through samples `numbers` of the pixels `pixels` of a view, pixel by pixel: the same bits as [`Antialiasing::ray`].
    pub(crate) fn rays(&self, level: Level, view: &View, pixels: Range<u32>, numbers: Range<u32>, rays: &mut Vec<Ray>) {
        rays.clear();
        dispatch!(level, simd => self.add_rays(simd, view, pixels, numbers, rays));
    }

    #[inline(always)]
    fn add_rays<S: Simd>(&self, simd: S, view: &View, pixels: Range<u32>, numbers: Range<u32>, rays: &mut Vec<Ray>) {
        let lanes = u32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        for pixel in pixels {
            let pattern = self.pattern(view.window().number(pixel));
            let mut first = numbers.start;
            while first < numbers.end {
                let [x, y] = pattern.planar_points(simd, lanes + u32x8::splat(simd, first));
                let aside = [self.quantiles_of(simd, x), self.quantiles_of(simd, y)];
                let count = LANES.min((numbers.end - first) as usize);
                rays.extend_from_slice(&view.rays_beside(simd, pixel, aside)[..count]);
                first += LANES as u32;
            }
        }
    }

    /// The offsets below which the shares `u` of the filter lie.
    #[inline(always)]
    fn quantiles_of<S: Simd>(&self, simd: S, u: f32x8<S>) -> f32x8<S> {
        let u: [f32; LANES] = u.into();
        let mut offsets = [0.0; LANES];
        for lane in 0..LANES {
            offsets[lane] = self.quantile(u[lane]);
        }
        f32x8::from_slice(simd, &offsets)
    }

    /// Where sample number `sample` of a pixel with this pattern lies.
    #[inline(always)]
    pub(crate) fn within(&self, pattern: &Pattern, sample: u32) -> [f32; 2] {
        let point = pattern.point(sample);
        [self.quantile(point.x), self.quantile(point.y)]
    }

    /// The offset below which the share `u` of the filter lies, for `u` in [0, 1).
    #[inline(always)]
    fn quantile(&self, u: f32) -> f32 {
        let place = u * FILTER_STEPS as f32;
        let step = place as usize;
        let (low, high) = (self.quantiles[step], self.quantiles[step + 1]);
        low + (place - step as f32) * (high - low)
    }
}

/// The [`quantiles`] of a filter. They are computed once, which takes about as long as a small image on a GPU.
fn table(filter: Filter) -> &'static [f32; FILTER_PLACES as usize] {
    static TABLES: [OnceLock<[f32; FILTER_PLACES as usize]>; 3] = [const { OnceLock::new() }; 3];
    let number = Filter::ALL.iter().position(|&other| other == filter).unwrap_or_default();
    TABLES[number].get_or_init(|| quantiles(filter))
}

/// The offsets below which each 1/63 of a filter lies.
fn quantiles(filter: Filter) -> [f32; FILTER_PLACES as usize] {
    let radius = 0.5 * filter.width();
    let middle = |part: usize| radius * ((part as f64 + 0.5) / (0.5 * PARTS as f64) - 1.0);
    let values: Vec<f64> = (0..PARTS).map(|part| weight(filter, middle(part))).collect();
    let total: f64 = values.iter().sum();
    let (mut part, mut below) = (0, 0.0);
    let mut offsets = [0.0; FILTER_PLACES as usize];
    let half = FILTER_PLACES as usize / 2;
    for (step, offset) in offsets.iter_mut().enumerate().take(half) {
        let share = total * step as f64 / f64::from(FILTER_STEPS);
        while below + values[part] < share {
            below += values[part];
            part += 1;
        }
        *offset = (radius * ((part as f64 + (share - below) / values[part]) / (0.5 * PARTS as f64) - 1.0)) as f32;
    }
    // Symmetric, so that what changes linearly is not shifted.
    (0..half).for_each(|step| offsets[FILTER_STEPS as usize - step] = -offsets[step]);
    offsets
}

/// The width of the square with the variance of a filter.
fn breadth(quantiles: &[f32; FILTER_PLACES as usize]) -> f32 {
    // Between two of them samples are spread evenly.
    let square = |ends: &[f32]| (ends[0] * ends[0] + ends[0] * ends[1] + ends[1] * ends[1]) / 3.0;
    let variance = quantiles.windows(2).map(square).sum::<f32>() / FILTER_STEPS as f32;
    (12.0 * variance).sqrt()
}

/// A filter at `offset` pixels from the centre, within its width.
fn weight(filter: Filter, offset: f64) -> f64 {
    match filter {
        Filter::Box => 1.0,
        // Three standard deviations to either side.
        Filter::Gauss => (-0.5 * (6.0 * offset / filter.width()).powi(2)).exp(),
        Filter::BlackmanHarris => {
            let turn = TAU * (offset / filter.width() + 0.5);
            0.35875 - 0.48829 * turn.cos() + 0.14128 * (2.0 * turn).cos() - 0.01168 * (3.0 * turn).cos()
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use lightmesh_scene::{Camera, Projection};

    use super::*;
    use crate::view::Window;

    const FILTERS: [Filter; 3] = [Filter::Box, Filter::Gauss, Filter::BlackmanHarris];

    #[test]
    fn samples_have_the_density_of_the_filter() {
        for filter in FILTERS {
            let offsets = quantiles(filter);
            let radius = 0.5 * filter.width();
            assert_eq!((offsets[0], offsets[63]), (-radius as f32, radius as f32), "{filter:?}");
            let area = |from: f64, to: f64| {
                let part = (to - from) / 1000.0;
                (0..1000).map(|i| part * weight(filter, from + (f64::from(i) + 0.5) * part)).sum::<f64>()
            };
            let all = area(-radius, radius);
            for step in offsets.windows(2) {
                let share = area(f64::from(step[0]), f64::from(step[1])) / all;
                assert!((share - 1.0 / 63.0).abs() < 1e-4, "{filter:?}: {share}");
            }
        }
    }

    #[test]
    fn every_filter_has_a_table_of_its_own() {
        for &filter in Filter::ALL {
            assert_eq!(*table(filter), quantiles(filter), "{filter}");
        }
    }

    #[test]
    fn a_filter_is_as_broad_as_its_deviation() {
        let breadths = FILTERS.map(|filter| Antialiasing::new(8, filter, 0, 64).breadth);
        // The square root of 12 times the standard deviation: 0.375 for the Gaussian, 0.4155 for the other. Within the last steps of the
        // table samples are spread evenly, which is a little more.
        for (found, expected) in breadths.into_iter().zip([1.0, 1.299, 1.439]) {
            assert!((0.999..1.05).contains(&(found / expected)), "{breadths:?}");
        }
    }

    #[test]
    fn many_rays_are_the_same_as_single_ones() {
        let camera = Camera::look_at(Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO, Vec3::Y, 40.0).unwrap();
        for projection in [camera.projection, Projection::Orthographic { height: 3.0 }] {
            let view = View::new(&camera.clone().with_projection(projection), [7, 5]);
            let view = view.with_window(Window { size: [4, 3], first: [2, 1], whole: [7, 5] });
            for (filter, numbers) in [(Filter::BlackmanHarris, 0..8), (Filter::Box, 0..3), (Filter::Gauss, 8..27)] {
                let samples = Antialiasing::new(32, filter, 5, 64);
                let mut rays = Vec::new();
                samples.rays(Level::new(), &view, 1..12, numbers.clone(), &mut rays);
                let single = (1..12).flat_map(|pixel| numbers.clone().map(move |sample| (pixel, sample)));
                let single: Vec<Ray> = single.map(|(pixel, sample)| samples.ray(&view, pixel, sample)).collect();
                let bits = |rays: &[Ray]| -> Vec<_> {
                    rays.iter().map(|ray| [ray.origin, ray.direction].map(|v| v.to_array().map(f32::to_bits))).collect()
                };
                assert_eq!(bits(&rays), bits(&single), "{filter:?}");
            }
        }
    }

    #[test]
    fn any_pixel_has_its_own_samples_around_its_centre() {
        for filter in FILTERS {
            let samples = Antialiasing::new(64, filter, 3, 64);
            let of = |pixel: u32| (0..64).map(|sample| samples.aside(pixel, sample)).collect::<Vec<_>>();
            assert_ne!(of(1), of(2));
            for axis in 0..2 {
                let mean = of(7).iter().map(|aside| aside[axis]).sum::<f32>() / 64.0;
                assert!(mean.abs() < 0.01, "{filter:?}: {mean}");
            }
            let other = Antialiasing::new(64, filter, 4, 64);
            assert_ne!(samples.aside(1, 0), other.aside(1, 0), "another seed");
        }
    }
}
