//! The keys of a scene file, as serde types: the syntax, before values are checked.
//!
//! Every value keeps its position in the text ([`Spanned`]), so that a later check can report the line. Lengths are in
//! scene units, angles in degrees, positions in world coordinates.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    motion_schema::{CameraMotionEntry, LightMotionEntry, ObjectMotionEntry},
    one_or_many,
    one_or_many::OneOrMany,
    spanned::Spanned,
    values::{Color, Number, Scale, Text, Vector},
};

/// A scene for lightmesh. Lengths are in scene units, angles in degrees, positions in world coordinates.
#[derive(Debug, Default, Deserialize, JsonSchema, Serialize)]
#[schemars(title = "Lightmesh scene")]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneFile {
    /// Origin of the frame of the stored `f32` coordinates; written by `export`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) origin: Option<Vector>,
    /// One `[camera]`, or several `[[camera]]` with names.
    #[schemars(with = "OneOrMany<CameraEntry>")]
    #[serde(default, deserialize_with = "one_or_many::deserialize", skip_serializing_if = "Vec::is_empty")]
    pub(crate) camera: Vec<Spanned<CameraEntry>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ambient: Option<AmbientEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sky: Option<Spanned<SkyEntry>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) environment: Option<Spanned<EnvironmentEntry>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) light: Vec<Spanned<LightEntry>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) material: Vec<Spanned<MaterialEntry>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) mesh: Vec<Spanned<MeshEntry>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) sphere: Vec<Spanned<SphereEntry>>,
    #[serde(default, rename = "box", skip_serializing_if = "Vec::is_empty")]
    pub(crate) boxes: Vec<Spanned<BoxEntry>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) plane: Vec<Spanned<PlaneEntry>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) cylinder: Vec<Spanned<CylinderEntry>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) triangle: Vec<Spanned<TriangleEntry>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) lightmesh: Option<LightMeshEntry>,
}

/// `[camera]`.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraEntry {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<Text>,
    pub(crate) position: Vector,
    /// The point at the centre of an image without `shift`; alternative: `direction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) target: Option<Vector>,
    /// The viewing direction; alternative: `target`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) direction: Option<Vector>,
    /// Default: +Y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) up: Option<Vector>,
    /// Full vertical field of view. Default: 50.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) vfov: Option<Number>,
    /// Full horizontal field of view, instead of `vfov`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) hfov: Option<Number>,
    /// Default: perspective.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) projection: Option<Spanned<ProjectionName>>,
    /// Height of an orthographic image, scene units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) height: Option<Number>,
    /// By how much the image is to the right of the viewing direction and above it, in heights of the image, as with a shifted lens: uprights
    /// stay parallel. Default: [0, 0].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) shift: Option<Spanned<[f64; 2]>>,
    /// The depth from which on surfaces and lights are seen, scene units along the viewing direction. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) near: Option<Number>,
    /// The depth up to which they are seen. Default: all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) far: Option<Number>,
    /// How it moves in a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motion: Option<CameraMotionEntry>,
}

/// How a camera maps space to the image.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ProjectionName {
    Perspective,
    Orthographic,
}

/// `[ambient]`.
#[derive(Debug, Default, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AmbientEntry {
    /// I_a of formula (1).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) intensity: Option<Spanned<Color>>,
    /// Radiance of rays that hit nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) background: Option<Spanned<Color>>,
}

