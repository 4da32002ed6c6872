//! LDR-FLIP: how much of a difference a viewer sees at each pixel who flips between two images.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild: *FLIP: A Difference Evaluator for Alternating
//! Images*, HPG 2020, with its constants. All filters are separable, one of them as a sum of two. Steps:
//!
//! 1. **Opponent colours** of each image: luminance, red-green, blue-yellow.
//! 2. **Contrast sensitivity**: sums of Gaussians blur each of them as the eye does at a distance.
//! 3. **Colour difference** of the blurred images: HyAB in L\*a\*b\* after the Hunt effect, mapped to [0, 1].
//! 4. **Feature difference**: of edges and points, which are first and second derivatives of luminance.
//! 5. **Error**: the colour difference to the power of one minus the feature difference.
//!
//! Pixels beyond the border are like the nearest ones at the border. Errors do not depend on the number of threads. They agree with the
//! authors' C++ implementation to 1e-4 at each pixel. That takes its order of operations in single precision: where colours hardly differ,
//! roots and powers turn a difference in the last bit of white into 1e-3.

use std::f32::consts::{FRAC_1_SQRT_2, PI};
use std::ops::Range;

use rayon::prelude::*;

use crate::Transfer;

/// Pixels per degree of the field of view: about those of a screen 0.7 m wide with 3840 pixels at a distance of 0.7 m.
const PIXELS_PER_DEGREE: f32 = 67.0;

/// Contrast sensitivity: pairs (a, b) of weight and scale, of Gaussians `a √(π/b) exp(-π² x² / b)` at x degrees.
const LUMINANCE: (f32, f32) = (1.0, 0.0047);
const RED_GREEN: (f32, f32) = (1.0, 0.0053);
const BLUE_YELLOW: [(f32, f32); 2] = [(34.1, 0.04), (13.5, 0.025)];
/// Width of the feature detector in degrees.
const FEATURE_WIDTH: f32 = 0.082;
/// Gaussians end at so many standard deviations.
const DEVIATIONS: f32 = 3.0;

/// Exponent of colour differences.
const COLOR_EXPONENT: f32 = 0.7;
/// Colour differences up to this part of the maximum take the lower part of the range.
const USUAL_DIFFERENCE: f32 = 0.4;
/// How much of the range that is.
const USUAL_RANGE: f32 = 0.95;

/// Linear RGB to XYZ relative to white, by the primaries and D65 of IEC 61966-2-1: rows sum to 1.
const RGB_TO_XYZ: [[f64; 3]; 3] = {
    const WHITE: [f64; 3] = [23_359_437.0, 12_288_897.0, 80_288_307.0];
    [
        [10_135_552.0 / WHITE[0], 8_788_810.0 / WHITE[0], 4_435_075.0 / WHITE[0]],
        [2_613_072.0 / WHITE[1], 8_788_810.0 / WHITE[1], 887_015.0 / WHITE[1]],
        [1_425_312.0 / WHITE[2], 8_788_810.0 / WHITE[2], 70_074_185.0 / WHITE[2]],
    ]
};

/// The reverse.
const XYZ_TO_RGB: [[f64; 3]; 3] = inverse(RGB_TO_XYZ);

/// Rows that are computed together: those around them are blurred once more for it, and memory is taken for them alone.
const BAND: usize = 64;
/// Pixels whose sums are in registers at once.
const BLOCK: usize = 32;

/// The error of each pixel, in [0, 1]; rows of `width` sRGB codes.
pub fn flip(reference: &[[u8; 3]], test: &[[u8; 3]], width: usize) -> Vec<f32> {
    let linear: [f32; 256] = std::array::from_fn(|code| Transfer::Srgb.decode(code as u8));
    let decoded = |codes: &[[u8; 3]], pixel: usize| codes[pixel].map(|code| linear[usize::from(code)]);
    flip_of(|pixel| decoded(reference, pixel), |pixel| decoded(test, pixel), (width, reference.len() / width))
}

