//! The data that stages pass to each other on the host. The types for CUDA devices are in [`gpu`](crate::gpu).
//!
//! One file per type: rays and the surface points that they see, surface points by cell, masks, visibility at light points, visibility
//! at surface points, and images being rendered. [`Wave`] is what every stage works on.

pub(crate) mod bundles;
pub(crate) mod cells;
pub(crate) mod clip;
pub(crate) mod light_point_visibility;
pub(crate) mod lights;
pub(crate) mod masks;
pub(crate) mod mattes;
pub(crate) mod picture;
pub(crate) mod rays;
pub(crate) mod samples;
pub(crate) mod visibility;
pub(crate) mod wave;
