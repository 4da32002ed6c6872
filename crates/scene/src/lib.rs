//! The scene model, and how scenes are read. No rendering happens here.
//!
//! A [`Scene`] is what every loader and generator returns: [`Geometry`] (triangles with materials and textures, opaque or cut out), [`Lights`] and
//! cameras, all in one coordinate frame. Each file format is one module under `formats`, and each ends in `-> Scene`.
//!
//! # Coordinates
//!
//! Right-handed. Files are read in double precision and stored as `f32` relative to [`Geometry::origin`], a point near the geometry: a
//! scene a hundred kilometres from the world's origin keeps the precision that it would have at the origin.
#![warn(missing_docs)]

mod animation;
mod border;
mod builder;
pub mod builtin;
mod camera;
mod dielectric;
mod draft;
mod environment;
mod error;
mod export;
mod facets;
mod formats;
mod framing;
mod geometry;
mod geometry_check;
mod ground;
mod info;
mod instances;
#[doc(hidden)]
pub mod internals;
mod lamps;
mod light;
mod lights;
mod loaded_mesh;
mod material;
mod mesh;
mod mesh_part;
mod names;
mod objects;
mod opacity;
mod open;
mod outdoors;
mod principled;
mod quote;
mod scene;
mod scene_format;
mod shapes;
mod smooth;
mod studio;
mod texture;
mod up;
mod usable;
mod vertices;
mod warnings;

/// The vector and matrix types of this crate's API.
pub use glam;

pub use animation::Animation;
pub use builder::SceneBuilder;
pub use camera::{Camera, CameraError, Fov, Projection};
pub use dielectric::Dielectric;
pub use environment::{
    Environment, EnvironmentError, EnvironmentLevel, Moment, Sky, SkyError, SkyKind, Sun, SunError, SunPosition,
    Surroundings,
};
pub use error::{LoadError, Place};
pub use export::ExportError;
pub use facets::Facets;
pub use framing::{Added, Lighting, UnknownCamera, Viewpoint};
pub use geometry::Geometry;
pub use geometry_check::GeometryError;
pub use info::{AnimationInfo, BoundsInfo, CameraInfo, LightInfo, SceneInfo};
pub use instances::{Affine, FIRST_INSTANCED, Instance, Instances, Instancing};
pub use light::{Falloff, Light, LightError, LightKind};
pub use lights::Lights;
pub use material::Material;
pub use mesh::{Bounds, Mesh};
pub use mesh_part::MeshPart;
pub use names::UnknownName;
pub use objects::{Objects, UNNAMED};
pub use opacity::{Opacity, OpacityChannel, OpacityMode};
pub use open::LoadOptions;
pub use principled::Principled;
pub use scene::{LightMeshDefaults, Scene, Weight};
pub use scene_format::SceneFormat;
pub use smooth::CreaseAngle;
pub use texture::{NormalMap, Texture, TextureUse, Textures, Wrap};
pub use up::{Up, UpInfo};
pub use vertices::{OwnedPositions, Position, Positions};
