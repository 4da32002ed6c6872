//! The sun of an environment: its disc, and the light that it is.

use std::f32::consts::PI;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::{Light, LightError};

/// The angular diameter of the sun, degrees.
pub(super) const SUN_ANGLE: f32 = 0.533;

/// A disc that is much brighter than all around it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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

    /// The same light of a part of the image, whose [radiance](Sun::radiance) comes from all of its disc, however wide.
    ///
    /// # Errors
    /// If it has no direction.
    pub(super) fn part_of_image(&self) -> Result<Light, LightError> {
        // The mean cosine between its middle and all of it.
        let cosine = 1.0 - 0.25 * self.radius * self.radius;
        let light = self.light()?;
        let intensity = cosine * light.intensity;
        Ok(light.with_intensity(intensity).named("panorama"))
    }
}
