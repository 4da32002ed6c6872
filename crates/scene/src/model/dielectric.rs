//! Dielectrics: glass, water and other bodies that light goes through, bent and in part reflected at their surface.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The boundary of a transparent body. Reflection follows Fresnel's equations, the way on Snell's law; how much goes on besides is said by
/// the [opacity](crate::Opacity), which must let light through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Dielectric {
    /// Index of refraction, relative to what is around.
    pub ior: f32,
    /// Whether triangles are walls with two parallel surfaces, a pane each: light goes straight on. Else they bound a body, and their fronts
    /// are outside.
    pub thin: bool,
    /// Absorption coefficient of the body, per channel and unit of length: after the distance d, exp(−absorption · d) is left of the light.
    pub absorption: Vec3,
}

impl Dielectric {
    /// The index of refraction of common glass, and of glTF's materials of which nothing is said.
    pub const GLASS: f32 = 1.5;

    /// The boundary of a clear body.
    pub fn new(ior: f32) -> Dielectric {
        Dielectric { ior, thin: false, absorption: Vec3::ZERO }
    }

    /// As thin walls.
    pub fn with_thin(self, thin: bool) -> Dielectric {
        Dielectric { thin, ..self }
    }

    /// With this absorption coefficient.
    pub fn with_absorption(self, absorption: impl Into<Vec3>) -> Dielectric {
        Dielectric { absorption: absorption.into(), ..self }
    }

    /// With the absorption that leaves `color` of white light after a `distance`. Black, which no distance leaves, counts as nearly black.
    pub fn with_attenuation(self, color: impl Into<Vec3>, distance: f32) -> Dielectric {
        const BLACK: f32 = 1e-4;
        let color = color.into().clamp(Vec3::splat(BLACK), Vec3::ONE);
        self.with_absorption(color.map(|share| -share.ln() / distance).max(Vec3::ZERO))
    }
}
