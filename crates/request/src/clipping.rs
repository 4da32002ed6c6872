//! Whether an image shows what is there: warnings for one that is mostly clipped or black.

use lightmesh_image::Display;
use lightmesh_render::Frame;

use crate::words::Words;

/// Every so many pixels are looked at.
const STRIDE: usize = 7;
/// Share of what is seen of the scene from which it is worth a warning.
const MANY: f64 = 0.2;
/// Half an 8-bit code of sRGB: what is darker is black.
const BLACK: f32 = 0.5 / 255.0 / 12.92;

fn is_white(color: &[f32; 3]) -> bool {
    color.iter().all(|channel| *channel >= 1.0)
}

fn is_black(color: &[f32; 3]) -> bool {
    color.iter().all(|channel| *channel < BLACK)
}

/// The warnings for an image that is shown by `display`, and what each is about; `has_ground` if the scene has a shadow catcher.
pub(crate) fn warnings(
    frame: &Frame,
    display: &Display,
    has_ground: bool,
    words: Words,
) -> Vec<(&'static str, String)> {
    let counts = &frame.stats.counts;
    let shown: Vec<[f32; 3]> = frame.color().iter().step_by(STRIDE).map(|color| display.show(*color)).collect();
    let seen = shown.len() as f64 * counts.hits as f64 / counts.pixels.max(1) as f64;
    if seen < 1.0 {
        return Vec::new();
    }
    // Of the pixels that look the same as the background, those that see nothing do not count.
    let background =
        display.show(if frame.image.alpha().is_some() { [0.0; 3] } else { frame.stats.settings.background });
    let share = |is: fn(&[f32; 3]) -> bool| {
        let count = shown.iter().filter(|color| is(color)).count() as f64;
        let missed = if is(&background) { shown.len() as f64 - seen } else { 0.0 };
        ((count - missed) / seen).min(1.0)
    };
    let (white, black) = (share(is_white), share(is_black));
    let mut warnings = Vec::new();
    if white > MANY {
        let text = format!(
            "{:.0} % of the visible scene is clipped to white: lower the exposure ({}, or a number of stops below {}), or compress \
             highlights ({})",
            100.0 * white,
            words.with("exposure", "auto"),
            display.exposure,
            words.with("view", "neutral")
        );
        warnings.push(("clipped", text));
    }
    // Shadows on a transparent ground are black, as they should be.
    let has_shadows = frame.image.alpha().is_some() && has_ground;
    if black > MANY && !has_shadows {
        let text = format!(
            "{:.0} % of the visible scene is black: add light ({}, {}), or raise the exposure ({}, or a number of stops above {})",
            100.0 * black,
            words.of("light"),
            words.of("ambient"),
            words.with("exposure", "auto"),
            display.exposure
        );
        warnings.push(("black", text));
    }
    warnings
}
