//! The sun of an image.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::levels;
use super::panorama::Environment;
use super::sun::{SUN_ANGLE, Sun};
use crate::model::colors::luminance;

/// How far from the brightest texel the sun of an image may reach, degrees: it is seen through haze, and blurred by lenses.
const HALO: f32 = 4.0;
/// A sun gives at least this share of the irradiance that faces it.
const MIN_SHARE: f32 = 0.1;
/// Around a sun, the image is this much darker, at least.
const CONTRAST: f32 = 10.0;

/// A texel near the brightest one.
struct Near {
    texel: usize,
    /// Degrees from there.
    angle: f32,
    direction: Vec3,
    /// Its solid angle, but for the width.
    band: f32,
}

impl Environment {
    /// Takes the sun out of the image, if there is one: what is far brighter than the image around it, within a few degrees, and gives a
    /// tenth of the light, at least. It becomes a disc of the same irradiance, at least as large as the sun.
    pub fn find_sun(self) -> Environment {
        let [width, height] = self.size;
        let all = self.levels.image.iter().map(|&texel| luminance(texel.into())).enumerate();
        let Some((index, peak)) = all.max_by(|a, b| a.1.total_cmp(&b.1)) else { return self };
        let index = index as u32;
        let toward = self.direction(index % width, index / width);

        // 1. What it is seen on: the mean of a ring around it, as texels that are not much brighter.
        // No other rows come as near.
        let rows = (3.0 * HALO / 180.0 * height as f32) as u32 + 2;
        let rows = (index / width).saturating_sub(rows)..height.min(index / width + rows);
        let near: Vec<Near> = rows
            .flat_map(|row| (0..width).map(move |column| (column, row)))
            .filter_map(|(column, row)| {
                let direction = self.direction(column, row);
                let angle = direction.dot(toward).clamp(-1.0, 1.0).acos().to_degrees();
                let texel = (row * width + column) as usize;
                (angle < 3.0 * HALO).then(|| Near { texel, angle, direction, band: levels::band(row, height) })
            })
            .collect();
        let (mut ring, mut weight) = (Vec3::ZERO, 0.0);
        for near in near.iter().filter(|near| near.angle >= HALO) {
            ring += near.band * Vec3::from_array(self.levels.image[near.texel]);
            weight += near.band;
        }
        if weight == 0.0 {
            return self;
        }
        let around = ring / weight;
        let threshold = CONTRAST * luminance(around);
        if peak <= threshold {
            return self;
        }

        // 2. What is brighter, within its halo.
        let (mut irradiance, mut middle, mut covered, mut taken) = (Vec3::ZERO, Vec3::ZERO, 0.0, Vec::new());
        for near in near.iter().filter(|near| near.angle < HALO) {
            let radiance = Vec3::from_array(self.levels.image[near.texel]);
            if luminance(radiance) > threshold {
                let solid = near.band * TAU / width as f32;
                let excess = solid * (radiance - around).max(Vec3::ZERO);
                irradiance += excess;
                middle += luminance(excess) * near.direction;
                covered += solid;
                taken.push(near.texel);
            }
        }
        let Some(direction) = middle.try_normalize() else { return self };
        if luminance(irradiance) < MIN_SHARE * luminance(self.irradiance(direction)) {
            return self;
        }

        // 3. A disc instead.
        let degrees = (2.0 * (covered / PI).sqrt()).to_degrees().clamp(SUN_ANGLE, 2.0 * HALO);
        let mut rest = self.with_sun(Some(Sun::new(direction, degrees, irradiance)));
        let mut image = rest.levels.image;
        for index in taken {
            image[index] = around.to_array();
        }
        rest.levels = image.into();
        rest
    }
}
