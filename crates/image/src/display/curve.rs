//! Functions of one positive number, interpolated in a table.
//!
//! A power or logarithm for each value of an image would take longer than everything else. Each power of two of the range is divided in 256
//! parts, and values between are interpolated linearly; for powers with exponents from 1/2.4 to 2.4 the error is below 10⁻⁵ of the value.

/// Bits of a float below those that number its part.
const FRACTION: u32 = 15;

/// A function in a table.
pub struct Curve {
    low: f32,
    high: f32,
    values: Vec<f32>,
}

impl Curve {
    /// `function` from `low` to `high`, which are positive powers of two.
    pub fn new(low: f32, high: f32, function: impl Fn(f64) -> f64) -> Curve {
        let value = |bits: u32| function(f64::from(f32::from_bits(bits))) as f32;
        let mut values: Vec<f32> = (low.to_bits()..=high.to_bits()).step_by(1 << FRACTION).map(value).collect();
        // The last value has a neighbour, too.
        values.push(values[values.len() - 1]);
        Curve { low, high, values }
    }

    /// The function at `x`, or at the nearest end of its range. NaN counts as its lower end.
    #[inline]
    pub fn at(&self, x: f32) -> f32 {
        let bits = x.max(self.low).min(self.high).to_bits() - self.low.to_bits();
        let part = (bits >> FRACTION) as usize;
        let (from, to) = (self.values[part], self.values[part + 1]);
        let fraction = (bits & ((1 << FRACTION) - 1)) as f32 / (1 << FRACTION) as f32;
        from + (to - from) * fraction
    }
}
