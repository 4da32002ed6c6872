//! Shadows of lights with a size, from each surface point on its own: the reference.
//!
//! In: rays and hits. Out: [`Visibility`](crate::data::visibility::Visibility). All triangles in the shaft from a surface point to a light
//! are found, and each is asked which samples it hides (`crate::shadow::occlusion`).

pub(crate) mod cpu;
pub(crate) mod cuda;
