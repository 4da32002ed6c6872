//! Textures of a scene that is being read.

pub(crate) mod decode;
pub(crate) mod files;
pub(crate) mod missing_uvs;
