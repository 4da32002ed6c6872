//! Which triangles rays, segments and regions meet.
//!
//! [`accel`] has the acceleration structures, the tests of triangles, instances, and the alpha test; [`simd`] the vectors of eight lanes that
//! they are written with. `.cuh` files next to the Rust files are their twins for CUDA devices, which hold copies of the structures.

pub mod accel;
pub mod simd;
pub mod textures;

/// Parts for tests. They are no interface: they change with any release.
#[doc(hidden)]
pub mod internals {
    pub use crate::accel::alpha_mask::between;
    pub use crate::accel::bvh::build::{Child, LEVELS, Work, children, depth, extent, planes, tree};
    pub use crate::accel::deduplicate::deduplicate;
    pub use crate::accel::grid::distance::spread;
    pub use crate::accel::grid::file::{HEADER, Header, TRAILER, decode};
    pub use crate::accel::grid::overlap::triangle_meets_box;
}
