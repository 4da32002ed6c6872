//! What rays see that leave the scene. Twin: `environment.cuh`.
//!
//! 1. The direction becomes a place in the panorama. Devices round arc tangents differently, so that one polynomial serves all.
//! 2. A cone that is no wider than a texel is magnified: the four nearest texels are interpolated. Wider ones take the mean of the two levels
//!    whose texels are just smaller and just larger.
//! 3. The sun is a disc with an edge as wide as the cone, and as much light.

use glam::{Vec2, Vec3};
use lightmesh_layout::constants::{
    ARC_TANGENT_3, ARC_TANGENT_5, ARC_TANGENT_7, ARC_TANGENT_9, EIGHTH_OF_TURN, TANGENT_OF_EIGHTH, TURN_OF_RADIAN,
};
use lightmesh_scene::{Environment, Lights, Wrap};

use crate::data::wave::HostWave;
use crate::textures::{between, bilinear, level_of};

/// What ray number `ray`, which hits nothing, sees: the background or the environment.
#[inline(always)]
pub(crate) fn missed(wave: &HostWave, ray: usize) -> Vec3 {
    let lights = wave.lights();
    match (&lights.environment, lights.background) {
        (Some(environment), background) if background.is_none() || wave.rays.is_mirrored(ray) => {
            radiance(environment, wave.rays.rays[ray].direction, wave.rays.spread_of(ray))
        }
        (_, background) => background.unwrap_or(Vec3::ZERO),
    }
}

/// What surfaces receive from outside of the scene along a direction, but for lights.
pub(crate) fn surroundings(lights: &Lights, direction: Vec3, spread: f32) -> Vec3 {
    lights.environment.as_ref().map_or(Vec3::ZERO, |environment| without_sun(environment, direction, spread))
}

/// The mean radiance that a cone of this angle around `direction` sees.
pub(crate) fn radiance(environment: &Environment, direction: Vec3, spread: f32) -> Vec3 {
    let seen = without_sun(environment, direction, spread);
    // 3. The sun.
    let Some(sun) = environment.sun() else { return seen };
    let inside = sun.radius - (direction - sun.direction).length();
    let share = if spread > 0.0 { (inside / spread + 0.5).clamp(0.0, 1.0) } else { f32::from(inside >= 0.0) };
    if share > 0.0 { between(seen, sun.radiance, share * faded(sun.radius, spread)) } else { seen }
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

/// The angle of the point (x, y), counted from the x axis, as a share of a whole turn, from −0.5 to 0.5; 0 for the origin.
#[inline(always)]
fn turns(y: f32, x: f32) -> f32 {
    let (along, aside) = (x.abs(), y.abs());
    let (low, high) = if aside > along { (along, aside) } else { (aside, along) };
    let ratio = if high > 0.0 { low / high } else { 0.0 };
    let (first, tangent) =
        if ratio > TANGENT_OF_EIGHTH { (EIGHTH_OF_TURN, (ratio - 1.0) / (ratio + 1.0)) } else { (0.0, ratio) };
    let square = tangent * tangent;
    let sum = ((ARC_TANGENT_9 * square + ARC_TANGENT_7) * square + ARC_TANGENT_5) * square + ARC_TANGENT_3;
    let eighth = first + TURN_OF_RADIAN * (tangent + tangent * (square * sum));
    let quarter = if aside > along { 0.25 - eighth } else { eighth };
    let half = if x < 0.0 { 0.5 - quarter } else { quarter };
    if y < 0.0 { -half } else { half }
}

#[cfg(test)]
mod tests {
    use lightmesh_scene::{Sun, Up};

    use super::*;

    #[test]
    fn turns_are_arc_tangents() {
        let mut worst = 0.0f64;
        for step in 0..10_000 {
            let angle = f64::from(step - 5000) * std::f64::consts::TAU / 10_001.0;
            let (sin, cos) = angle.sin_cos();
            let (y, x) = ((7.0 * sin) as f32, (7.0 * cos) as f32);
            let expected = f64::from(y).atan2(f64::from(x)) / std::f64::consts::TAU;
            worst = worst.max((f64::from(turns(y, x)) - expected).abs());
        }
        assert!(worst < 1e-7, "{worst}");
        assert_eq!([turns(0.0, 0.0), turns(0.0, 1.0), turns(1.0, 0.0), turns(-1.0, 0.0)], [0.0, 0.0, 0.25, -0.25]);
        assert_eq!(turns(0.0, -1.0), 0.5);
    }

    fn panorama(size: [u32; 2]) -> Environment {
        let texels = (0..size[0] * size[1]).map(|index| [index as f32, (index % size[0]) as f32, 1.0]).collect();
        Environment::new("", size, texels, Up::Z).turned(40.0)
    }

    #[test]
    fn middles_of_texels_are_seen_as_they_are() {
        let map = panorama([16, 8]);
        for (column, row) in (0..8).flat_map(|row| (0..16).map(move |column| (column, row))) {
            let found = radiance(&map, map.direction(column, row), 0.0);
            let expected = Vec3::new((row * 16 + column) as f32, column as f32, 1.0);
            assert!((found - expected).length() < 1e-3, "{column}, {row}: {found}");
        }
        let poles = [Vec3::Z, Vec3::NEG_Z].map(|pole| radiance(&map, pole, 0.0));
        assert!(poles.iter().all(|seen| seen.is_finite() && seen.z == 1.0));
        assert!(
            (radiance(&map, map.direction(15, 3), 0.0) - radiance(&map, -map.direction(15, 3), 0.0)).length() > 1.0
        );
    }

    #[test]
    fn wide_cones_see_means() {
        let map = panorama([16, 8]);
        let last = Vec3::from_array(map.levels().last().unwrap().texels[0]);
        for spread in [7.0, 1e9, f32::INFINITY] {
            assert_eq!(radiance(&map, Vec3::X, spread), last, "{spread}");
        }
        let two = map.levels()[0].texels[3 * 8 + 2];
        let between = map.direction(4, 6) + map.direction(5, 6) + map.direction(4, 7) + map.direction(5, 7);
        let texel = std::f32::consts::PI / 8.0;
        let found = radiance(&map, between.normalize(), 2.0 * texel);
        assert!((found - Vec3::from_array(two)).length() < 0.2, "{found}, not {two:?}");
    }

    #[test]
    fn the_sun_is_a_disc_with_an_edge() {
        let black = Environment::new("", [1; 2], vec![[0.0; 3]], Up::Y);
        let sun = Sun::new(Vec3::X, 10.0, Vec3::ONE);
        let map = black.with_sun(Some(sun));
        let at = |degrees: f32, spread: f32| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            radiance(&map, Vec3::new(cos, sin, 0.0), spread).x / sun.radiance.x
        };
        assert_eq!([at(0.0, 0.0), at(4.9, 0.0), at(5.1, 0.0), at(180.0, 0.0)], [1.0, 1.0, 0.0, 0.0]);
        assert!((at(5.0, 0.01) - 0.5).abs() < 0.05 && at(4.6, 0.01) > 0.99 && at(5.4, 0.01) == 0.0);
        // Wide cones see as much light.
        let all = |spread: f32| (0..1800).map(|step| (step as f32 + 0.5) * at(0.05 * step as f32, spread)).sum::<f32>();
        assert!((all(1.0) / all(0.0) - 1.0).abs() < 0.1, "{} of {}", all(1.0), all(0.0));
    }
}
