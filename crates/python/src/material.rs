//! Materials.

use lightmesh::scene::{Material as Surface, NormalMap, Opacity, Principled};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::convert::Color;
use crate::texture::{Album, Texture};

/// What a surface reflects, emits and lets through.
///
/// The constructor makes matt surfaces and mirrors of formula (1): `color` is k_d (and k_a), `specular` k_s with the Phong exponent
/// `shininess`. `Material.principled` is for everything that is described by metallic and roughness.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone)]
pub(crate) struct Material {
    /// Without its images.
    surface: Surface,
    images: Images,
    /// What is not there, or shown through, by the alpha of the image of its colour.
    opacity: Option<Opacity>,
}

/// The images of a material.
#[derive(Clone, Default)]
struct Images {
    color: Option<Texture>,
    emission: Option<Texture>,
    normals: Option<(Texture, f32)>,
    metallic_roughness: Option<Texture>,
}

impl Images {
    fn new(
        color: Option<Texture>,
        emission: Option<Texture>,
        normals: Option<Texture>,
        scale: f32,
        metallic_roughness: Option<Texture>,
    ) -> Images {
        Images { color, emission, normals: normals.map(|normals| (normals, scale)), metallic_roughness }
    }

    fn is_empty(&self) -> bool {
        self.color.is_none() && self.emission.is_none() && self.normals.is_none() && self.metallic_roughness.is_none()
    }
}

/// A share, from 0 to 1.
fn share(name: &str, value: f32) -> PyResult<f32> {
    if (0.0..=1.0).contains(&value) {
        return Ok(value);
    }
    Err(PyValueError::new_err(format!("{name} is a number from 0 to 1, not {value}")))
}

impl Material {
    /// The material that surfaces have of which nothing is said.
    pub(crate) fn default_matt() -> Material {
        Material { surface: Surface::default(), images: Images::default(), opacity: None }
    }

    /// Whether it shows images, which need texture coordinates.
    pub(crate) fn has_images(&self) -> bool {
        !self.images.is_empty()
    }

    /// As a material of a scene, whose images are in the album.
    pub(crate) fn build(&self, album: &mut Album) -> Surface {
        let Images { color, emission, normals, metallic_roughness } = &self.images;
        let mut surface = self.surface.clone();
        // No light stands for it, unless the scene makes lamps.
        surface.lamp = false;
        surface.texture = color.as_ref().map(|texture| album.add(texture));
        surface.emission_texture = emission.as_ref().map(|texture| album.add(texture));
        let of_normals = |(texture, scale): &(Texture, f32)| NormalMap::new(album.add(texture)).with_scale(*scale);
        surface.normal_texture = normals.as_ref().map(of_normals);
        surface.metallic_roughness_texture = metallic_roughness.as_ref().map(|texture| album.add(texture));
        if let Some(mut opacity) = self.opacity {
            opacity.texture = surface.texture;
            surface.opacity = Some(opacity);
        }
        surface
    }
}

