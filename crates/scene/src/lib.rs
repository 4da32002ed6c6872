//! What a scene is, and how one is read. No rendering happens here.
//!
//! A [`Scene`] is what every loader and generator returns: opaque triangles with materials, lights, cameras and the
//! ambient term of the shading model, all in one coordinate frame. One file format lives in one module under `formats`, and
//! each ends in `-> Scene`.
//!
//! # Coordinates
//!
//! Right-handed. Files are read in double precision and stored as `f32` relative to [`Scene::origin`], a point near the
//! geometry: a scene that lies a hundred kilometres from the world's origin keeps the precision that it has at home.
#![warn(missing_docs)]

mod builder;
pub mod builtin;
mod camera;
mod draft;
mod error;
mod export;
mod formats;
mod framing;
mod info;
mod light;
mod loaded_mesh;
mod material;
mod mesh;
mod open;
mod scene;
mod shapes;
mod texture;
mod up;
mod usable;
mod vertices;

pub use builder::{MeshPart, SceneBuilder};
pub use camera::{Camera, Fov, Projection};
pub use error::{LoadError, Place};
pub use export::ExportError;
pub use framing::UnknownCamera;
pub use info::{BoundsInfo, CameraInfo, LightInfo, SceneInfo};
pub use light::{Falloff, Light, LightKind};
pub use material::Material;
pub use mesh::{Bounds, Mesh};
pub use open::LoadOptions;
pub use scene::{LightMeshDefaults, Scene, Weight};
pub use texture::{Texture, TextureUse, Wrap};
pub use up::{Up, UpInfo};
pub use vertices::{OwnedPositions, Position, Positions};
