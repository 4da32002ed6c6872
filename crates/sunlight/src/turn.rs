//! The angle of a point about the origin, by operations that give the same bits on all devices: only + − × ÷ and comparisons.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// tan(π/8).
const MIDDLE: f64 = 0.414_213_562_373_095_05;

/// 1/3, 1/5, … 1/23.
const ODD: [f64; 11] = {
    let mut all = [0.0; 11];
    let mut at = 0;
    while at < 11 {
        all[at] = 1.0 / (2 * at + 3) as f64;
        at += 1;
    }
    all
};

/// The angle from the x axis to (x, y), −π to π, within 2·10⁻¹¹ of the true one. Of (0, 0) it is 0. It is where Newton steps begin.
#[inline]
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    let (ax, ay) = (x.abs(), y.abs());
    let (low, high) = (ax.min(ay), ax.max(ay));
    if high == 0.0 {
        return 0.0;
    }
    // 1. The octant, and its half: |z| ≤ tan(π/8).
    let ratio = low / high;
    let (z, base) = if ratio > MIDDLE { ((ratio - 1.0) / (ratio + 1.0), FRAC_PI_4) } else { (ratio, 0.0) };
    // 2. The series of the arc tangent, whose terms fall by z² < .172: z − z³/3 + z⁵/5 − …
    let square = z * z;
    let sum = ODD.iter().rev().fold(0.0, |sum, odd| square * (odd - sum));
    let angle = base + z * (1.0 - sum);
    // 3. Back to the octant.
    let angle = if ay > ax { FRAC_PI_2 - angle } else { angle };
    let angle = if x < 0.0 { PI - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_library() {
        let mut worst: f64 = 0.0;
        for step in 0..100_000 {
            let angle = (f64::from(step) + 0.3) / 100_000.0 * std::f64::consts::TAU - PI;
            let radius = 10_f64.powi(step % 13 - 6);
            let (y, x) = (radius * angle.sin(), radius * angle.cos());
            worst = worst.max((atan2(y, x) - y.atan2(x)).abs());
        }
        assert!(worst < 2e-11, "{worst:e}");
        assert_eq!([atan2(0.0, 0.0), atan2(0.0, 2.0), atan2(2.0, 0.0)], [0.0, 0.0, FRAC_PI_2]);
        assert_eq!([atan2(0.0, -1.0), atan2(-3.0, 0.0)], [PI, -FRAC_PI_2]);
    }
}
