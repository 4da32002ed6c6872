//! One module per file format; each produces triangles, lights and cameras of a [`Draft`](crate::draft::Draft). Shared code is
//! next to them: reading text, triangulating polygons, and turning corners into vertices.

pub(crate) mod colors;
pub(crate) mod gltf;
pub(crate) mod notes;
pub(crate) mod obj;
pub(crate) mod ply;
pub(crate) mod polygon;
pub(crate) mod stl;
pub(crate) mod text;
pub(crate) mod toml;
pub(crate) mod vertices;
