mod decode;
mod files;
mod heights;
mod missing_uvs;
mod packed;
