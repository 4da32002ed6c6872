//! Materials: the coefficients of the shading model, formula (1).

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::{Dielectric, Facets, NormalMap, Opacity, TextureUse};

/// How a surface reflects light: ambient, diffuse and Phong terms (Whitted 1980, Phong 1975), or by [facets](Material::facets).
///
/// If a texture or vertex colours give a surface point a tint t — their product, white if there are neither — its coefficients
/// are `ka` t, `kd` t and `ks` + `ks_tinted` t, and it emits `emission` e + `emission_tinted` t, where e is the colour of the
/// [emission texture](Material::emission_texture), white without one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Material {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// Share of the ambient intensity, per channel.
    pub ka: Vec3,
    /// Diffuse reflectance k_d, per channel.
    pub kd: Vec3,
    /// Specular coefficient k_s, per channel: the Phong lobe and, with `--bounces`, the mirror. With the tinted part at most 1:
    /// loaders and builders lower what is above, with a warning.
    pub ks: Vec3,
    /// The part of the specular coefficient that is tinted: the reflection of a metal. It also counts without a tint.
    pub ks_tinted: Vec3,
    /// Phong exponent `pow`.
    pub shininess: f32,
    /// With these the surface reflects as glTF describes it: they say what `kd` and `ks` are then, and only these two count, and the tint of
    /// `kd`. Glass reflects by its own rules.
    pub facets: Option<Facets>,
    /// Emitted radiance. It lights other surfaces by the lights of a [lamp](Material::lamp), or where light is gathered.
    pub emission: Vec3,
    /// The part of the emitted radiance that is tinted: a surface that shows its image unlit. It also counts without a tint.
    pub emission_tinted: Vec3,
    /// An image that tints the surface.
    pub texture: Option<TextureUse>,
    /// An image that `emission` is multiplied with. Lights that stand for the surface have the mean of its texels.
    pub emission_texture: Option<TextureUse>,
    /// An image of normals, which the shading uses in place of the surface's.
    pub normal_texture: Option<NormalMap>,
    /// An image of how rough and metallic the [facets](Material::facets) are: their roughness is multiplied with its green, `metallic` with
    /// its blue, as in glTF.
    pub metallic_roughness_texture: Option<TextureUse>,
    /// Whether only the shadows on it are seen: it shows the background, darker where it gets less light than it would alone, or is
    /// transparent there. Then nothing but `ka` and `kd` counts.
    pub catcher: bool,
    /// Whether lights stand for what it emits ([`Light::surface`](crate::Light::surface)): where light is gathered, it is left out.
    pub lamp: bool,
    /// Whether only the front of what it emits lights other surfaces: where corners are counter-clockwise. Rays that see the back show the same as
    /// on the front, since surfaces are never culled.
    pub one_sided: bool,
    /// Where the surface is, and what it lets through; opaque everywhere without it.
    pub opacity: Option<Opacity>,
    /// Of glass and the like: how light is reflected, and goes on, where the opacity lets it through.
    pub dielectric: Option<Dielectric>,
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
            facets: None,
            emission: Vec3::ZERO,
            emission_tinted: Vec3::ZERO,
            texture: None,
            emission_texture: None,
            normal_texture: None,
            metallic_roughness_texture: None,
            catcher: false,
            lamp: false,
            one_sided: false,
            opacity: None,
            dielectric: None,
        }
    }
}

/// Materials in one expression; each method sets the field of its name.
///
/// ```
/// use lightmesh_scene::Material;
///
/// let brass = Material::matt([0.3, 0.22, 0.1]).with_ks([0.6, 0.5, 0.3]).with_shininess(60.0).named("brass");
/// assert_eq!(brass.ka, brass.kd);
/// ```
impl Material {
    /// What a surface emits whose image of emitted light cannot be shown. Such images are black nearly everywhere: better no light
    /// than light from the whole surface.
    pub(crate) const EMISSION_WITHOUT_IMAGE: Vec3 = Vec3::ZERO;

    /// The specular coefficient, with the tinted part, if it exceeds 1 by more than rounding: a mirror that adds light.
    pub(crate) fn excess(&self) -> Option<Vec3> {
        const ROUNDING: f32 = 4.0 * f32::EPSILON;
        let whole = self.ks + self.ks_tinted;
        (whole.max_element() > 1.0 + ROUNDING).then_some(whole)
    }

    /// Whether light may go through a surface of this material.
    pub fn is_transmissive(&self) -> bool {
        !self.catcher && self.opacity.is_some_and(|opacity| opacity.filter().is_some())
    }

