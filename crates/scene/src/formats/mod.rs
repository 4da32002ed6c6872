//! One module per file format; each produces triangles, lights and cameras of a [`Draft`](crate::draft::Draft). Shared code is
//! next to them: reading text, triangulating polygons, and turning corners into vertices.

mod colors;
pub(crate) mod gltf;
mod notes;
pub(crate) mod obj;
pub(crate) mod ply;
mod polygon;
pub(crate) mod stl;
mod text;
pub(crate) mod toml;
mod vertices;
