//! Metallic-roughness to the coefficients of formula (1).
//!
//! With the base colour b, metalness m and roughness r, s = (1 − r)² is how much of a mirror the surface is, and
//! F₀ = 0.04 + (b − 0.04) m its reflectance at right angles (glTF 2.0, appendix B):
//!
//! ```text
//! k_d = b (1 − m s)    k_s = F₀ s    pow = 2/r⁴ − 2  (Walter et al. 2007: the Phong lobe as wide as a facet lobe of α = r²)
//! ```
//!
//! so that a rough metal is matt in its own colour, as it looks under point lights, and a smooth one mirrors.

use std::path::Path;

use glam::Vec3;

use super::{container::malformed, exact::Exact, extras, extras::MaterialExtras};
use crate::{LoadError, Material};

/// The material, by our own extras where the file has them.
pub(super) fn read(path: &Path, material: &gltf::Material, exact: &Exact) -> Result<Material, LoadError> {
    let name = material.name().unwrap_or_default().to_owned();
    let index = material.index().unwrap_or(usize::MAX);
    let own = extras::read::<MaterialExtras>(path, &format!("material {index}"), exact.material_extras(index))?;
    if let Some(own) = own {
        if own.shininess <= 0.0 {
            let problem = format!("extras.lightmesh of material {index} has shininess = {}", own.shininess);
            return Err(malformed(path, problem));
        }
        return Ok(Material {
            name,
            ka: own.ka.into(),
            kd: own.kd.into(),
            ks: own.ks.into(),
            shininess: own.shininess,
            emission: own.emission.into(),
            ..Material::default()
        });
    }
    let pbr = material.pbr_metallic_roughness();
    let [r, g, b, _] = pbr.base_color_factor();
    let emission = material.emissive_strength().unwrap_or(1.0) * Vec3::from(material.emissive_factor());
    let phong = phong(Vec3::new(r, g, b), pbr.metallic_factor(), pbr.roughness_factor());
    Ok(Material { name, emission, ..phong })
}

fn phong(base: Vec3, metallic: f32, roughness: f32) -> Material {
    let mirror = (1.0 - roughness).powi(2);
    let kd = base * (1.0 - metallic * mirror);
    Material {
        ka: kd,
        kd,
        ks: Vec3::splat(0.04).lerp(base, metallic) * mirror,
        shininess: (2.0 / roughness.powi(4) - 2.0).clamp(1.0, 10_000.0),
        ..Material::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COPPER: Vec3 = Vec3::new(0.95, 0.64, 0.54);

    #[test]
    fn a_rough_surface_is_matt_in_its_own_colour() {
        for metallic in [0.0, 1.0] {
            let material = phong(COPPER, metallic, 1.0);
            assert_eq!((material.kd, material.ka, material.ks), (COPPER, COPPER, Vec3::ZERO));
            assert_eq!(material.shininess, 1.0);
        }
    }

    #[test]
    fn a_smooth_metal_is_a_mirror_of_its_colour() {
        let material = phong(COPPER, 1.0, 0.0);
        assert_eq!(material.kd, Vec3::ZERO);
        assert!((material.ks - COPPER).length() < 1e-6);
        assert_eq!(material.shininess, 10_000.0);
    }

    #[test]
    fn a_smooth_dielectric_reflects_four_percent() {
        let material = phong(COPPER, 0.0, 0.5);
        assert_eq!(material.kd, COPPER);
        assert!((material.ks - Vec3::splat(0.01)).length() < 1e-7);
        assert!((material.shininess - 30.0).abs() < 1e-4);
    }
}
