//! Materials.

use glam::Vec3;
use lightmesh::scene::{Material as Surface, NormalMap, Opacity, Principled};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::argument::{Given, Single};
use crate::convert::{Color, Reflectance};
use crate::errors;
use crate::stored::{self, Reduced};
use crate::texture::{Album, Texture};

/// What a surface reflects, emits and lets through.
///
/// The constructor makes matt surfaces and mirrors of formula (1): `color` is k_d (and k_a), `specular` k_s with the Phong exponent
/// `shininess`. `Material.principled` is for everything that is described by metallic and roughness. Both have what follows.
///
/// `emission` is the radiance that it emits. `texture` tints `color`, `emission_texture` tints `emission`, and `normal_texture` turns normals, by slopes
/// times `normal_scale`. `opacity` is the share of the light that it stops, a `catcher` shows only the shadows on it, and `name` is what
/// `Frame.material_ids` call it.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Material {
    /// Without its images.
    surface: Surface,
    images: Images,
    /// What is not there, or shown through, by the alpha of the image of its colour.
    opacity: Option<Opacity>,
}

/// The images of a material.
#[derive(Clone, Default, Serialize, Deserialize)]
struct Images {
    color: Option<Texture>,
    emission: Option<Texture>,
    normals: Option<(Texture, f32)>,
    metallic_roughness: Option<Texture>,
}

impl Images {
    fn new(
        color: Option<Given<Texture>>,
        emission: Option<Given<Texture>>,
        normals: Option<Given<Texture>>,
        Single(scale): Single,
        metallic_roughness: Option<Given<Texture>>,
    ) -> Images {
        let of = |texture: Option<Given<Texture>>| texture.map(|Given(texture)| texture);
        Images {
            color: of(color),
            emission: of(emission),
            normals: of(normals).map(|normals| (normals, scale)),
            metallic_roughness: of(metallic_roughness),
        }
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
    Err(errors::setting(format!("{name} is a number from 0 to 1, not {value}")))
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
            color = None, *, specular = None, shininess = Single(20.0), emission = None, texture = None, emission_texture = None,
            normal_texture = None, normal_scale = Single(1.0), opacity = Single(1.0), catcher = Given(false), name = Given(String::new())
        ),
        text_signature = "(color=0.8, *, specular=0.0, shininess=20.0, emission=0.0, texture=None, emission_texture=None, \
            normal_texture=None, normal_scale=1.0, opacity=1.0, catcher=False, name='')"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        color: Option<Reflectance>,
        specular: Option<Reflectance>,
        shininess: Single,
        emission: Option<Color>,
        texture: Option<Given<Texture>>,
        emission_texture: Option<Given<Texture>>,
        normal_texture: Option<Given<Texture>>,
        normal_scale: Single,
        opacity: Single,
        catcher: Given<bool>,
        name: Given<String>,
    ) -> PyResult<Material> {
        let Single(shininess) = shininess;
        if shininess <= 0.0 {
            return Err(errors::setting(format!("shininess is a number above 0, not {shininess}")));
        }
        let color = color.map_or(Surface::default().kd, |color| color.0);
        let mut surface = Surface::matt(color)
            .with_ks(specular.map_or(Vec3::ZERO, |color| color.0))
            .with_shininess(shininess)
            .with_emission(emission.map_or(Vec3::ZERO, |color| color.0))
            .with_catcher(catcher.0)
            .named(name.0);
        let opacity = share("opacity", opacity.0)?;
        surface.opacity = (opacity < 1.0).then(|| Opacity::blend(opacity));
        let images = Images::new(texture, emission_texture, normal_texture, normal_scale, None);
        Ok(Material { surface, images, opacity: None })
    }

    /// A material of glTF's metallic-roughness model, read as from a glTF file.
    ///
    /// `texture` tints `color`; its alpha counts with `alpha_mode` "mask" (what is below `alpha_cutoff` is not there) and "blend".
    /// `metallic_roughness_texture` has roughness in its green and metallic in its blue channel, which are multiplied by the factors.
    /// `transmission` is the share of what is not metal that goes through as through glass of index `ior`, straight on if `thin`. `metallic` is the share
    /// of metal, `roughness` that of its facets, `specular` and `specular_tint` are strength and colour of what is reflected by what is not metal, and
    /// `alpha` is the opacity.
    #[staticmethod]
    #[pyo3(
        signature = (
            color = None, *, metallic = Single(0.0), roughness = Single(0.5), ior = Single(1.5), specular = Single(1.0), specular_tint = None,
            transmission = Single(0.0), thin = Given(false), emission = None, alpha = Single(1.0),
            alpha_mode = Given(String::from("opaque")), alpha_cutoff = Single(0.5),
            texture = None, emission_texture = None, normal_texture = None, normal_scale = Single(1.0),
            metallic_roughness_texture = None, name = Given(String::new())
        ),
        text_signature = "(color=0.8, *, metallic=0.0, roughness=0.5, ior=1.5, specular=1.0, specular_tint=1.0, transmission=0.0, thin=False, \
            emission=0.0, alpha=1.0, alpha_mode='opaque', alpha_cutoff=0.5, texture=None, emission_texture=None, \
            normal_texture=None, normal_scale=1.0, metallic_roughness_texture=None, name='')"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn principled(
        color: Option<Reflectance>,
        metallic: Single,
        roughness: Single,
        ior: Single,
        specular: Single,
        specular_tint: Option<Reflectance>,
        transmission: Single,
        thin: Given<bool>,
        emission: Option<Color>,
        alpha: Single,
        alpha_mode: Given<String>,
        alpha_cutoff: Single,
        texture: Option<Given<Texture>>,
        emission_texture: Option<Given<Texture>>,
        normal_texture: Option<Given<Texture>>,
        normal_scale: Single,
        metallic_roughness_texture: Option<Given<Texture>>,
        name: Given<String>,
    ) -> PyResult<Material> {
        let default = Principled::default();
        let Single(ior) = ior;
        if ior < 0.0 {
            return Err(errors::setting(format!("ior is a number that is not negative, not {ior}")));
        }
        let principled = Principled {
            base: color.map_or(Surface::default().kd, |color| color.0),
            metallic: share("metallic", metallic.0)?,
            roughness: share("roughness", roughness.0)?,
            ior: (ior != 1.5).then_some(ior),
            specular: share("specular", specular.0)?,
            specular_color: specular_tint.map_or(default.specular_color, |color| color.0),
            transmission: share("transmission", transmission.0)?,
            thin: thin.0,
            emission: emission.map_or(default.emission, |color| color.0),
            ..default
        };
        let (factor, cutoff) = (share("alpha", alpha.0)?, share("alpha_cutoff", alpha_cutoff.0)?);

        let opacity = match alpha_mode.as_str() {
            "opaque" => None,
            "mask" => Some(Opacity::default().with_factor(factor).with_cutoff(cutoff)),
            "blend" => Some(Opacity::blend(factor)),
            other => {
                return Err(errors::setting(format!("alpha_mode is opaque, mask or blend, not '{other}'")));
            }
        };
        let images = Images::new(texture, emission_texture, normal_texture, normal_scale, metallic_roughness_texture);
        // What lets light through by transmission says so itself.
        let opacity = opacity.filter(|_| !principled.transmits());
        Ok(Material { surface: principled.material().named(name.0), images, opacity })
    }

    /// As it was given; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.surface.name
    }

    /// For `pickle`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        stored::reduce(py, "Material", self)
    }

    /// It never changes: a copy is the same.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        format!("<lightmesh.Material {:?}>", self.surface.name)
    }
}
