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
pub fn neutral(color: [f32; 3]) -> [f32; 3] {
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
