//! Functions of one positive number, interpolated in a table.
//!
//! A power or logarithm for each value of an image would take longer than everything else. Each power of two of the range is divided in 256
//! parts, and values between are interpolated linearly; for powers with exponents from 1/2.4 to 2.4 the error is below 10⁻⁵ of the value.

/// Bits of a float below those that number its part.
const FRACTION: u32 = 15;

/// A function in a table.
pub(crate) struct Curve {
    low: f32,
    high: f32,
    values: Vec<f32>,
}

impl Curve {
    /// `function` from `low` to `high`, which are positive powers of two.
    pub(crate) fn new(low: f32, high: f32, function: impl Fn(f64) -> f64) -> Curve {
        let value = |bits: u32| function(f64::from(f32::from_bits(bits))) as f32;
        let mut values: Vec<f32> = (low.to_bits()..=high.to_bits()).step_by(1 << FRACTION).map(value).collect();
        // The last value has a neighbour, too.
        values.push(values[values.len() - 1]);
        Curve { low, high, values }
    }

    /// The function at `x`, or at the nearest end of its range. NaN counts as its lower end.
    #[inline]
    pub(crate) fn at(&self, x: f32) -> f32 {
        let bits = x.max(self.low).min(self.high).to_bits() - self.low.to_bits();
        let part = (bits >> FRACTION) as usize;
        let (from, to) = (self.values[part], self.values[part + 1]);
        let fraction = (bits & ((1 << FRACTION) - 1)) as f32 / (1 << FRACTION) as f32;
        from + (to - from) * fraction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_close() {
        for exponent in [1.0 / 2.4, 1.0, 2.4] {
            let curve = Curve::new(1.0 / 512.0, 4.0, |x| x.powf(exponent));
            for step in 0..=100_000 {
                let x = 1.0 / 512.0 * 2048.0_f32.powf(step as f32 / 100_000.0);
                let exact = f64::from(x.min(4.0)).powf(exponent);
                assert!((f64::from(curve.at(x)) / exact - 1.0).abs() < 1e-5, "{x}^{exponent}");
            }
        }
    }

    #[test]
    fn outside_are_the_ends() {
        let curve = Curve::new(0.5, 2.0, |x| 10.0 * x);
        assert_eq!([0.5, 1.0, 1.75, 2.0].map(|x| curve.at(x)), [5.0, 10.0, 17.5, 20.0]);
        assert_eq!([f32::NAN, f32::NEG_INFINITY, -1.0, 0.0].map(|x| curve.at(x)), [5.0; 4]);
        assert_eq!([2.1, f32::MAX, f32::INFINITY].map(|x| curve.at(x)), [20.0; 3]);
    }
}