/// The same of images that are given by the linear colour of each pixel, from 0 to 1, and by width and height.
pub(super) fn flip_of(
    reference: impl Fn(usize) -> [f32; 3] + Sync,
    test: impl Fn(usize) -> [f32; 3] + Sync,
    (width, height): (usize, usize),
) -> Vec<f32> {
    let filters = Filters::new(PIXELS_PER_DEGREE);
    let color = ColorDifference::new();
    let mut errors = vec![0.0; width * height];
    errors.par_chunks_mut(BAND * width).enumerate().for_each(|(number, errors)| {
        let first = number * BAND;
        let rows = first..first + errors.len() / width;
        let reference = Across::new(&reference, (width, height), rows.clone(), &filters);
        let test = Across::new(&test, (width, height), rows.clone(), &filters);
        let mut seen = [Seen::new(width), Seen::new(width)];
        for (row, errors) in rows.zip(errors.chunks_exact_mut(width)) {
            reference.down(row, &filters, &mut seen[0]);
            test.down(row, &filters, &mut seen[1]);
            let [reference, test] = &seen;
            for (x, error) in errors.iter_mut().enumerate() {
                // 3. What colours differ by.
                let color = color.between(reference.lab(x), test.lab(x));
                // 4. What features differ by.
                let [edge, point] = [0, 1].map(|feature| {
                    let strength = |seen: &Seen| seen.across[feature][x].hypot(seen.along[feature][x]);
                    (strength(reference) - strength(test)).abs()
                });
                let feature = (edge.max(point) * FRAC_1_SQRT_2).sqrt();
                // 5. The error.
                *error = color.powf(1.0 - feature).min(1.0);
            }
        }
    });
    errors
}

/// Filters of one dimension, from the left or the top on; all have an odd length.
struct Filters {
    /// Of luminance, red-green, and the two parts of blue-yellow, which add up after filtering in both directions.
    contrast: [Vec<f32>; 4],
    /// Gaussian, and its first and second derivative.
    feature: [Vec<f32>; 3],
}

