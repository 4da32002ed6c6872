//! Exposure: how much brighter or darker an image is displayed than computed, in stops. One stop doubles the brightness.
//!
//! [`Frame::auto_exposure`] brings the logarithmic mean of the luminance to 18 % grey (Reinhard et al., *Photographic Tone
//! Reproduction for Digital Images*, SIGGRAPH 2002, key 0.18), limited so that at most a twentieth of the image is brighter than
//! white.

use crate::Frame;

/// Target luminance of the logarithmic mean.
const MIDDLE_GREY: f32 = 0.18;
/// Share of the lit pixels that must not be brighter than white.
const BELOW_WHITE: f64 = 0.95;
/// What the largest channel of the pixel shows of which only a hundredth of the image is brighter: white paper, not white.
const BRIGHT: f32 = 0.85;
const BELOW_BRIGHT: f64 = 0.99;
/// By how many stops an image is brightened at most for this: what is dark should be so.
const MAX_BRIGHTENED: f32 = 0.5;
/// Steps per stop, so that the result can be typed.
const STEPS_A_STOP: f32 = 100.0;

impl Frame {
    /// Multiplies all colours by 2^`stops`.
    pub fn expose(&mut self, stops: f32) {
        let factor = stops.exp2();
        self.color_mut().as_flattened_mut().iter_mut().for_each(|value| *value *= factor);
    }

    /// Exposure that brings the image into the range of a screen, in steps of a hundredth of a stop; 0 if nothing is lit. Black does not count;
    /// so of a frame with alpha, neither do pixels without cover, nor the shadows that a shadow catcher shows.
    pub fn auto_exposure(&self) -> f32 {
        let mut lit: Vec<f32> =
            self.color().iter().map(luminance).filter(|&value| value > 0.0 && value.is_finite()).collect();
        if lit.is_empty() {
            return 0.0;
        }
        let mean = lit.iter().map(|&value| f64::from(value).log2()).sum::<f64>() / lit.len() as f64;
        let place = ((lit.len() - 1) as f64 * BELOW_WHITE) as usize;
        let (_, &mut bright, _) = lit.select_nth_unstable_by(place, f32::total_cmp);
        let stops = (MIDDLE_GREY.log2() - mean as f32).min(-bright.log2());
        (stops * STEPS_A_STOP).round() / STEPS_A_STOP
    }
}

impl Frame {
    /// Exposure of an image whose light has about the range of a screen: the brightest that clips hardly anything, at most half a stop; in steps of a
    /// hundredth of a stop. Only a hundredth of the image is then brighter than 0.85.
    pub fn highlight_exposure(&self) -> f32 {
        let largest = |&[r, g, b]: &[f32; 3]| r.max(g).max(b);
        let mut largest: Vec<f32> = self.color().iter().map(largest).filter(|value| value.is_finite()).collect();
        if largest.is_empty() {
            return 0.0;
        }
        let place = ((largest.len() - 1) as f64 * BELOW_BRIGHT) as usize;
        let (_, &mut bright, _) = largest.select_nth_unstable_by(place, f32::total_cmp);
        let stops = (BRIGHT / bright.max(f32::MIN_POSITIVE)).log2();
        (stops.min(MAX_BRIGHTENED) * STEPS_A_STOP).round() / STEPS_A_STOP
    }
}

/// Luminance of a colour with Rec. 709 primaries.
fn luminance([r, g, b]: &[f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
