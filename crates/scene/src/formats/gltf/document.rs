//! The subset of glTF 2.0's JSON that is read. Names are the format's own (glTF 2.0, section 5, and the extensions' schemas).
//!
//! Numbers stay in double precision: a node may be far from the origin. Strings and extras are borrowed from the file's bytes, so
//! that a data URI is held only once. Indices are not checked here, but where they are used. Rarely used parts are boxed: two
//! characters of a hostile file must not become a kilobyte.

use std::{borrow::Cow, collections::HashMap, fmt};

use serde::{
    Deserialize, Deserializer,
    de::{Error, IgnoredAny, Visitor},
};
use serde_json::value::RawValue;

use crate::Dielectric;

/// A complete file.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document<'a> {
    pub(super) asset: Asset,
    #[serde(default)]
    pub(super) extensions_used: Vec<String>,
    #[serde(default)]
    pub(super) extensions_required: Vec<String>,
    pub(super) scene: Option<u32>,
    #[serde(borrow, default)]
    pub(super) scenes: Vec<Scene<'a>>,
    #[serde(default)]
    pub(super) nodes: Vec<Node>,
    #[serde(default)]
    pub(super) meshes: Vec<Mesh>,
    #[serde(borrow, default)]
    pub(super) accessors: Vec<Accessor<'a>>,
    #[serde(default)]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(borrow, default)]
    pub(super) buffers: Vec<Buffer<'a>>,
    #[serde(borrow, default)]
    pub(super) materials: Vec<Material<'a>>,
    #[serde(default)]
    pub(super) textures: Vec<Texture>,
    #[serde(borrow, default)]
    pub(super) images: Vec<Image<'a>>,
    #[serde(default)]
    pub(super) samplers: Vec<Sampler>,
    #[serde(borrow, default)]
    pub(super) cameras: Vec<Camera<'a>>,
    #[serde(default)]
    pub(super) skins: Vec<Skin>,
    #[serde(borrow, default)]
    pub(super) animations: Vec<Animation<'a>>,
    #[serde(borrow, default)]
    pub(super) extensions: DocumentExtensions<'a>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Asset {
    #[serde(default)]
    pub(super) version: Version,
    pub(super) min_version: Option<Version>,
}

/// A version, which must be a text.
#[derive(Debug, Default)]
pub(super) struct Version {
    pub(super) text: String,
    /// Whether it is a number instead.
    pub(super) is_number: bool,
}

impl<'de> Deserialize<'de> for Version {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Version, D::Error> {
        deserializer.deserialize_any(VersionVisitor)
    }
}

struct VersionVisitor;

impl Visitor<'_> for VersionVisitor {
    type Value = Version;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a string")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Version, E> {
        Ok(Version { text: text.to_owned(), is_number: false })
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Version, E> {
        self.visit_f64(number as f64)
    }

    /// With a point.
    fn visit_f64<E: Error>(self, number: f64) -> Result<Version, E> {
        Ok(Version { text: format!("{number:?}"), is_number: true })
    }
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct DocumentExtensions<'a> {
    #[serde(borrow, default, rename = "KHR_lights_punctual")]
    pub(super) lights_punctual: LightsPunctual<'a>,
    #[serde(default, rename = "EXT_lights_image_based")]
    pub(super) image_based: ImageBasedLights,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct ImageBasedLights {
    #[serde(default)]
    pub(super) lights: Vec<ImageBasedLight>,
}

/// What surrounds a scene: the six faces of a cube, and smaller, blurred ones.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ImageBasedLight {
    pub(super) intensity: Option<f64>,
    pub(super) rotation: Option<[f64; 4]>,
    #[serde(default)]
    pub(super) specular_images: Vec<Box<[u32]>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct SceneExtensions {
    #[serde(rename = "EXT_lights_image_based")]
    pub(super) environment: Option<LightReference>,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct LightsPunctual<'a> {
    #[serde(borrow, default)]
    pub(super) lights: Vec<Light<'a>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Scene<'a> {
    #[serde(default)]
    pub(super) nodes: Box<[u32]>,
    #[serde(borrow)]
    pub(super) extras: Option<&'a RawValue>,
    pub(super) extensions: Option<SceneExtensions>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<Box<str>>,
    #[serde(default)]
    pub(super) children: Box<[u32]>,
    pub(super) matrix: Option<Box<[f64; 16]>>,
    pub(super) translation: Option<Box<[f64; 3]>>,
    pub(super) rotation: Option<Box<[f64; 4]>>,
    pub(super) scale: Option<Box<[f64; 3]>>,
    pub(super) mesh: Option<u32>,
    pub(super) camera: Option<u32>,
    pub(super) skin: Option<u32>,
    /// Weights of morph targets, instead of the mesh's.
    #[serde(default)]
    pub(super) weights: Box<[f64]>,
    pub(super) extensions: Option<Box<NodeExtensions>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) light: Option<LightReference>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub(super) instancing: Option<Instancing>,
}