/// `[sky]`: what surrounds the scene, and its sun. One table for all kinds; each kind uses some of the keys.
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SkyEntry {
    pub(crate) kind: Spanned<SkyName>,
    /// Clear: elevation of the sun, and azimuth clockwise from north, degrees. Default: [40, 225].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sun: Option<Spanned<[f64; 2]>>,
    /// Clear: latitude and longitude, degrees, instead of `sun`; with `time`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) place: Option<Spanned<[f64; 2]>>,
    /// Clear: date, time and offset from universal time, such as "2026-06-21T15:00+02:00".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) time: Option<Text>,
    /// Clear: haze, from 1 to 10. Default: 3.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) turbidity: Option<Number>,
    /// Clear: what the ground reflects; gradient: its radiance. Default: 0.2.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ground: Option<Spanned<Color>>,
    /// Uniform: radiance. Default: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) color: Option<Spanned<Color>>,
    /// Gradient: radiance straight above.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) zenith: Option<Spanned<Color>>,
    /// Gradient: radiance at the horizon.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) horizon: Option<Spanned<Color>>,
    /// The direction of the scene that is north, clockwise from -Z, or from +Y if Z is up, degrees. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) north: Option<Number>,
    /// Factor of all radiances. Default: 1, with which white that faces the sun of a clear sky shows 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) strength: Option<Number>,
    /// The axis that points up. Default: y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) up: Option<UpName>,
}

/// Kinds of skies.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum SkyName {
    Clear,
    Uniform,
    Gradient,
}

/// An axis that points up.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum UpName {
    Y,
    Z,
}

/// `[environment]`: a panorama around the scene.
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EnvironmentEntry {
    /// An equirectangular .hdr or .exr image, north in its middle.
    pub(crate) file: Text,
    /// Clockwise as seen from above, degrees. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rotation: Option<Number>,
    /// Factor of all radiances. Default: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) strength: Option<Number>,
    /// The axis that points up. Default: y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) up: Option<UpName>,
}

/// `[[light]]`: one table for all kinds; each kind uses some of the keys.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightEntry {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<Text>,
    pub(crate) kind: Spanned<LightKindName>,
    /// The light's centre; all kinds except directional.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) position: Option<Vector>,
    /// The direction of the light; of a disk or rectangle, the side to which it shines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) direction: Option<Vector>,
    /// A point that the light is aimed at, instead of `direction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) target: Option<Vector>,
    /// The axis of a disk, instead of `direction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) normal: Option<Vector>,
    /// Sphere and disk. Spot: it is a ball of this radius, and its shadows are soft. Default: 0, a point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) radius: Option<Number>,
    /// Point: radius of the ball over which soft shadows distribute the points that replace it. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) spread: Option<Number>,
    /// Directional: angular diameter of the disk that the light comes from, degrees; the sun's is 0.53. At most 179. Default: 0,
    /// parallel light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) angle: Option<Number>,
    /// Spot: half-angle of the full-strength cone. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) inner: Option<Number>,
    /// Spot: half-angle where the light ends. Default: 45.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) outer: Option<Number>,
    /// Rectangle: one whole edge.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) u: Option<Vector>,
    /// Rectangle: the edge next to `u`, perpendicular to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) v: Option<Vector>,
    /// Rectangle with a direction: width and height.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) size: Option<Spanned<[f64; 2]>>,
    /// Rectangle with a direction: the direction of its height. Default: +Y, or +Z if the direction is along Y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) up: Option<Vector>,
    /// Disk and rectangle: shines like a surface, to the side of the direction or normal, or of u × v, with `intensity` along it and less aside, by
    /// the cosine. If false, evenly to both sides, with `intensity` in all directions. Default: true.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) one_sided: Option<Spanned<bool>>,
    /// Lights with an area: the camera sees it, as mirrors and rays through glass always do. Default: false.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) visible: Option<Spanned<bool>>,
    /// Default: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) intensity: Option<Spanned<Color>>,
    /// Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) falloff: Option<FalloffName>,
    /// How it moves in a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motion: Option<LightMotionEntry>,
}

/// Shape of a light.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum LightKindName {
    Point,
    Directional,
    Spot,
    Sphere,
    Disk,
    Rectangle,
}

/// How distance attenuates a light.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum FalloffName {
    None,
    InverseSquare,
}

