//! Conversions of what surfaces do with light: materials of other models, their images, and surfaces that emit light.

pub(crate) mod heights;
pub(crate) mod lamps;
pub(crate) mod packed;
pub(crate) mod principled;

pub use principled::Principled;