impl Filters {
    fn new(pixels_per_degree: f32) -> Filters {
        let all = [LUMINANCE, RED_GREEN, BLUE_YELLOW[0], BLUE_YELLOW[1]];
        let widest = all.iter().map(|&(_, scale)| scale).fold(0.0, f32::max);
        let radius = (DEVIATIONS * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        let gaussian = |factor: f32, scale: f32| {
            taps(radius, |x| {
                let degrees = x * (1.0 / pixels_per_degree);
                factor * (-(PI * PI) * (degrees * degrees) / scale).exp()
            })
        };
        let peak = |(weight, scale): (f32, f32)| weight * (PI / scale).sqrt();
        let [luminance, red_green] = [LUMINANCE, RED_GREEN].map(|part| {
            let taps = gaussian(peak(part), part.1);
            let by = 1.0 / sum(&taps);
            scaled(&taps, by)
        });
        // In two dimensions, each part has its weight: the factor in one direction is the root.
        let [wide, narrow] = BLUE_YELLOW.map(|part| gaussian(peak(part).sqrt(), part.1));
        let by = 1.0 / (sum(&wide) * sum(&wide) + sum(&narrow) * sum(&narrow)).sqrt();
        let contrast = [luminance, red_green, scaled(&wide, by), scaled(&narrow, by)];

        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let radius = (DEVIATIONS * deviation).ceil() as i32;
        let gauss = |x: f32| (-(x * x) / (2.0 * deviation * deviation)).exp();
        let gaussian = taps(radius, gauss);
        let total = sum(&gaussian);
        let gaussian = gaussian.iter().map(|tap| tap / total).collect();
        let first = taps(radius, |x| -x * gauss(x));
        let second = taps(radius, |x| (x * x / (deviation * deviation) - 1.0) * gauss(x));
        Filters { contrast, feature: [gaussian, balanced(&first), balanced(&second)] }
    }

    /// Pixels to each side that the longest filter takes in.
    fn reach(&self) -> usize {
        (self.contrast[0].len() / 2).max(self.feature[0].len() / 2)
    }
}

/// Values of a function at whole pixels to both sides.
fn taps(radius: i32, value: impl Fn(f32) -> f32) -> Vec<f32> {
    (-radius..=radius).map(|x| value(x as f32)).collect()
}

fn sum(taps: &[f32]) -> f32 {
    taps.iter().sum()
}

fn scaled(taps: &[f32], by: f32) -> Vec<f32> {
    taps.iter().map(|tap| tap * by).collect()
}

/// Positive ones are made to add up to 1, negative ones to -1.
fn balanced(taps: &[f32]) -> Vec<f32> {
    let [positive, negative] = [1.0, -1.0].map(|sign: f32| taps.iter().map(|tap| (sign * tap).max(0.0)).sum::<f32>());
    taps.iter().map(|&tap| tap / if tap > 0.0 { positive } else { negative }).collect()
}

/// Rows of an image after the filters along rows. Rows are longer than the image by up to a block, with anything at their end.
struct Across {
    /// The image's rows that there are.
    rows: Range<usize>,
    /// The last row of the image.
    last: usize,
    stride: usize,
    /// Luminance, red-green, and blue-yellow by both of its filters.
    contrast: [Vec<f32>; 4],
    /// Luminance by the Gaussian and its derivatives.
    feature: [Vec<f32>; 3],
}

impl Across {
    /// Of what `rows` need from the image.
    fn new(
        color: impl Fn(usize) -> [f32; 3],
        (width, height): (usize, usize),
        rows: Range<usize>,
        filters: &Filters,
    ) -> Across {
        let (reach, stride) = (filters.reach(), width.next_multiple_of(BLOCK));
        let rows = rows.start.saturating_sub(reach)..(rows.end + reach).min(height);
        let plane = || vec![0.0; rows.len() * stride];
        let mut contrast = [plane(), plane(), plane(), plane()];
        let mut feature = [plane(), plane(), plane()];
        let mut wide: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; stride + 2 * reach]);
        for (number, row) in rows.clone().enumerate() {
            // 1. Opponent colours; the borders go on.
            for x in 0..stride + 2 * reach {
                let [y, cx, cz] = opponent(color(row * width + x.saturating_sub(reach).min(width - 1)));
                let channels = [y, cx, cz, y * (1.0 / 116.0) + 16.0 / 116.0];
                wide.iter_mut().zip(channels).for_each(|(channel, value)| channel[x] = value);
            }
            // 2. and 4. Filters along the row.
            let filter = |taps: &[f32], channel: &[f32], plane: &mut Vec<f32>| {
                let start = reach - taps.len() / 2;
                weighted(taps, |tap| &channel[start + tap..], &mut plane[number * stride..][..stride]);
            };
            for ((taps, channel), plane) in filters.contrast.iter().zip([0, 1, 2, 2]).zip(&mut contrast) {
                filter(taps, &wide[channel], plane);
            }
            for (taps, plane) in filters.feature.iter().zip(&mut feature) {
                filter(taps, &wide[3], plane);
            }
        }
        Across { rows, last: height - 1, stride, contrast, feature }
    }

    /// A row after the filters along columns.
    fn down(&self, row: usize, filters: &Filters, seen: &mut Seen) {
        let filter = |taps: &[f32], plane: &[f32], out: &mut Vec<f32>| {
            let line = |tap: usize| {
                let row = (row + tap).saturating_sub(taps.len() / 2).min(self.last) - self.rows.start;
                &plane[row * self.stride..]
            };
            weighted(taps, line, out);
        };
        for ((taps, plane), out) in filters.contrast.iter().zip(&self.contrast).zip(&mut seen.contrast) {
            filter(taps, plane, out);
        }
        let [gaussian, first, second] = &filters.feature;
        let [blurred, slope, curvature] = &self.feature;
        filter(gaussian, slope, &mut seen.across[0]);
        filter(gaussian, curvature, &mut seen.across[1]);
        filter(first, blurred, &mut seen.along[0]);
        filter(second, blurred, &mut seen.along[1]);
    }
}

/// A row after all filters.
struct Seen {
    contrast: [Vec<f32>; 4],
    /// Edges and points by derivatives along rows.
    across: [Vec<f32>; 2],
    /// Those by derivatives along columns.
    along: [Vec<f32>; 2],
}