/// `[[material]]`: coefficients of formula (1).
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MaterialEntry {
    pub(crate) name: Text,
    /// Default: `kd`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ka: Option<Spanned<Color>>,
    /// Default: 0.8.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) kd: Option<Spanned<Color>>,
    /// Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ks: Option<Spanned<Color>>,
    /// Default: 20.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) shininess: Option<Number>,
    /// From 0, a mirror, to 1: the surface reflects by facets (GGX), as glTF describes it. Then `kd` is its base colour, and `ks`, by default
    /// 0.04, what the layer above it reflects at normal incidence. Not with `shininess`. Default with `metallic`: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) roughness: Option<Number>,
    /// From 0 to 1, a metal, whose reflections have the colour `kd`. Default with `roughness`: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) metallic: Option<Number>,
    /// Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) emission: Option<Spanned<Color>>,
    /// An image that `ka` and `kd` are multiplied with: PNG, JPEG, BMP or TGA, relative to the scene file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) texture: Option<Text>,
    /// An image that `emission` is multiplied with, placed as `texture` is. Default of `emission` with it: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) emission_texture: Option<Text>,
    /// An image of normals, as in glTF: red to the right of the image, green to its top, blue away from the surface; placed as `texture` is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) normal_texture: Option<Text>,
    /// What the slopes of `normal_texture` are multiplied with. Default: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) normal_scale: Option<Number>,
    /// An image that `roughness`, by its green, and `metallic`, by its blue, are multiplied with, as in glTF; placed as `texture` is. Default
    /// of both with it: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) metallic_roughness_texture: Option<Text>,
    /// An image that says where the surface is, leaves on a few triangles for example: by its alpha if it has any, else by its luminance.
    /// Placed as `texture` is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) opacity_texture: Option<Text>,
    /// The least opacity at which there is a surface, from 0 to 1. Not with `opacity` or `filter`. Default: 0.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) opacity_cutoff: Option<Number>,
    /// The share of the surface that is there, from 0 to 1; it lets the rest of the light through. With it, or with `filter`, the image's
    /// opacities are such shares, too. Default: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) opacity: Option<Number>,
    /// What is left, from 0 to 1, of light that goes through. Default: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) filter: Option<Spanned<Color>>,
    /// Index of refraction of what the surface bounds, glass 1.5 or water 1.33: it reflects by Fresnel's equations and bends what goes
    /// through, all of the light unless `opacity` says otherwise. The fronts of triangles are outside.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ior: Option<Number>,
    /// With `ior`: whether the triangles are panes, which do not bend light, in place of the surface of a body. Default: false.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) thin: Option<Spanned<bool>>,
    /// With `ior`: the absorption coefficient of the body, per unit of length. After the distance d, exp(-absorption d) is left. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) absorption: Option<Spanned<Color>>,
    /// How the image continues beyond its edge; one word, or one for each direction. Default: repeat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) texture_wrap: Option<Spanned<TextureWrap>>,
    /// How often the image fits on a face, or into the unit of the mesh's texture coordinates; one number, or one for each
    /// direction. Default: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) texture_scale: Option<Spanned<TextureScale>>,
    /// Rotates texture coordinates from u towards v, degrees. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) texture_rotate: Option<Number>,
    /// Added to texture coordinates last, in widths and heights of the image. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) texture_offset: Option<Spanned<[f64; 2]>>,
}

/// How an image continues beyond its edge.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum WrapName {
    Repeat,
    Mirror,
    Clamp,
}

/// One word, or one for each direction.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(untagged, expecting = "expected \"repeat\", \"mirror\" or \"clamp\", or two of them")]
pub(crate) enum TextureWrap {
    Both(WrapName),
    Each([WrapName; 2]),
}

/// One number, or one for each direction.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(untagged, expecting = "expected a number or [u, v]")]
pub(crate) enum TextureScale {
    Both(f64),
    Each([f64; 2]),
}

