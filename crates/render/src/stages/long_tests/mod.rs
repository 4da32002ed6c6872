//! Step 4: which lights does each light point see?
//!
//! In: the used light points. Out: [`Lit`]. A point light, a spot or a directional light is seen or not: one bit. Of a light
//! with a size a light point sees a share, found with a few stratified rays of its own.

pub(crate) mod cpu;
pub(crate) mod cuda;
#[cfg(test)]
mod tests;
