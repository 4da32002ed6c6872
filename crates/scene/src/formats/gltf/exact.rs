//! Numbers of the JSON in double precision, and our extras: the parts that the `gltf` crate rounds or passes over.

use glam::{DMat4, DQuat, DVec3};
use serde::Deserialize;
use serde_json::Value;

/// The parts of the JSON that are read twice.
#[derive(Debug, Deserialize)]
pub(super) struct Exact {
    #[serde(default)]
    nodes: Vec<ExactNode>,
    #[serde(default)]
    cameras: Vec<ExactCamera>,
    #[serde(default)]
    materials: Vec<WithExtras>,
    #[serde(default)]
    scenes: Vec<WithExtras>,
    #[serde(default)]
    extensions: Extensions,
}

#[derive(Debug, Deserialize)]
struct ExactNode {
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
struct WithExtras {
    extras: Option<Value>,
}

/// A camera's numbers.
#[derive(Debug, Deserialize)]
struct ExactCamera {
    perspective: Option<Perspective>,
    orthographic: Option<Orthographic>,
    extras: Option<Value>,
}

/// What a camera sees.
pub(super) enum View {
    /// Full vertical angle, radians.
    Yfov(f64),
    /// Half the height of the picture.
    Ymag(f64),
}

#[derive(Debug, Deserialize)]
struct Perspective {
    yfov: f64,
}

#[derive(Debug, Deserialize)]
struct Orthographic {
    ymag: f64,
}

#[derive(Debug, Default, Deserialize)]
struct Extensions {
    #[serde(default, rename = "KHR_lights_punctual")]
    lights_punctual: LightsPunctual,
}

#[derive(Debug, Default, Deserialize)]
struct LightsPunctual {
    #[serde(default)]
    lights: Vec<ExactLight>,
}

/// A light's numbers.
#[derive(Debug, Deserialize)]
pub(super) struct ExactLight {
    #[serde(default, rename = "type")]
    pub(super) kind: String,
    #[serde(default = "white")]
    color: [f64; 3],
    #[serde(default = "one")]
    intensity: f64,
    #[serde(default)]
    spot: Option<ExactSpot>,
    extras: Option<Value>,
}

/// A cone's numbers.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct ExactSpot {
    #[serde(default)]
    inner_cone_angle: f64,
    #[serde(default = "quarter")]
    outer_cone_angle: f64,
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

fn one() -> f64 {
    1.0
}

fn quarter() -> f64 {
    std::f64::consts::FRAC_PI_4
}

impl Exact {
    /// From the node's coordinates to its parent's.
    pub(super) fn transform(&self, node: usize) -> DMat4 {
        let Some(node) = self.nodes.get(node) else { return DMat4::IDENTITY };
        if let Some(matrix) = &node.matrix {
            return DMat4::from_cols_array(matrix);
        }
        let rotation = node.rotation.map_or(DQuat::IDENTITY, |xyzw| DQuat::from_array(xyzw).normalize());
        DMat4::from_scale_rotation_translation(
            node.scale.map_or(DVec3::ONE, DVec3::from),
            if rotation.is_finite() { rotation } else { DQuat::IDENTITY },
            node.translation.map_or(DVec3::ZERO, DVec3::from),
        )
    }

    /// Of a perspective camera the full vertical angle in radians, of an orthographic one half the height of its picture.
    pub(super) fn camera(&self, camera: usize) -> Option<View> {
        let camera = self.cameras.get(camera)?;
        let perspective = camera.perspective.as_ref().map(|perspective| View::Yfov(perspective.yfov));
        perspective.or(camera.orthographic.as_ref().map(|orthographic| View::Ymag(orthographic.ymag)))
    }

    pub(super) fn light(&self, light: usize) -> Option<&ExactLight> {
        self.extensions.lights_punctual.lights.get(light)
    }

    pub(super) fn camera_extras(&self, camera: usize) -> Option<&Value> {
        ours(&self.cameras.get(camera)?.extras)
    }

    pub(super) fn material_extras(&self, material: usize) -> Option<&Value> {
        ours(&self.materials.get(material)?.extras)
    }

    pub(super) fn scene_extras(&self, scene: usize) -> Option<&Value> {
        ours(&self.scenes.get(scene)?.extras)
    }
}

impl ExactLight {
    /// Colour times intensity: candela or lux.
    pub(super) fn strength(&self) -> DVec3 {
        self.intensity * DVec3::from(self.color)
    }

    /// Inner and outer half-angle of a spot light, radians.
    pub(super) fn cone(&self) -> (f64, f64) {
        self.spot.as_ref().map_or((0.0, quarter()), |spot| (spot.inner_cone_angle, spot.outer_cone_angle))
    }

    pub(super) fn extras(&self) -> Option<&Value> {
        ours(&self.extras)
    }
}

fn ours(extras: &Option<Value>) -> Option<&Value> {
    extras.as_ref()?.get("lightmesh")
}