/// `[[mesh]]`: triangles of another file, scaled, then rotated, then translated.
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshEntry {
    /// The name of its object; else those of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<Text>,
    /// Relative to the scene file.
    pub(crate) file: Text,
    /// Replaces the file's own materials.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) material: Option<Text>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) translate: Option<Vector>,
    /// Rotates about the fixed X axis first, then Y, then Z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rotate: Option<Vector>,
    /// One factor, or one per axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) scale: Option<Spanned<Scale>>,
    /// How it moves in a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motion: Option<ObjectMotionEntry>,
}

/// `[[sphere]]`.
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SphereEntry {
    /// The name of its object; else `sphere` and its number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<Text>,
    pub(crate) center: Vector,
    pub(crate) radius: Number,
    pub(crate) material: Option<Text>,
    /// Triangles around the equator. Default: 96.
    pub(crate) segments: Option<Spanned<i64>>,
    /// How it moves in a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motion: Option<ObjectMotionEntry>,
}

/// `[[box]]`: `min` and `max`, or `center` and `size`.
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BoxEntry {
    /// The name of its object; else `box` and its number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<Text>,
    pub(crate) min: Option<Vector>,
    pub(crate) max: Option<Vector>,
    pub(crate) center: Option<Vector>,
    pub(crate) size: Option<Vector>,
    /// About the box's centre, as in `[[mesh]]`.
    pub(crate) rotate: Option<Vector>,
    pub(crate) material: Option<Text>,
    /// How it moves in a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motion: Option<ObjectMotionEntry>,
}

/// `[[plane]]`: a rectangle of the plane through `point`.
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlaneEntry {
    /// The name of its object; else `plane` and its number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<Text>,
    pub(crate) point: Vector,
    pub(crate) normal: Vector,
    /// Edge lengths. Default: a square of 20 diagonals of the rest of the scene.
    pub(crate) size: Option<Spanned<[f64; 2]>>,
    pub(crate) material: Option<Text>,
    /// How it moves in a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motion: Option<ObjectMotionEntry>,
}

/// `[[cylinder]]`: `base` and `top`, or `center`, `axis` and `height`.
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CylinderEntry {
    /// The name of its object; else `cylinder` and its number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<Text>,
    pub(crate) base: Option<Vector>,
    pub(crate) top: Option<Vector>,
    pub(crate) center: Option<Vector>,
    pub(crate) axis: Option<Vector>,
    pub(crate) height: Option<Number>,
    pub(crate) radius: Number,
    /// Whether its ends are closed. Default: true.
    pub(crate) caps: Option<bool>,
    pub(crate) material: Option<Text>,
    /// Edges around the axis. Default: 96.
    pub(crate) segments: Option<Spanned<i64>>,
    /// How it moves in a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motion: Option<ObjectMotionEntry>,
}

/// `[[triangle]]`: `a`, `b` and `c`, or `vertices`.
#[derive(Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TriangleEntry {
    /// The name of its object; else `triangle` and its number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<Text>,
    pub(crate) a: Option<Vector>,
    pub(crate) b: Option<Vector>,
    pub(crate) c: Option<Vector>,
    pub(crate) vertices: Option<Spanned<[[f64; 3]; 3]>>,
    /// Positions of the corners in an image: (0, 0) is its upper left corner. Default: lower left, lower right, upper left.
    pub(crate) uvs: Option<Spanned<[[f64; 2]; 3]>>,
    pub(crate) material: Option<Text>,
    /// How it moves in a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motion: Option<ObjectMotionEntry>,
}

/// `[lightmesh]`: proposed settings of the method.
#[derive(Debug, Default, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightMeshEntry {
    /// Step h, scene units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) step: Option<Number>,
    /// Interpolation radius in steps, R = r/h.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) radius: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) weight: Option<WeightName>,
}

/// Weight of formula (3).
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum WeightName {
    Constant,
    Quadratic,
    Smooth,
}
