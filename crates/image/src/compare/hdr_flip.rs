//! HDR-FLIP: the largest [FLIP](super::flip) error of each pixel over all exposures in which something of the reference can be seen.
//!
//! P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Möller: *Visualizing Errors in Rendered High Dynamic Range Images*, Eurographics 2021 (short
//! papers), with its tone curve and its rule for exposures. Steps:
//!
//! 1. **Exposures**: from that at which the brightest pixel of the reference is 0.85 after the tone curve to that at which the median is, in steps
//!    of about one stop, at least two.
//! 2. **Tone curve** of both images at each of them: a fit to ACES (K. Narkowicz 2015).
//! 3. **FLIP** of the results; the largest error counts.
//!
//! Where the median of the reference is black, that of its pixels with light is taken; of a black reference there is one exposure, 0.

use super::flip::flip_of;

/// Factors of x², x and 1 in the numerator and in the denominator of the tone curve, for colours that the exposure has already brought into
/// its range.
const ABOVE: [f32; 3] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0];
const BELOW: [f32; 3] = [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];
/// What is bright after the tone curve.
const BRIGHT: f32 = 0.85;
/// Beyond, everything is white: squares are finite.
const WHITE: f32 = 1e6;

/// The exposures at which images are compared, in stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exposures {
    pub(super) first: f32,
    pub(super) last: f32,
    pub(super) count: usize,
}

impl Exposures {
    /// Those of a reference.
    pub(super) fn of(reference: &[[f32; 3]]) -> Exposures {
        let mut luminances: Vec<f32> = reference.iter().map(|&color| luminance(color)).collect();
        let brightest = luminances.iter().copied().fold(0.0, f32::max);
        if brightest <= 0.0 {
            return Exposures { first: 0.0, last: 0.0, count: 1 };
        }
        let mut median = middle(&mut luminances);
        if median <= 0.0 {
            luminances.retain(|&luminance| luminance > 0.0);
            median = middle(&mut luminances);
        }
        let bright = bright();
        let [first, last] = [brightest, median].map(|luminance| (bright / luminance).log2());
        Exposures { first, last, count: (last - first).ceil().max(2.0) as usize }
    }

    fn all(self) -> impl Iterator<Item = f32> {
        let step = if self.count > 1 { (self.last - self.first) / (self.count - 1) as f32 } else { 0.0 };
        (0..self.count).map(move |number| self.first + number as f32 * step)
    }
}

/// The error of each pixel, in [0, 1]; rows of `width` linear colours.
pub(super) fn hdr_flip(reference: &[[f32; 3]], test: &[[f32; 3]], width: usize, exposures: Exposures) -> Vec<f32> {
    let size = (width, reference.len() / width);
    let mut largest = vec![0.0_f32; reference.len()];
    for exposure in exposures.all() {
        let factor = exposure.exp2();
        let shown = |color: [f32; 3]| color.map(|value| tone(value * factor));
        let errors = flip_of(|pixel| shown(reference[pixel]), |pixel| shown(test[pixel]), size);
        largest.iter_mut().zip(errors).for_each(|(largest, error)| *largest = largest.max(error));
    }
    largest
}

fn tone(value: f32) -> f32 {
    let x = value.clamp(0.0, WHITE);
    let of = |[square, linear, constant]: [f32; 3]| (x * x) * square + x * linear + constant;
    (of(ABOVE) / of(BELOW)).clamp(0.0, 1.0)
}

/// What the tone curve makes [`BRIGHT`]: the larger root of a quadratic.
fn bright() -> f32 {
    let [a, b, c] = std::array::from_fn(|power| ABOVE[power] - BRIGHT * BELOW[power]);
    (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)
}

/// The upper median.
fn middle(values: &mut [f32]) -> f32 {
    let half = values.len() / 2;
    *values.select_nth_unstable_by(half, f32::total_cmp).1
}

/// ITU-R BT.709; what is below 0 or not finite counts as the nearest that can be shown.
fn luminance([r, g, b]: [f32; 3]) -> f32 {
    (0.2126 * r + 0.7152 * g + 0.0722 * b).clamp(0.0, f32::MAX)
}
