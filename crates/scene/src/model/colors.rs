//! Colours: linear ones, and as files encode them.

use glam::Vec3;

/// Decodes an sRGB colour to linear, each channel in [0, 1] (IEC 61966-2-1). Values outside are clamped, and NaN counts as 0.
pub fn linear(encoded: Vec3) -> Vec3 {
    let channel = |value: f32| {
        // In this order NaN becomes 0.
        #[allow(clippy::manual_clamp, reason = "`clamp` would keep NaN")]
        let value = value.max(0.0).min(1.0);
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    };
    Vec3::from_array(encoded.to_array().map(channel))
}

/// The luminance of a colour in linear sRGB.
pub fn luminance(color: Vec3) -> f32 {
    color.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}
