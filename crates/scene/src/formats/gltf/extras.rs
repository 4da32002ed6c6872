//! What glTF has no word for, kept in `extras` under `lightmesh`, so that a scene survives being written and read.

use std::path::Path;

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use super::container::malformed;
use crate::LoadError;

/// Of a material: the coefficients that metallic-roughness cannot say.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct MaterialExtras {
    pub(crate) ka: [f32; 3],
    pub(crate) kd: [f32; 3],
    pub(crate) ks: [f32; 3],
    pub(crate) shininess: f32,
    pub(crate) emission: [f32; 3],
}

/// Of a light: its size, in the node's coordinates, and that distance does not weaken it.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightExtras {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) shape: Option<ShapeExtras>,
    /// Radius of the ball in which area mode strews the points of a point light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) spread: Option<f32>,
    /// Falloff `none`; else inverse-square, as in glTF.
    #[serde(default)]
    pub(crate) no_falloff: bool,
}

/// The shape of a light that is a point in glTF.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ShapeExtras {
    Sphere { radius: f32 },
    Disk { normal: [f32; 3], radius: f32 },
    Rectangle { half_u: [f32; 3], half_v: [f32; 3] },
}

/// Of a camera: the full horizontal angle in degrees, where that is the one that is fixed.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraExtras {
    pub(crate) hfov: f32,
}

/// Of a scene.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneExtras {
    /// Zero of the local frame in world coordinates.
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

/// Reads our extras of `what`, such as "material 3"; `None` where there are none.
pub(super) fn read<T: DeserializeOwned>(
    path: &Path,
    what: &str,
    value: Option<&Value>,
) -> Result<Option<T>, LoadError> {
    let parse = |value: &Value| {
        T::deserialize(value)
            .map_err(|error| malformed(path, format!("extras.lightmesh of {what} is damaged ({error})")))
    };
    value.map(parse).transpose()
}
