//! Data that glTF cannot represent, stored in `extras` under `lightmesh`, so that a scene survives being written and read.

use std::path::Path;

use glam::Vec3;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::value::RawValue;

use super::container::malformed;
use crate::build::quote::abridged;
use crate::{Dielectric, Facets, LoadError, Material};

/// Of a material: the coefficients that metallic-roughness cannot represent.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct MaterialExtras {
    pub(crate) ka: [f32; 3],
    pub(crate) kd: [f32; 3],
    pub(crate) ks: [f32; 3],
    pub(crate) shininess: f32,
    pub(crate) emission: [f32; 3],
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) ks_tinted: [f32; 3],
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) emission_tinted: [f32; 3],
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) catcher: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) lamp: bool,
    /// The transform from texture coordinates to the image's, by columns, if an angle and factors would round it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) texture_transform: Option<[f32; 6]>,
    /// The same for the image that the emission is multiplied with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) emission_transform: Option<[f32; 6]>,
    /// The same for the image of normals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) normal_transform: Option<[f32; 6]>,
    /// The same for the image of how rough and metallic facets are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) metallic_roughness_transform: Option<[f32; 6]>,
    /// The image that tints the surface, unless it is that of the base colour, in which other programs find the opacity, too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) color: Option<ColorExtras>,
    /// Where the surface is, and what it lets through, unless `alphaMode` says so.
    #[serde(default, alias = "cut_out", skip_serializing_if = "Option::is_none")]
    pub(crate) opacity: Option<OpacityExtras>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) dielectric: Option<DielectricExtras>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) facets: Option<FacetExtras>,
}

/// Facets.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct FacetExtras {
    pub(crate) roughness: f32,
    pub(crate) metallic: f32,
    pub(crate) grazing: f32,
}

impl From<Facets> for FacetExtras {
    fn from(Facets { roughness, metallic, grazing }: Facets) -> FacetExtras {
        FacetExtras { roughness, metallic, grazing }
    }
}

impl From<FacetExtras> for Facets {
    fn from(FacetExtras { roughness, metallic, grazing }: FacetExtras) -> Facets {
        Facets::new(roughness).with_metallic(metallic).with_grazing(grazing)
    }
}

/// The boundary of a transparent body.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct DielectricExtras {
    pub(crate) ior: f32,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) thin: bool,
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) absorption: [f32; 3],
}

impl From<Dielectric> for DielectricExtras {
    fn from(Dielectric { ior, thin, absorption }: Dielectric) -> DielectricExtras {
        DielectricExtras { ior, thin, absorption: absorption.to_array() }
    }
}

impl From<DielectricExtras> for Dielectric {
    fn from(DielectricExtras { ior, thin, absorption }: DielectricExtras) -> Dielectric {
        Dielectric::new(ior).with_thin(thin).with_absorption(absorption)
    }
}

/// An image that tints a surface, or none.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct ColorExtras {
    /// Index of the file's texture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) texture: Option<u32>,
    /// The transform from texture coordinates to the image's, by columns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) transform: Option<[f32; 6]>,
}

/// An opacity by something else than the alpha of the base colour.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct OpacityExtras {
    pub(crate) factor: f32,
    /// Of a mask.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) cutoff: Option<f32>,
    /// Of a surface that lets a share of the light through.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) filter: Option<[f32; 3]>,
    /// Index of the file's texture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) texture: Option<u32>,
    /// The transform from texture coordinates to the image's, by columns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) transform: Option<[f32; 6]>,
    /// The name of what counts of a texel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) channel: Option<String>,
}

impl MaterialExtras {
    /// The material of this name, without a texture.
    pub(super) fn into_material(self, name: String) -> Material {
        Material {
            name,
            ka: self.ka.into(),
            kd: self.kd.into(),
            ks: self.ks.into(),
            ks_tinted: self.ks_tinted.into(),
            shininess: self.shininess,
            facets: self.facets.map(Facets::from),
            emission: self.emission.into(),
            emission_tinted: self.emission_tinted.into(),
            texture: None,
            emission_texture: None,
            normal_texture: None,
            metallic_roughness_texture: None,
            catcher: self.catcher,
            lamp: self.lamp,
            one_sided: false,
            opacity: None,
            dielectric: self.dielectric.map(Dielectric::from),
        }
    }
}

fn is_zero(color: &[f32; 3]) -> bool {
    Vec3::from(*color) == Vec3::ZERO
}

/// Of a light: its size, in the node's coordinates or those of what is around it, and whether distance does not attenuate it.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightExtras {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) shape: Option<ShapeExtras>,
    /// Radius of the ball in which area mode distributes the points of a point light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) spread: Option<f32>,
    /// Angular diameter of a directional light, radians.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) angle: Option<f32>,
    /// Radius of the ball that a spot light is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) radius: Option<f32>,
    /// Of a disk or rectangle: whether it shines like a surface, to the side of its normal or of half_u × half_v.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) one_sided: bool,
    /// Whether its node is turned only so that a spot shines to that side: the shape is as it is without that turn.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) aimed: bool,
    /// Falloff `none`; else inverse-square, as in glTF.
    #[serde(default)]
    pub(crate) no_falloff: bool,
    /// Without falloff: the candela or lux that stand for an intensity of 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) unit: Option<f64>,
    /// Whether the camera sees a light with an area.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) visible: bool,
}

/// The shape of a light that is a point or a spot in glTF.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ShapeExtras {
    Sphere { radius: f32 },
    Disk { normal: [f32; 3], radius: f32 },
    Rectangle { half_u: [f32; 3], half_v: [f32; 3] },
}

/// Of a camera.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraExtras {
    /// The full horizontal field of view in degrees, if that is the one that is fixed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) hfov: Option<f32>,
    /// By how much the image is to the right of the view direction and above it, in heights of the image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) shift: Option<[f32; 2]>,
    /// The depth from which on it sees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) near: Option<f32>,
    /// The depth up to which it sees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) far: Option<f32>,
}

/// Of a scene.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneExtras {
    /// Origin of the local frame in world coordinates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) origin: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) ambient: Option<[f32; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) background: Option<[f32; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) step: Option<f32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) radius: Option<f32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) weight: Option<String>,
}

/// Reads our extras of `what`, such as "material 3"; `None` if there are none, or only those of other programs.
pub(super) fn read<T: DeserializeOwned>(
    path: &Path,
    what: &str,
    extras: Option<&RawValue>,
) -> Result<Option<T>, LoadError> {
    #[derive(Deserialize)]
    #[serde(bound = "T: DeserializeOwned")]
    struct Ours<T> {
        lightmesh: Option<T>,
    }
    // Extras may have any type; ours are an object.
    let Some(extras) = extras.filter(|extras| extras.get().starts_with('{')) else { return Ok(None) };
    serde_json::from_str::<Ours<T>>(extras.get()).map(|ours| ours.lightmesh).map_err(|error| {
        malformed(path, format!("extras.lightmesh of {what} is damaged ({})", abridged(&error.to_string())))
    })
}
