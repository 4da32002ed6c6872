//! How a scene is made of parts: collected in world coordinates, checked, and put into a local frame.

pub(crate) mod builder;
pub(crate) mod draft;
pub(crate) mod error;
pub(crate) mod file_access;
mod flatten;
pub(crate) mod geometry_check;
mod instances;
mod load_options;
pub(crate) mod loaded_mesh;
pub(crate) mod mesh_part;
mod other_programs;
pub(crate) mod placement;
pub(crate) mod quote;
pub(crate) mod sanitize;
mod scene_format;
pub(crate) mod shapes;
pub(crate) mod smooth;
pub(crate) mod textures;
pub(crate) mod vertices;
pub(crate) mod warnings;

pub use builder::SceneBuilder;
pub use error::{LoadError, Place};
pub use geometry_check::{GeometryError, is_affine};
pub use load_options::LoadOptions;
pub use mesh_part::MeshPart;
pub use scene_format::SceneFormat;
pub use smooth::CreaseAngle;