#[pymethods]
impl Material {
    #[new]
    #[pyo3(
        signature = (
            color = None, *, specular = None, shininess = 20.0, emission = None, texture = None, emission_texture = None,
            normal_texture = None, normal_scale = 1.0, opacity = 1.0, catcher = false, name = String::new()
        ),
        text_signature = "(color=0.8, *, specular=0.0, shininess=20.0, emission=0.0, texture=None, emission_texture=None, \
            normal_texture=None, normal_scale=1.0, opacity=1.0, catcher=False, name='')"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        color: Option<Color>,
        specular: Option<Color>,
        shininess: f32,
        emission: Option<Color>,
        texture: Option<Texture>,
        emission_texture: Option<Texture>,
        normal_texture: Option<Texture>,
        normal_scale: f32,
        opacity: f32,
        catcher: bool,
        name: String,
    ) -> PyResult<Material> {
        if !(shininess > 0.0 && shininess.is_finite()) {
            return Err(PyValueError::new_err(format!("shininess is a finite number above 0, not {shininess}")));
        }
        let color = color.map_or(Surface::default().kd, |color| color.0);
        let of = |color: Option<Color>| color.map_or(glam::Vec3::ZERO, |color| color.0);
        let mut surface = Surface::matt(color)
            .with_ks(of(specular))
            .with_shininess(shininess)
            .with_emission(of(emission))
            .with_catcher(catcher)
            .named(name);
        let opacity = share("opacity", opacity)?;
        surface.opacity = (opacity < 1.0).then(|| Opacity::blend(opacity));
        let images = Images::new(texture, emission_texture, normal_texture, normal_scale, None);
        Ok(Material { surface, images, opacity: None })
    }

    /// A material of glTF's metallic-roughness model, read as from a glTF file.
    ///
    /// `texture` tints `color`; its alpha counts with `alpha_mode` "mask" (what is below `alpha_cutoff` is not there) and "blend".
    /// `metallic_roughness_texture` has roughness in its green and metallic in its blue channel, which are multiplied by the factors.
    /// `transmission` is the share of what is not metal that goes through as through glass of index `ior`, straight on if `thin`.
    #[staticmethod]
    #[pyo3(
        signature = (
            color = None, *, metallic = 0.0, roughness = 0.5, ior = 1.5, specular = 1.0, specular_tint = None,
            transmission = 0.0, thin = false, emission = None, alpha = 1.0, alpha_mode = "opaque", alpha_cutoff = 0.5,
            texture = None, emission_texture = None, normal_texture = None, normal_scale = 1.0,
            metallic_roughness_texture = None, name = String::new()
        ),
        text_signature = "(color=0.8, *, metallic=0.0, roughness=0.5, ior=1.5, specular=1.0, specular_tint=1.0, transmission=0.0, thin=False, \
            emission=0.0, alpha=1.0, alpha_mode='opaque', alpha_cutoff=0.5, texture=None, emission_texture=None, \
            normal_texture=None, normal_scale=1.0, metallic_roughness_texture=None, name='')"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn principled(
        color: Option<Color>,
        metallic: f32,
        roughness: f32,
        ior: f32,
        specular: f32,
        specular_tint: Option<Color>,
        transmission: f32,
        thin: bool,
        emission: Option<Color>,
        alpha: f32,
        alpha_mode: &str,
        alpha_cutoff: f32,
        texture: Option<Texture>,
        emission_texture: Option<Texture>,
        normal_texture: Option<Texture>,
        normal_scale: f32,
        metallic_roughness_texture: Option<Texture>,
        name: String,
    ) -> PyResult<Material> {
        let default = Principled::default();
        if !(ior >= 0.0 && ior.is_finite()) {
            return Err(PyValueError::new_err(format!("ior is a finite number that is not negative, not {ior}")));
        }
        let principled = Principled {
            base: color.map_or(Surface::default().kd, |color| color.0),
            metallic: share("metallic", metallic)?,
            roughness: share("roughness", roughness)?,
            ior: (ior != 1.5).then_some(ior),
            specular: share("specular", specular)?,
            specular_color: specular_tint.map_or(default.specular_color, |color| color.0),
            transmission: share("transmission", transmission)?,
            thin,
            emission: emission.map_or(default.emission, |color| color.0),
            ..default
        };
        let (factor, cutoff) = (share("alpha", alpha)?, share("alpha_cutoff", alpha_cutoff)?);

        let opacity = match alpha_mode {
            "opaque" => None,
            "mask" => Some(Opacity::default().with_factor(factor).with_cutoff(cutoff)),
            "blend" => Some(Opacity::blend(factor)),
            other => {
                return Err(PyValueError::new_err(format!("alpha_mode is opaque, mask or blend, not '{other}'")));
            }
        };
        let images = Images::new(texture, emission_texture, normal_texture, normal_scale, metallic_roughness_texture);
        // What lets light through by transmission says so itself.
        let opacity = opacity.filter(|_| !principled.transmits());
        Ok(Material { surface: principled.material().named(name), images, opacity })
    }

    /// As it was given; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.surface.name
    }

    fn __repr__(&self) -> String {
        format!("<lightmesh.Material {:?}>", self.surface.name)
    }
}