#[derive(Debug, Deserialize)]
pub(super) struct LightReference {
    pub(super) light: u32,
}

/// Accessors by the names TRANSLATION, ROTATION, SCALE, and others that exporters add.
#[derive(Debug, Deserialize)]
pub(super) struct Instancing {
    #[serde(default)]
    pub(super) attributes: HashMap<String, u32>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub(super) name: Option<Box<str>>,
    pub(super) primitives: Vec<Primitive>,
    /// Weights of morph targets.
    #[serde(default)]
    pub(super) weights: Box<[f64]>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: Box<Attributes>,
    pub(super) indices: Option<u32>,
    pub(super) material: Option<u32>,
    #[serde(default = "Primitive::triangles")]
    pub(super) mode: u32,
    /// Morph targets.
    #[serde(default)]
    pub(super) targets: Box<[Target]>,
}

impl Primitive {
    fn triangles() -> u32 {
        4
    }
}

/// Accessors of the attributes that are used.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(super) struct Attributes {
    pub(super) position: Option<u32>,
    pub(super) normal: Option<u32>,
    #[serde(rename = "TEXCOORD_0")]
    pub(super) texcoord_0: Option<u32>,
    #[serde(rename = "TEXCOORD_1")]
    pub(super) texcoord_1: Option<u32>,
    #[serde(rename = "COLOR_0")]
    pub(super) color_0: Option<u32>,
    #[serde(rename = "JOINTS_0")]
    pub(super) joints_0: Option<u32>,
    #[serde(rename = "WEIGHTS_0")]
    pub(super) weights_0: Option<u32>,
    #[serde(rename = "JOINTS_1")]
    pub(super) joints_1: Option<u32>,
    #[serde(rename = "WEIGHTS_1")]
    pub(super) weights_1: Option<u32>,
}

/// What a morph target adds to attributes.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(super) struct Target {
    pub(super) position: Option<u32>,
    pub(super) normal: Option<u32>,
}

