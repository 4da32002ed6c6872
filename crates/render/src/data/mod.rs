//! What stages hand to each other on the host. The types of CUDA devices lie in [`gpu`](crate::gpu).
//!
//! One file a type: rays and the surface points that they see, surface points by cell, masks, what light points see, visibility, and
//! pictures in the making. [`Wave`] is what every stage works on.

pub(crate) mod cells;
pub(crate) mod lit;
pub(crate) mod masks;
pub(crate) mod picture;
pub(crate) mod rays;
pub(crate) mod visibility;
pub(crate) mod wave;
