//! One file format in one module; each ends in triangles, lights and cameras of a [`Draft`](crate::draft::Draft). Beside them is
//! what several formats share: reading text, cutting polygons, making vertices of corners.

mod colors;
pub(crate) mod gltf;
pub(crate) mod obj;
pub(crate) mod ply;
mod polygon;
pub(crate) mod stl;
mod text;
pub(crate) mod toml;
mod vertices;
