//! What rays see that leave the scene. Twin: `environment.cuh`.
//!
//! 1. The direction becomes a place in the panorama. Devices round arc tangents differently, so that one polynomial serves all.
//! 2. A cone that is no wider than a texel is magnified: the four nearest texels are interpolated. Wider ones take the mean of the two levels
//!    whose texels are just smaller and just larger.
//! 3. The sun is a disc with an edge as wide as the cone, and as much light.

use glam::{Vec2, Vec3};
use lightmesh_layout::constants::TURN_OF_RADIAN;
use lightmesh_scene::{Environment, Lights, Wrap};

use super::turns::turns;
use crate::data::wave::HostWave;
use crate::textures::{between, bilinear, level_of};

/// What ray number `ray`, which hits nothing, sees: the background or the environment.
#[inline(always)]
pub(crate) fn missed(wave: &HostWave, ray: usize) -> Vec3 {
    let lights = wave.lights();
    match (&lights.environment, lights.background) {
        (Some(environment), background) if background.is_none() || wave.rays.is_mirrored(ray) => {
            let shown = wave.rays.lights_share(ray);
            radiance(environment, wave.rays.rays[ray].direction, wave.rays.spread_of(ray), shown)
        }
        (_, background) => background.unwrap_or(Vec3::ZERO),
    }
}

/// What surfaces receive from outside of the scene along a direction, but for lights.
pub(crate) fn surroundings(lights: &Lights, direction: Vec3, spread: f32) -> Vec3 {
    lights.environment.as_ref().map_or(Vec3::ZERO, |environment| without_sun(environment.gathered(), direction, spread))
}

/// The mean radiance that a cone of this angle around `direction` sees, with a share `shown` of the sun.
pub fn radiance(environment: &Environment, direction: Vec3, spread: f32, shown: f32) -> Vec3 {
    let seen = without_sun(environment, direction, spread);
    // 3. The sun.
    let Some(sun) = environment.sun() else { return seen };
    let inside = sun.radius - (direction - sun.direction).length();
    let share = if spread > 0.0 { (inside / spread + 0.5).clamp(0.0, 1.0) } else { f32::from(inside >= 0.0) };
    if share > 0.0 { between(seen, shown * sun.radiance, share * faded(sun.radius, spread)) } else { seen }
}

/// How much fainter a disc is with an edge as wide as `spread`, so that it gives as much light: the edge is a frustum of a cone, or a cone.
#[inline(always)]
fn faded(radius: f32, spread: f32) -> f32 {
    let end = radius + 0.5 * spread;
    if spread <= 2.0 * radius {
        12.0 * radius * radius / (12.0 * radius * radius + spread * spread)
    } else {
        3.0 * radius * radius * spread / (end * end * end)
    }
}

/// The same without the sun, which is a light.
fn without_sun(environment: &Environment, direction: Vec3, spread: f32) -> Vec3 {
    // 1. Where?
    let [east, up, north] = environment.frame().map(|axis| axis.dot(direction));
    let across = (east * east + north * north).sqrt();
    let place = Vec2::new(0.5 + turns(east, north), 0.5 - 2.0 * turns(up, across));

    // 2. How much of it?
    let (image, lower) = (environment.size(), environment.levels());
    let at = |level: u32| match level.checked_sub(1).map(|index| &lower[index as usize]) {
        None => sampled(image, environment.texels(), place),
        Some(level) => sampled(level.size, &level.texels, place),
    };
    let width = spread * (2.0 * TURN_OF_RADIAN) * image[1] as f32;
    // Also if it is NaN.
    if width > 1.0 {
        let (level, share) = level_of(width, lower.len() as u32);
        let fine = at(level);
        if share > 0.0 { between(fine, at(level + 1), share) } else { fine }
    } else {
        at(0)
    }
}

fn sampled(size: [u32; 2], texels: &[[f32; 3]], place: Vec2) -> Vec3 {
    bilinear(size, [Wrap::Repeat, Wrap::Clamp], place, |index| Vec3::from_array(texels[index]))
}
