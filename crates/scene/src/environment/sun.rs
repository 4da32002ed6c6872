//! The sun of an environment: its disc, and the light that it is.

use std::f32::consts::PI;

use glam::Vec3;

use super::{Environment, levels};
use crate::{Light, LightError};

/// The angular diameter of the sun, degrees.
pub(super) const SUN_ANGLE: f32 = 0.533;
/// How far from the brightest texel the sun of an image may reach, degrees: it is seen through haze, and blurred by lenses.
const HALO: f32 = 4.0;
/// A sun gives at least this share of the irradiance that faces it.
const LEAST_SHARE: f32 = 0.1;
/// Around a sun, the image is this much darker, at least.
const CONTRAST: f32 = 10.0;

/// A disc that is much brighter than all around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The unit vector to its centre.
    pub direction: Vec3,
    /// The distance of its edge from its centre where they are one unit away.
    pub radius: f32,
    /// Its radiance.
    pub radiance: Vec3,
}

impl Sun {
    /// A sun with this angular diameter, in degrees, that gives `irradiance` to surfaces that face it.
    pub fn new(direction: Vec3, degrees: f32, irradiance: Vec3) -> Sun {
        let radius = 2.0 * (0.25 * degrees.to_radians()).sin();
        Sun { direction: direction.normalize(), radius, radiance: irradiance / (PI * radius * radius) }
    }

    /// What surfaces that face it receive.
    pub fn irradiance(&self) -> Vec3 {
        PI * self.radius * self.radius * self.radiance
    }

    /// The light that it is: matt surfaces show what they reflect of its irradiance.
    ///
    /// # Errors
    /// If it has no direction.
    pub fn light(&self) -> Result<Light, LightError> {
        let angle = 4.0 * (0.5 * self.radius).min(1.0).asin();
        let light = Light::directional(-self.direction)?.with_angle(angle).with_intensity(self.irradiance() / PI);
        Ok(light.named("sun"))
    }
}

impl Environment {
    /// Takes the sun out of the image, if there is one: what is far brighter than the image around it, within a few degrees, and gives a
    /// tenth of the light, at least. It becomes a disc of the same irradiance, at least as large as the sun.
    pub fn find_sun(self) -> Environment {
        let [width, height] = self.size;
        let luminance = |texel: &[f32; 3]| Vec3::from_array(*texel).dot(Vec3::new(0.2126, 0.7152, 0.0722));
        let brightest = self.levels.image.iter().enumerate().max_by(|a, b| luminance(a.1).total_cmp(&luminance(b.1)));
        let Some((index, peak)) = brightest.map(|(index, texel)| (index as u32, luminance(texel))) else { return self };
        let toward = self.direction(index % width, index / width);

        // 1. What it is seen on: the mean of a ring around it, as texels that are not much brighter.
        let texel = |column: u32, row: u32| (row * width + column) as usize;
        let angle =
            |column: u32, row: u32| self.direction(column, row).dot(toward).clamp(-1.0, 1.0).acos().to_degrees();
        let places = || (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        let (mut ring, mut weight) = (Vec3::ZERO, 0.0);
        for (column, row) in places().filter(|&(column, row)| (HALO..3.0 * HALO).contains(&angle(column, row))) {
            let band = levels::band(row, height);
            ring += band * Vec3::from_array(self.levels.image[texel(column, row)]);
            weight += band;
        }
        if weight == 0.0 {
            return self;
        }
        let around = ring / weight;
        let threshold = CONTRAST * luminance(&around.to_array());
        if peak <= threshold {
            return self;
        }

        // 2. What is brighter, within its halo.
        let solid = |row: u32| levels::band(row, height) * std::f32::consts::TAU / width as f32;
        let (mut irradiance, mut middle, mut covered, mut taken) = (Vec3::ZERO, Vec3::ZERO, 0.0, Vec::new());
        for (column, row) in places().filter(|&(column, row)| angle(column, row) < HALO) {
            let index = texel(column, row);
            let radiance = Vec3::from_array(self.levels.image[index]);
            if luminance(&radiance.to_array()) > threshold {
                let excess = solid(row) * (radiance - around).max(Vec3::ZERO);
                irradiance += excess;
                middle += luminance(&excess.to_array()) * self.direction(column, row);
                covered += solid(row);
                taken.push(index);
            }
        }
        let Some(direction) = middle.try_normalize() else { return self };
        let sky = luminance(&self.irradiance(direction).to_array());
        if luminance(&irradiance.to_array()) < LEAST_SHARE * sky {
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
