//! Colours as mesh formats keep them.

use glam::Vec3;

/// A linear colour of one that is encoded as sRGB, each channel in [0, 1] (IEC 61966-2-1). What lies beyond is cut off, and what is
/// no number counts as 0.
pub(super) fn linear(encoded: Vec3) -> Vec3 {
    let channel = |value: f32| {
        // In this order a value that is no number becomes 0.
        #[allow(clippy::manual_clamp, reason = "`clamp` would keep what is no number")]
        let value = value.max(0.0).min(1.0);
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    };
    Vec3::from_array(encoded.to_array().map(channel))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn middle_grey_is_a_fifth_of_the_light() {
        let grey = linear(Vec3::splat(0.5));
        assert!((grey - 0.214_041).abs().max_element() < 1e-6, "{grey}");
        assert_eq!(linear(Vec3::new(2.0, -1.0, f32::NAN)), Vec3::X);
    }
}
