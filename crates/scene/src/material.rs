//! Materials: the coefficients of the shading model, formula (1).

use glam::Vec3;

use crate::TextureUse;

/// How a surface answers light: ambient, diffuse and Phong terms (Whitted 1980, Phong 1975).
///
/// Where a texture or vertex colours give a surface point a tint t — their product, white where there are neither — its
/// coefficients are `ka` t, `kd` t and `ks` + `ks_tinted` t, and it gives off `emission` + `emission_tinted` t.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the file; empty where it has none.
    pub name: String,
    /// Share of the ambient intensity, per channel.
    pub ka: Vec3,
    /// Diffuse reflectance k_d, per channel.
    pub kd: Vec3,
    /// Specular coefficient k_s, per channel: the Phong lobe and, with `--bounces`, the mirror.
    pub ks: Vec3,
    /// The part of the specular coefficient that takes on the tint: the reflection of a metal. It counts without a tint, too.
    pub ks_tinted: Vec3,
    /// Phong exponent `pow`.
    pub shininess: f32,
    /// Radiance that the surface gives off by itself; it is seen but lights nothing.
    pub emission: Vec3,
    /// The part of that radiance that takes on the tint: a surface that shows its picture unlit. It counts without a tint, too.
    pub emission_tinted: Vec3,
    /// A picture that tints the surface.
    pub texture: Option<TextureUse>,
}

impl Default for Material {
    /// Matt and light grey.
    fn default() -> Material {
        Material {
            name: String::new(),
            ka: Vec3::splat(0.8),
            kd: Vec3::splat(0.8),
            ks: Vec3::ZERO,
            ks_tinted: Vec3::ZERO,
            shininess: 20.0,
            emission: Vec3::ZERO,
            emission_tinted: Vec3::ZERO,
            texture: None,
        }
    }
}
