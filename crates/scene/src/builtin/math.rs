//! Arithmetic that gives the same bits on every machine: a random number generator, angles and colours.
//!
//! Only IEEE 754 basic operations and square roots are used, because the library functions of platforms (`sin`, `powf`) differ
//! in the last bits, and a generated scene must not.

use glam::{Vec2, Vec3};

/// SplitMix64 (Steele, Lea and Flood 2014): small, fast, good enough to scatter leaves.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
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
    pub(super) fn unit(&mut self) -> f32 {
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
    pub(super) fn direction(&mut self) -> Vec3 {
        let y = self.within(-1.0, 1.0);
        let circle = around(self.unit()) * (1.0 - y * y).sqrt();
        Vec3::new(circle.x, y, circle.y)
    }

    /// Uniform in the unit disk.
    pub(super) fn disk(&mut self) -> Vec2 {
        let radius = self.unit().sqrt();
        around(self.unit()) * radius
    }
}

/// The point (cos, sin) of the unit circle at `turns` full turns, by Taylor series: exact to single precision.
pub(super) fn around(turns: f32) -> Vec2 {
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
pub(super) fn srgb(hex: u32) -> Vec3 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_circle_agrees_with_the_library() {
        for step in -40..40 {
            let turns = step as f32 / 16.0 + 0.01;
            let (sin, cos) = (f64::from(turns) * std::f64::consts::TAU).sin_cos();
            let point = around(turns);
            assert!((f64::from(point.x) - cos).abs() < 1e-6 && (f64::from(point.y) - sin).abs() < 1e-6, "{turns}");
        }
    }

    #[test]
    fn random_numbers_fill_the_interval() {
        let mut random = Random::new(1);
        let values: Vec<f32> = (0..1000).map(|_| random.unit()).collect();
        let mean = values.iter().sum::<f32>() / 1000.0;
        assert!(values.iter().all(|value| (0.0..1.0).contains(value)) && (mean - 0.5).abs() < 0.03);
    }

    #[test]
    fn directions_are_unit_vectors_and_disks_are_round() {
        let mut random = Random::new(2);
        assert!((0..100).all(|_| (random.direction().length() - 1.0).abs() < 1e-5));
        assert!((0..100).all(|_| random.disk().length() < 1.0 + 1e-6));
    }

    #[test]
    fn colours_follow_the_srgb_curve() {
        let mid = srgb(0x808080).x;
        assert!((mid - 0.2159).abs() < 0.003, "{mid}");
        assert!((srgb(0xff0000) - Vec3::X).length() < 1e-4);
    }
}
