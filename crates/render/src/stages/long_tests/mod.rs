//! Step 4: which lights does each light point see?
//!
//! In: the used light points. Out: [`LightPointVisibility`]. A point light, a spot or a directional light is visible or not: one bit. Of an area
//! light a light point sees a share, estimated with a few stratified rays of its own.

pub(crate) mod cpu;
pub(crate) mod cuda;
