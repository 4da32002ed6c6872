//! Arithmetic that gives the same bits on every machine: a random number generator, angles and colours.
//!
//! Only IEEE 754 basic operations and square roots are used, because the library functions of platforms (`sin`, `powf`) differ
//! in the last bits, and a generated scene must not.

use glam::{Vec2, Vec3};

/// SplitMix64 (Steele, Lea and Flood 2014): small, fast, good enough to scatter leaves.
pub struct Random(u64);

impl Random {
    /// The same numbers for the same seed.
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1 << 24) as f32
    }

    /// Uniform in [low, high).
    pub(super) fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// One of `choices`, which must not be empty.
    pub(super) fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.next() % choices.len() as u64) as usize]
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> Vec3 {
        let y = self.within(-1.0, 1.0);
        let circle = around(self.unit()) * (1.0 - y * y).sqrt();
        Vec3::new(circle.x, y, circle.y)
    }

    /// Uniform in the unit disk.
    pub fn disk(&mut self) -> Vec2 {
        let radius = self.unit().sqrt();
        around(self.unit()) * radius
    }
}

/// The point (cos, sin) of the unit circle at `turns` full turns, by Taylor series: exact to single precision.
pub fn around(turns: f32) -> Vec2 {
    let angle = f64::from(turns - turns.round()) * std::f64::consts::TAU;
    let (mut cos, mut sin, mut term) = (0.0, 0.0, 1.0);
    for power in 0..26_u32 {
        match power % 4 {
            0 => cos += term,
            1 => sin += term,
            2 => cos -= term,
            _ => sin -= term,
        }
        term *= angle / f64::from(power + 1);
    }
    Vec2::new(cos as f32, sin as f32)
}

/// Linear reflectance of an sRGB colour written as 0xRRGGBB, by a cubic that stays within 0.002 of the standard's curve.
pub fn srgb(hex: u32) -> Vec3 {
    let channel = |shift: u32| {
        let value = ((hex >> shift) & 0xff) as f32 / 255.0;
        value * (value * (value * 0.305_306 + 0.682_171) + 0.012_523)
    };
    Vec3::new(channel(16), channel(8), channel(0))
}

/// Smooth step: 0 up to `low`, 1 from `high`.
pub(super) fn ease(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
