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
use lightmesh_layout::constants::{FILTER_PLACES, FILTER_STEPS, MARGIN_ROWS, MAX_SHARED, PIXEL_PATTERN};
use lightmesh_trace::accel::Ray;
use lightmesh_trace::simd::{LANES, dispatch};

use crate::sampling::Pattern;
use crate::settings::Filter;
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
    /// Selects the random patterns.
    pub seed: u64,
    /// Places of samples, by the share of the filter before them.
    pub quantiles: [f32; FILTER_PLACES as usize],
    /// The width in pixels of a square over which evenly spread samples vary as much as over the filter.
    pub breadth: f32,
}

impl Antialiasing {
    /// `samples` samples of each pixel, distributed by `filter`; `seed` selects their pattern. Lights have `light_samples` samples.
    pub fn new(samples: u32, filter: Filter, seed: u64, light_samples: u32) -> Antialiasing {
        let noise = (FULL_SAMPLES / light_samples.max(1) as f32).sqrt().max(1.0);
        Antialiasing {
            samples,
            apart: samples > MAX_SHARED,
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
    pub fn aside(&self, number: u32, sample: u32) -> [f32; 2] {
        self.within(&self.pattern(number), sample)
    }

    /// The pattern of the samples of pixel number `number` of the image.
    #[inline(always)]
    pub(crate) fn pattern(&self, number: u32) -> Pattern {
        Pattern::new(self.seed, u64::from(number), PIXEL_PATTERN as usize)
    }

    /// The ray through sample number `sample` of a pixel of a view.
    #[inline(always)]
    pub fn ray(&self, view: &View, pixel: u32, sample: u32) -> Ray {
        view.ray_beside(pixel, self.aside(view.window().number(pixel), sample))
    }

    /// The rays through samples `numbers` of the pixels `pixels` of a view, pixel by pixel: the same bits as [`Antialiasing::ray`].
    pub fn rays(&self, level: Level, view: &View, pixels: Range<u32>, numbers: Range<u32>, rays: &mut Vec<Ray>) {
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
pub fn table(filter: Filter) -> &'static [f32; FILTER_PLACES as usize] {
    static TABLES: [OnceLock<[f32; FILTER_PLACES as usize]>; 3] = [const { OnceLock::new() }; 3];
    let number = Filter::ALL.iter().position(|&other| other == filter).unwrap_or_default();
    TABLES[number].get_or_init(|| quantiles(filter))
}

/// The offsets below which each 1/63 of a filter lies.
pub fn quantiles(filter: Filter) -> [f32; FILTER_PLACES as usize] {
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
pub fn weight(filter: Filter, offset: f64) -> f64 {
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