/// A skeleton.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    pub(super) inverse_bind_matrices: Option<u32>,
    /// Nodes.
    #[serde(default)]
    pub(super) joints: Box<[u32]>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Animation<'a> {
    pub(super) name: Option<Box<str>>,
    #[serde(borrow, default)]
    pub(super) channels: Box<[Channel<'a>]>,
    #[serde(borrow, default)]
    pub(super) samplers: Box<[AnimationSampler<'a>]>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Channel<'a> {
    pub(super) sampler: u32,
    #[serde(borrow)]
    pub(super) target: ChannelTarget<'a>,
}

/// What a channel moves: of a node, `translation`, `rotation`, `scale` or `weights`.
#[derive(Debug, Deserialize)]
pub(super) struct ChannelTarget<'a> {
    pub(super) node: Option<u32>,
    #[serde(borrow)]
    pub(super) path: Cow<'a, str>,
}

/// Keys: accessors of their times and values.
#[derive(Debug, Deserialize)]
pub(super) struct AnimationSampler<'a> {
    pub(super) input: u32,
    pub(super) output: u32,
    #[serde(borrow)]
    pub(super) interpolation: Option<Cow<'a, str>>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor<'a> {
    pub(super) buffer_view: Option<u32>,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: u64,
    #[serde(borrow, rename = "type")]
    pub(super) kind: Cow<'a, str>,
    pub(super) sparse: Option<Box<Sparse>>,
}

/// Elements that replace some of an accessor's.
#[derive(Debug, Deserialize)]
pub(super) struct Sparse {
    pub(super) count: u64,
    pub(super) indices: SparseIndices,
    pub(super) values: SparseValues,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub(super) buffer_view: u32,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub(super) buffer_view: u32,
    #[serde(default)]
    pub(super) byte_offset: u64,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: u32,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer<'a> {
    #[serde(borrow)]
    pub(super) uri: Option<Cow<'a, str>>,
    pub(super) byte_length: u64,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material<'a> {
    pub(super) name: Option<Box<str>>,
    pub(super) pbr_metallic_roughness: Option<Box<MetallicRoughness>>,
    pub(super) normal_texture: Option<NormalTexture>,
    pub(super) occlusion_texture: Option<IgnoredAny>,
    pub(super) emissive_texture: Option<TextureInfo>,
    #[serde(default)]
    pub(super) emissive_factor: [f32; 3],
    #[serde(borrow)]
    pub(super) alpha_mode: Option<Cow<'a, str>>,
    pub(super) alpha_cutoff: Option<f32>,
    #[serde(default)]
    pub(super) double_sided: bool,
    pub(super) extensions: Option<Box<MaterialExtensions>>,
    #[serde(borrow)]
    pub(super) extras: Option<&'a RawValue>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct MetallicRoughness {
    pub(super) base_color_factor: [f32; 4],
    pub(super) base_color_texture: Option<TextureInfo>,
    pub(super) metallic_factor: f32,
    pub(super) roughness_factor: f32,
    pub(super) metallic_roughness_texture: Option<TextureInfo>,
}

impl Default for MetallicRoughness {
    fn default() -> MetallicRoughness {
        MetallicRoughness {
            base_color_factor: [1.0; 4],
            base_color_texture: None,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            metallic_roughness_texture: None,
        }
    }
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub(super) emissive_strength: Option<EmissiveStrength>,
    #[serde(rename = "KHR_materials_unlit")]
    pub(super) unlit: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_ior")]
    pub(super) ior: Option<Ior>,
    #[serde(rename = "KHR_materials_specular")]
    pub(super) specular: Option<Specular>,
    #[serde(rename = "KHR_materials_transmission")]
    pub(super) transmission: Option<Transmission>,
    #[serde(rename = "KHR_materials_volume")]
    pub(super) volume: Option<Volume>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Transmission {
    #[serde(default)]
    pub(super) transmission_factor: f32,
    pub(super) transmission_texture: Option<IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Volume {
    #[serde(default)]
    pub(super) thickness_factor: f32,
    #[serde(default = "white")]
    pub(super) attenuation_color: [f32; 3],
    pub(super) attenuation_distance: Option<f32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    #[serde(default = "one")]
    pub(super) emissive_strength: f32,
}

#[derive(Debug, Deserialize)]
pub(super) struct Ior {
    #[serde(default = "Ior::glass")]
    pub(super) ior: f32,
}

impl Ior {
    fn glass() -> f32 {
        Dielectric::GLASS
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Specular {
    #[serde(default = "one")]
    pub(super) specular_factor: f32,
    #[serde(default = "white")]
    pub(super) specular_color_factor: [f32; 3],
    pub(super) specular_texture: Option<IgnoredAny>,
    pub(super) specular_color_texture: Option<IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub(super) index: u32,
    #[serde(default)]
    pub(super) tex_coord: u32,
    pub(super) extensions: Option<TextureExtensions>,
}

#[derive(Debug, Deserialize)]
pub(super) struct NormalTexture {
    #[serde(flatten)]
    pub(super) info: TextureInfo,
    #[serde(default = "one")]
    pub(super) scale: f32,
}

#[derive(Debug, Deserialize)]
pub(super) struct TextureExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(super) transform: Option<TextureTransform>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureTransform {
    #[serde(default)]
    pub(super) offset: [f32; 2],
    #[serde(default)]
    pub(super) rotation: f32,
    #[serde(default = "TextureTransform::whole")]
    pub(super) scale: [f32; 2],
    pub(super) tex_coord: Option<u32>,
}

impl TextureTransform {
    fn whole() -> [f32; 2] {
        [1.0; 2]
    }
}

#[derive(Debug, Deserialize)]
pub(super) struct Texture {
    pub(super) sampler: Option<u32>,
    pub(super) source: Option<u32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image<'a> {
    pub(super) name: Option<Box<str>>,
    #[serde(borrow)]
    pub(super) uri: Option<Cow<'a, str>>,
    pub(super) buffer_view: Option<u32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Sampler {
    pub(super) wrap_s: Option<u32>,
    pub(super) wrap_t: Option<u32>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Camera<'a> {
    pub(super) name: Option<Box<str>>,
    pub(super) perspective: Option<Perspective>,
    pub(super) orthographic: Option<Orthographic>,
    #[serde(borrow)]
    pub(super) extras: Option<&'a RawValue>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Perspective {
    /// Full vertical angle, radians.
    pub(super) yfov: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Orthographic {
    /// Half the height of the image.
    pub(super) ymag: f64,
}

/// A light of `KHR_lights_punctual`.
#[derive(Debug, Deserialize)]
pub(super) struct Light<'a> {
    pub(super) name: Option<Box<str>>,
    #[serde(borrow, default, rename = "type")]
    pub(super) kind: Cow<'a, str>,
    pub(super) color: Option<Box<[f64; 3]>>,
    pub(super) intensity: Option<f64>,
    pub(super) spot: Option<Box<Spot>>,
    #[serde(borrow)]
    pub(super) extras: Option<&'a RawValue>,
}

/// A cone by its half-angles, radians.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Spot {
    pub(super) inner_cone_angle: f64,
    pub(super) outer_cone_angle: f64,
}

impl Default for Spot {
    fn default() -> Spot {
        Spot { inner_cone_angle: 0.0, outer_cone_angle: std::f64::consts::FRAC_PI_4 }
    }
}

fn one() -> f32 {
    1.0
}

fn white() -> [f32; 3] {
    [1.0; 3]
}
