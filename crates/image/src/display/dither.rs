//! Dithering: rounding up or down by a pattern, so that smooth gradients have no bands.
//!
//! The pattern is the additive recurrence R2 of Martin Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences* (2018), section
//! "Dithering": multiples of the two powers of the plastic number, folded to a triangle wave. Its spectrum is nearly that of blue noise, it
//! needs no table, and it depends on nothing but the pixel's position. All channels use the same threshold, so that greys stay grey.

/// The inverse of the plastic number and of its square, as fractions of 2³².
const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];
/// Thresholds are odd multiples of half of this, so that none is closer than 1/512 to a whole code: what is one stays as it is.
const LEVELS: f32 = 256.0;

/// What is added to the value of pixel (x, y), in codes, before it is rounded down; between 0 and 1.
#[inline]
pub(super) fn threshold(x: u32, y: u32) -> f32 {
    let wave = x.wrapping_mul(STEPS[0]).wrapping_add(y.wrapping_mul(STEPS[1]));
    let folded = if wave < 1 << 31 { wave } else { !wave };
    ((folded >> 23) as f32 + 0.5) / LEVELS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_are_spread_evenly() {
        let thresholds: Vec<f32> = (0..64 * 64).map(|pixel| threshold(pixel % 64, pixel / 64)).collect();
        for tenth in 0..10 {
            let from = tenth as f32 / 10.0;
            let count = thresholds.iter().filter(|&&value| value >= from && value < from + 0.1).count();
            assert!((380..440).contains(&count), "{count} of 4096 thresholds from {from}");
        }
        assert!(thresholds.iter().all(|value| (0.5 / LEVELS..=1.0 - 0.5 / LEVELS).contains(value)));
    }

    #[test]
    fn neighbours_differ() {
        // In every square of 4 x 4 pixels the mean is near one half, which is what makes it blue.
        for y in 0..60 {
            for x in 0..60 {
                let sum: f32 = (0..16).map(|pixel| threshold(x + pixel % 4, y + pixel / 4)).sum();
                assert!((sum / 16.0 - 0.5).abs() < 0.1, "({x}, {y}): {sum}");
            }
        }
    }
}
