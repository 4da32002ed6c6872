//! Facets: rough surfaces as glTF describes them, metals and others.

use serde::{Deserialize, Serialize};

/// How rough a surface is, and how metallic. With facets, the coefficients of a [`Material`](crate::Material) are those of glTF's
/// metallic-roughness model: `kd` is the base colour, and `ks` what the layer above it reflects at normal incidence, 0.04 for most matter
/// that is no metal. The exponent of the Phong lobe does not count.
///
/// The lobe is that of Trowbridge and Reitz, GGX (Walter et al. 2007), with a width of the square of the roughness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Facets {
    /// From 0, a mirror, to 1.
    pub roughness: f32,
    /// From 0 to 1, a metal: nothing is scattered below its surface, and the base colour is that of its reflections.
    pub metallic: f32,
    /// What the layer reflects at grazing incidence, from 0 to 1; a metal reflects all.
    pub grazing: f32,
}

impl Facets {
    /// What a layer of an index of refraction of 1.5 reflects at normal incidence.
    pub const LAYER: f32 = 0.04;

    /// Matter that is no metal, of this roughness.
    pub fn new(roughness: f32) -> Facets {
        Facets { roughness, metallic: 0.0, grazing: 1.0 }
    }

    /// As a metal, or a mixture.
    pub fn with_metallic(self, metallic: f32) -> Facets {
        Facets { metallic, ..self }
    }

    /// With this reflectance at grazing incidence.
    pub fn with_grazing(self, grazing: f32) -> Facets {
        Facets { grazing, ..self }
    }
}
