//! The scene model, and how scenes are read. No rendering happens here.
//!
//! A [`Scene`] is what every loader and generator returns: [`Geometry`] (triangles with materials and textures, opaque or cut out), [`Lights`] and
//! cameras, all in one coordinate frame. Modules are storeys; each imports those before it alone:
//!
//! 1. `model`: what a scene is.
//! 2. `optics`: materials of other models, and lights for surfaces that emit light.
//! 3. `build`: how a scene is made of parts, in world coordinates until its frame is known.
//! 4. `staging`: the view, lights and ground that a picture needs and a file may lack. [`builtin`]: scenes that are generated.
//! 5. `formats`: one module for each file format, each ending in `-> Scene`.
//! 6. `export`: what is written, and what is told about a scene.
//!
//! # Coordinates
//!
//! Right-handed. Files are read in double precision and stored as `f32` relative to [`Geometry::origin`], a point near the geometry: a
//! scene a hundred kilometres from the world's origin keeps the precision that it would have at the origin.
#![warn(missing_docs)]

mod build;
pub mod builtin;
mod export;
mod formats;
#[doc(hidden)]
pub mod internals;
mod model;
mod optics;
mod staging;

/// The vector and matrix types of this crate's API.
pub use glam;

pub use build::{
    CreaseAngle, GeometryError, LoadError, LoadOptions, MeshPart, Place, SceneBuilder, SceneFormat, is_affine,
};
pub use export::{AnimationInfo, BoundsInfo, CameraInfo, ExportError, LightInfo, SceneInfo};
pub use formats::EnvironmentError;
#[doc(hidden)]
pub use model::packed;
pub use model::{
    Affine, Animation, Bounds, Camera, CameraError, Dielectric, Empty, Environment, EnvironmentLevel, FIRST_INSTANCED,
    Facets, Falloff, Fov, Geometry, Instance, Instances, Instancing, Light, LightError, LightKind, LightMeshDefaults,
    Lights, Material, Mesh, Moment, NormalMap, ObjectKey, Objects, Opacity, OpacityChannel, OpacityMode,
    OwnedPositions, Position, Positions, Projection, Scene, Sky, SkyError, SkyKind, Sun, SunError, SunPosition,
    Surroundings, Texture, TextureUse, Textures, UNNAMED, UnknownName, Up, Weight, Wrap,
};
pub use optics::Principled;
pub use staging::{Added, Lighting, UnknownCamera, UpInfo, Viewpoint};
