//! The light mesh: a lattice of light points in space, the template that lists which of them a surface point may use, and the
//! sparse store that contains only what an image touches.
//!
//! A *cell* (i, j, k) is the cube whose lowest corner is *light point* (i, j, k): cells and points share one numbering.

pub(crate) mod auto_step;
pub(crate) mod bricks;
pub(crate) mod cell_points;
mod lattice;
mod lattice_error;
mod mesh;
mod template;
pub(crate) mod window;

pub(crate) use auto_step::auto_step;
pub use bricks::{BrickKey, BrickMap, PointKey, UsedPoints, brick_of, point_bit, point_key, point_of};
pub(crate) use bricks::{bits, brick_hash};
pub(crate) use cell_points::{CellPoints, sum_in_both, sum_of_products};
pub use lattice::Lattice;
pub use lattice_error::LatticeError;
pub use mesh::LightMesh;
pub use template::{Template, TemplateError};
pub(crate) use window::{Span, Windows, window_bricks};
