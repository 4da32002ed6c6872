//! The keys of what moves in a scene file, as serde types, like those of [`schema`](super::schema).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    spanned::Spanned,
    values::{Color, Number, Scale, Vector},
};

/// `[camera.motion]`: what of the camera changes over time.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraMotionEntry {
    /// Default: smooth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) interpolation: Option<InterpolationName>,
    pub(crate) key: Vec<Spanned<CameraKey>>,
}

/// A key of a camera. What no key gives stays as the camera's table has it; what is given must be there, too.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraKey {
    /// Seconds from the beginning.
    pub(crate) time: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) position: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) target: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) direction: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) up: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) vfov: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) hfov: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) height: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) shift: Option<Spanned<[f64; 2]>>,
}

/// `[light.motion]`: what of the light changes over time.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightMotionEntry {
    /// Default: smooth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) interpolation: Option<InterpolationName>,
    pub(crate) key: Vec<Spanned<LightKey>>,
}

/// A key of a light. What no key gives stays as the light's table has it; what is given must be there, too.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightKey {
    /// Seconds from the beginning.
    pub(crate) time: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) position: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) direction: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) target: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) normal: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) radius: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) angle: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) inner: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) outer: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) size: Option<Spanned<[f64; 2]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) intensity: Option<Spanned<Color>>,
}

/// `[mesh.motion]`, and so for each solid: how the object moves relative to where its table places it.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ObjectMotionEntry {
    /// The point about which it is turned and scaled, before it is moved. Default: the `translate` of a mesh, the middle of a solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) pivot: Option<Vector>,
    /// Default: smooth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) interpolation: Option<InterpolationName>,
    pub(crate) key: Vec<Spanned<ObjectKey>>,
}

/// A key of an object.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ObjectKey {
    /// Seconds from the beginning.
    pub(crate) time: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) translate: Option<Vector>,
    /// Degrees about the fixed X axis first, then Y, then Z; keys may be several turns apart.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rotate: Option<Vector>,
    /// One factor, or one per axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) scale: Option<Spanned<Scale>>,
}

/// How values go from one key to the next.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum InterpolationName {
    /// Cubic splines with the slopes of Catmull and Rom.
    Smooth,
    /// Along lines.
    Linear,
    /// They stay until the next key.
    Step,
}
