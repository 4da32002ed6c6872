//! Dithering: rounding up or down by a pattern, so that smooth gradients have no bands.
//!
//! The pattern is the additive recurrence R2 of Martin Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences* (2018), section
//! "Dithering": multiples of the two powers of the plastic number, folded to a triangle wave. Its spectrum is nearly that of blue noise, it
//! needs no table, and it depends on nothing but the pixel's position. All channels use the same threshold, so that greys stay grey.

/// The inverse of the plastic number and of its square, as fractions of 2³².
const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];
/// Thresholds are odd multiples of half of this, so that none is closer than 1/512 to a whole code: what is one stays as it is.
pub const LEVELS: f32 = 256.0;

/// What is added to the value of pixel (x, y), in codes, before it is rounded down; between 0 and 1.
#[inline]
pub fn threshold(x: u32, y: u32) -> f32 {
    let wave = x.wrapping_mul(STEPS[0]).wrapping_add(y.wrapping_mul(STEPS[1]));
    let folded = if wave < 1 << 31 { wave } else { !wave };
    ((folded >> 23) as f32 + 0.5) / LEVELS
}
