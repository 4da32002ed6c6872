//! Scenes through the public interface, and parts of the crate by themselves.

mod builtin_files;
mod instances;
mod objects;
mod parts;
mod shared_gltf;
mod shared_scenes;
mod shared_views;
mod walker;
