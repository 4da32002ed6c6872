//! What a scene is: geometry, materials, lights, cameras, what surrounds them, and how they move.

pub(crate) mod animation;
mod bounds;
pub(crate) mod camera;
pub(crate) mod colors;
mod dielectric;
pub(crate) mod environment;
mod facets;
mod geometry;
pub(crate) mod instances;
pub(crate) mod light;
mod lights;
mod material;
mod mesh;
mod names;
mod objects;
mod opacity;
pub mod packed;
pub(crate) mod placed;
mod positions;
mod scene;
mod texture;
pub(crate) mod transforms;
mod up;

pub use animation::Animation;
pub use bounds::Bounds;
pub use camera::{Camera, CameraError, Fov, Projection};
pub use dielectric::Dielectric;
pub use environment::{
    Environment, EnvironmentLevel, Moment, Sky, SkyError, SkyKind, Sun, SunError, SunPosition, Surroundings,
};
pub use facets::Facets;
pub use geometry::Geometry;
pub use instances::{Affine, FIRST_INSTANCED, Instance, Instances, Instancing};
pub use light::{Falloff, Light, LightError, LightKind};
pub use lights::Lights;
pub use material::Material;
pub use mesh::Mesh;
pub use names::UnknownName;
pub use objects::{ObjectKey, Objects, UNNAMED};
pub use opacity::{Opacity, OpacityChannel, OpacityMode};
pub use positions::{OwnedPositions, Position, Positions};
pub use scene::{Empty, LightMeshDefaults, Scene, Weight};
pub use texture::{NormalMap, Texture, TextureUse, Textures, Wrap};
pub use up::Up;