impl Seen {
    fn new(width: usize) -> Seen {
        let row = || vec![0.0; width.next_multiple_of(BLOCK)];
        Seen { contrast: [row(), row(), row(), row()], across: [row(), row()], along: [row(), row()] }
    }

    /// The colour as L\*a\*b\* after the Hunt effect: what is dark is less colourful.
    fn lab(&self, x: usize) -> [f32; 3] {
        let [luminance, red_green, wide, narrow] = [0, 1, 2, 3].map(|filter| self.contrast[filter][x]);
        let y = (luminance + 16.0) / 116.0;
        let xyz = [y + red_green / 500.0, y, y - (wide + narrow) / 200.0];
        hunt(multiplied(XYZ_TO_RGB, xyz).map(|channel| channel.clamp(0.0, 1.0)))
    }
}

/// Sums of values by weights, of which each has its line: `out[x] = Σ taps[i] · line(i)[x]`. Lines are at least as long as `out`.
#[inline(always)]
fn weighted<'a>(taps: &[f32], line: impl Fn(usize) -> &'a [f32], out: &mut [f32]) {
    for (number, out) in out.as_chunks_mut::<BLOCK>().0.iter_mut().enumerate() {
        let mut sums = [0.0; BLOCK];
        for (index, tap) in taps.iter().enumerate() {
            if let Some(values) = line(index)[number * BLOCK..].first_chunk::<BLOCK>() {
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += tap * value);
            }
        }
        *out = sums;
    }
}

/// YCxCz: L\*a\*b\* without its root.
fn opponent(linear: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = multiplied(RGB_TO_XYZ, linear);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Linear RGB as L\*a\*b\* after the Hunt effect.
fn hunt(linear: [f32; 3]) -> [f32; 3] {
    const KNEE: f32 = 6.0 / 29.0;
    let [x, y, z] = multiplied(RGB_TO_XYZ, linear)
        .map(|value| if value > KNEE * KNEE * KNEE { value.cbrt() } else { value / (3.0 * KNEE * KNEE) + 4.0 / 29.0 });
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// The difference of colours, in [0, 1].
struct ColorDifference {
    /// Between green and blue, the largest of all.
    most: f32,
}

impl ColorDifference {
    fn new() -> ColorDifference {
        ColorDifference { most: hyab(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0])).powf(COLOR_EXPONENT) }
    }

    fn between(&self, reference: [f32; 3], test: [f32; 3]) -> f32 {
        let (difference, usual) = (hyab(reference, test).powf(COLOR_EXPONENT), USUAL_DIFFERENCE * self.most);
        if difference < usual {
            difference / usual * USUAL_RANGE
        } else {
            USUAL_RANGE + (difference - usual) / (self.most - usual) * (1.0 - USUAL_RANGE)
        }
    }
}

/// The distance of colours: along the axis of lightness, and across.
fn hyab(one: [f32; 3], other: [f32; 3]) -> f32 {
    let [lightness, a, b] = [0, 1, 2].map(|axis| one[axis] - other[axis]);
    lightness.abs() + (a * a + b * b).sqrt()
}

fn multiplied(matrix: [[f64; 3]; 3], vector: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] as f32 * vector[0] + row[1] as f32 * vector[1] + row[2] as f32 * vector[2])
}

/// By cofactors.
const fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut result = [[0.0; 3]; 3];
    let mut row = 0;
    while row < 3 {
        let mut column = 0;
        while column < 3 {
            // Indices that go around need no signs.
            let (a, b, c, d) = ((column + 1) % 3, (column + 2) % 3, (row + 1) % 3, (row + 2) % 3);
            result[row][column] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
            column += 1;
        }
        row += 1;
    }
    let determinant = m[0][0] * result[0][0] + m[0][1] * result[1][0] + m[0][2] * result[2][0];
    let mut entry = 0;
    while entry < 9 {
        result[entry / 3][entry % 3] /= determinant;
        entry += 1;
    }
    result
}
