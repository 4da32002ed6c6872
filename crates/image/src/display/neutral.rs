//! The view *neutral*: Khronos PBR Neutral tone mapping.
//!
//! After the specification by the Khronos Group, *Khronos PBR Neutral Tone Mapper*, version 1.0 (2024), section "Tone mapping operator". A
//! colour whose largest channel is below 0.8 less the offset only loses what a surface's Fresnel reflection of 4 % added; a brighter one is
//! compressed towards white without a change of hue.

/// Reflectance at normal incidence of common materials, which is what is taken from a colour.
const F90: f32 = 0.04;
/// Largest channel at which compression begins.
const START: f32 = 0.8 - F90;
/// How fast bright colours lose their saturation.
const DESATURATION: f32 = 0.15;

/// What a linear colour is shown as; its channels are not negative.
pub(super) fn neutral(color: [f32; 3]) -> [f32; 3] {
    let least = color[0].min(color[1]).min(color[2]);
    // Below twice the reflectance the offset tends to the colour itself, so that black stays black.
    let offset = if least < 2.0 * F90 { least - least * least / (4.0 * F90) } else { F90 };
    let color = color.map(|channel| channel - offset);
    let peak = color[0].max(color[1]).max(color[2]);
    if peak < START {
        return color;
    }
    let range = 1.0 - START;
    let shown = 1.0 - range * range / (peak + range - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - shown) + 1.0);
    color.map(|channel| {
        let compressed = channel * (shown / peak);
        compressed + (shown - compressed) * white
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_near(color: [f32; 3], expected: [f32; 3]) -> bool {
        color.into_iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-6)
    }

    #[test]
    fn known_values() {
        // Below compression: minus 0.04, or minus x - 6.25 x² where the least channel is below 0.08.
        assert!(is_near(neutral([0.5, 0.3, 0.1]), [0.46, 0.26, 0.06]));
        assert!(is_near(neutral([0.5, 0.3, 0.04]), [0.47, 0.27, 0.01]));
        assert_eq!(neutral([0.0, 0.3, 0.7]), [0.0, 0.3, 0.7]);
        assert_eq!(neutral([0.0; 3]), [0.0; 3]);
        // Grey of 1: 0.96, of which 0.76 is kept and the rest compressed to 1 - 0.24² / (0.96 + 0.24 - 0.76).
        assert!(is_near(neutral([1.0; 3]), [1.0 - 0.0576 / 0.44; 3]));
        // Red of 2: the peak 2 becomes 1 - 0.0576 / 1.48, and the other channels that much of 1 - 1 / (0.15 * (2 - peak) + 1).
        let peak = 1.0 - 0.0576 / 1.48;
        assert!(is_near(neutral([2.0, 0.0, 0.0]), [peak, peak * 0.134_826_7, peak * 0.134_826_7]));
    }

    #[test]
    fn compression_begins_smoothly() {
        let [below, above] = [0.799_999, 0.800_001].map(|grey| neutral([grey; 3])[0]);
        assert!(above > below && above - below < 3e-6, "{below} {above}");
    }
}