    /// What it is made of, if light goes through.
    pub fn boundary(&self) -> Option<&Dielectric> {
        self.dielectric.as_ref().filter(|_| self.is_transmissive())
    }

    /// Its facets, unless it is glass.
    pub fn faceted(&self) -> Option<&Facets> {
        self.facets.as_ref().filter(|_| self.dielectric.is_none() && !self.catcher)
    }

    /// Whether there is no surface of this material anywhere.
    pub(crate) fn is_nowhere(&self) -> bool {
        self.dielectric.is_none() && self.opacity.is_some_and(|opacity| opacity.is_nowhere())
    }

    /// Whether any of its images needs texture coordinates.
    pub(crate) fn needs_uvs(&self) -> bool {
        let of_normals = self.normal_texture.map(|map| map.uses);
        let of_opacity = self.opacity.and_then(|opacity| opacity.texture);
        let colors = [self.texture, self.emission_texture];
        let others = [of_normals, self.metallic_roughness_texture, of_opacity];
        colors.iter().chain(&others).any(Option::is_some)
    }

    /// Glass and the like, which is black apart from what it reflects and what goes through.
    pub fn of(dielectric: Dielectric) -> Material {
        Material::matt(Vec3::ZERO).with_opacity(Opacity::blend(0.0)).with_dielectric(dielectric)
    }

    /// A matt surface of this colour, also in ambient light.
    pub fn matt(color: impl Into<Vec3>) -> Material {
        let color = color.into();
        Material { ka: color, kd: color, ..Material::default() }
    }

    /// The same material with a name.
    pub fn named(self, name: impl Into<String>) -> Material {
        Material { name: name.into(), ..self }
    }

    /// Share of the ambient intensity.
    pub fn with_ka(self, ka: impl Into<Vec3>) -> Material {
        Material { ka: ka.into(), ..self }
    }

    /// Diffuse reflectance.
    pub fn with_kd(self, kd: impl Into<Vec3>) -> Material {
        Material { kd: kd.into(), ..self }
    }

    /// Specular coefficient.
    pub fn with_ks(self, ks: impl Into<Vec3>) -> Material {
        Material { ks: ks.into(), ..self }
    }

    /// The part of the specular coefficient that is tinted.
    pub fn with_ks_tinted(self, ks_tinted: impl Into<Vec3>) -> Material {
        Material { ks_tinted: ks_tinted.into(), ..self }
    }

    /// Phong exponent.
    pub fn with_shininess(self, shininess: f32) -> Material {
        Material { shininess, ..self }
    }

    /// How rough and metallic it is.
    pub fn with_facets(self, facets: Facets) -> Material {
        Material { facets: Some(facets), ..self }
    }

    /// Emitted radiance.
    pub fn with_emission(self, emission: impl Into<Vec3>) -> Material {
        Material { emission: emission.into(), ..self }
    }

    /// The part of the emitted radiance that is tinted.
    pub fn with_emission_tinted(self, emission_tinted: impl Into<Vec3>) -> Material {
        Material { emission_tinted: emission_tinted.into(), ..self }
    }

    /// Whether only the shadows on it are seen.
    pub fn with_catcher(self, catcher: bool) -> Material {
        Material { catcher, ..self }
    }

    /// Whether lights stand for what it emits.
    pub fn with_lamp(self, lamp: bool) -> Material {
        Material { lamp, ..self }
    }

    /// Whether what it emits lights other surfaces in front of it only.
    pub fn with_one_sided(self, one_sided: bool) -> Material {
        Material { one_sided, ..self }
    }

    /// An image that tints the surface.
    pub fn with_texture(self, texture: TextureUse) -> Material {
        Material { texture: Some(texture), ..self }
    }

    /// An image that the emission is multiplied with.
    pub fn with_emission_texture(self, texture: TextureUse) -> Material {
        Material { emission_texture: Some(texture), ..self }
    }

    /// An image of normals, which the shading uses in place of the surface's.
    pub fn with_normal_texture(self, map: NormalMap) -> Material {
        Material { normal_texture: Some(map), ..self }
    }

    /// An image that roughness (green) and `metallic` (blue) are multiplied with.
    pub fn with_metallic_roughness_texture(self, texture: TextureUse) -> Material {
        Material { metallic_roughness_texture: Some(texture), ..self }
    }

    /// Where the surface is, and what it lets through.
    pub fn with_opacity(self, opacity: Opacity) -> Material {
        Material { opacity: Some(opacity), ..self }
    }

    /// How light is reflected, and goes on, where the opacity lets it through.
    pub fn with_dielectric(self, dielectric: Dielectric) -> Material {
        Material { dielectric: Some(dielectric), ..self }
    }
}
