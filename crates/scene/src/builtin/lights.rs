//! The lights of a built-in scene, for any requested number.

use glam::Vec3;

use super::math::around;
use crate::Light;

/// A light as its scene designs it: the first is the key light, the others fill.
pub(super) struct Lamp {
    pub(super) position: Vec3,
    /// Share of the total intensity of all lamps.
    pub(super) share: f32,
    /// Colour; 1 for the brightest channel.
    pub(super) tint: Vec3,
}

/// The golden angle in turns: directions at its multiples never cluster.
const GOLDEN_TURN: f32 = 0.381_966;

/// Share of the total for a light beyond the designed ones, before all shares are scaled to 1.
const FURTHER_SHARE: f32 = 0.2;

/// The first `count` of `lamps` as point lights; if there are fewer, further ones are placed on a circle through the key light
/// around the vertical axis through `center`. Intensities always sum to `total`.
pub(super) fn place(lamps: &[Lamp], center: Vec3, total: f32, count: usize, spread: f32) -> Vec<Light> {
    let key = &lamps[0];
    let arm = key.position - center;
    let further = (1..).map(|index| {
        let turn = around(GOLDEN_TURN * index as f32);
        let arm = Vec3::new(arm.x * turn.x - arm.z * turn.y, arm.y, arm.x * turn.y + arm.z * turn.x);
        Lamp { position: center + arm, share: FURTHER_SHARE, tint: Vec3::ONE }
    });
    let designed = lamps.iter().map(|lamp| Lamp { ..*lamp });
    let lamps: Vec<Lamp> = designed.chain(further).take(count).collect();
    let sum: f32 = lamps.iter().map(|lamp| lamp.share).sum();
    let light = |(index, lamp): (usize, &Lamp)| {
        let intensity = lamp.tint * (total * lamp.share / sum);
        Light::point(lamp.position).with_spread(spread).with_intensity(intensity).named(format!("light {}", index + 1))
    };
    lamps.iter().enumerate().map(light).collect()
}
