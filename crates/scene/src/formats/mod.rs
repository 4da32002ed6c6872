//! One file format in one module; each ends in triangles, lights and cameras of a [`Draft`](crate::draft::Draft).

pub(crate) mod gltf;
pub(crate) mod obj;
pub(crate) mod toml;
