//! One module per file format; each produces triangles, lights and cameras of a [`Draft`](crate::build::draft::Draft). Shared code is
//! next to them: reading text, triangulating polygons, and turning corners into vertices.

pub(crate) mod gltf;
mod models;
pub(crate) mod notes;
pub(crate) mod obj;
mod open;
mod panorama;
pub(crate) mod ply;
pub(crate) mod polygon;
pub(crate) mod stl;
pub(crate) mod text;
pub(crate) mod toml;
pub(crate) mod vertices;

pub use panorama::EnvironmentError;
