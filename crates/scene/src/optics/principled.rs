//! Materials that are described by how metallic and how rough they are: glTF 2.0, appendix B, and its extensions for indices of refraction,
//! specular reflectance, transmission and volumes; Blender's Principled BSDF has the same parameters.
//!
//! The base colour is k_d, and k_s what the layer above reflects at normal incidence, 0.04 unless the index of refraction or the specular share
//! says otherwise; the rest are [facets](Facets). The share of the light that is not scattered goes through, times the base colour, as through
//! glass: straight on through thin walls, or bent and absorbed by a body.

use glam::Vec3;

use crate::{Dielectric, Facets, Material, Opacity};

/// Higher Phong exponents look like mirrors, and cause problems in `f32`.
pub const SHARPEST: f32 = 10_000.0;

/// The parameters of such a material. Those out of range are brought back into it.
///
/// ```
/// use lightmesh_scene::{Principled, glam::Vec3};
///
/// let copper = Principled { base: Vec3::new(0.95, 0.64, 0.54), metallic: 1.0, roughness: 0.3, ..Principled::default() };
/// assert_eq!(copper.material().facets.unwrap().metallic, 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    /// Base colour, linear.
    pub base: Vec3,
    /// From 0 to 1, a metal.
    pub metallic: f32,
    /// From 0, a mirror, to 1.
    pub roughness: f32,
    /// Index of refraction; 0 reflects everything. `None`: 1.5.
    pub ior: Option<f32>,
    /// What the layer's reflectance is multiplied with, from 0 to 1.
    pub specular: f32,
    /// What it is tinted with, at normal incidence.
    pub specular_color: Vec3,
    /// The share of the light that is not scattered below the surface but goes through, from 0 to 1.
    pub transmission: f32,
    /// Whether triangles are walls, through which light goes straight on. Else they bound a body.
    pub thin: bool,
    /// What a body leaves of white light after a distance.
    pub attenuation: Option<(Vec3, f32)>,
    /// Emitted radiance.
    pub emission: Vec3,
}

impl Default for Principled {
    /// White, rough, no metal.
    fn default() -> Principled {
        Principled {
            base: Vec3::ONE,
            metallic: 0.0,
            roughness: 1.0,
            ior: None,
            specular: 1.0,
            specular_color: Vec3::ONE,
            transmission: 0.0,
            thin: false,
            attenuation: None,
            emission: Vec3::ZERO,
        }
    }
}

impl Principled {
    /// The material, with the opacity of what transmits light.
    pub fn material(&self) -> Material {
        let base = self.base.max(Vec3::ZERO);
        let material = if self.transmits() {
            // What glass reflects is Fresnel's.
            let (dielectric, opacity) = (Some(self.boundary()), Some(self.opacity()));
            Material { shininess: shininess(self.roughness), dielectric, opacity, ..Material::matt(base) }
        } else {
            let (layer, grazing) = self.reflectance();
            let facets = Facets::new(share(self.roughness)).with_metallic(share(self.metallic)).with_grazing(grazing);
            Material::matt(base).with_ks(layer).with_facets(facets)
        };
        material.with_emission(self.emission.max(Vec3::ZERO)).with_lamp(true)
    }

    /// Whether light goes through.
    pub fn transmits(&self) -> bool {
        self.transmission > 0.0
    }

    /// What lets light through.
    fn opacity(&self) -> Opacity {
        let share = self.transmission.min(1.0) * (1.0 - share(self.metallic));
        Opacity::blend(1.0 - share).with_filter(self.base.clamp(Vec3::ZERO, Vec3::ONE))
    }

    /// The boundary of what transmits light.
    fn boundary(&self) -> Dielectric {
        let glass = Dielectric::new(self.ior.map_or(Dielectric::GLASS, |ior| ior.max(1.0)));
        match self.attenuation {
            _ if self.thin => glass.with_thin(true),
            Some((color, distance)) if distance > 0.0 => glass.with_attenuation(color, distance),
            _ => glass,
        }
    }

    /// What the layer reflects at normal and at grazing incidence, apart from a metal.
    pub(crate) fn reflectance(&self) -> (Vec3, f32) {
        let layer = self.ior.map_or(Facets::LAYER, |ior| match ior {
            // As defined by KHR_materials_ior: a surface that reflects everything.
            0.0 => 1.0,
            ior => ((ior.max(1.0) - 1.0) / (ior.max(1.0) + 1.0)).powi(2),
        });
        let factor = share(self.specular);
        ((layer * self.specular_color).clamp(Vec3::ZERO, Vec3::ONE) * factor, factor)
    }
}

fn share(factor: f32) -> f32 {
    factor.clamp(0.0, 1.0)
}

/// The lobe of a body's highlights, which is Phong's: as wide as facets of this roughness are (Walter et al. 2007).
pub fn shininess(roughness: f32) -> f32 {
    (2.0 / share(roughness).powi(4) - 2.0).clamp(1.0, SHARPEST)
}
