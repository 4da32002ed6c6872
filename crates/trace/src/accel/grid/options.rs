//! What grids can be asked for, and why one cannot be built.

use lightmesh_memory::{Budget, OverBudget};

/// How a grid is laid out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GridOptions {
    /// Cells on each axis; `None`: chosen by the number of triangles.
    pub dims: Option<[u32; 3]>,
    /// One level or two.
    pub levels: Levels,
    /// The memory that may be used.
    pub budget: Budget,
}

/// Number of levels of a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Levels {
    /// One grid.
    One,
    /// Cells with many triangles contain a nested grid.
    #[default]
    Two,
}

/// Why a grid cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GridError {
    /// An axis without cells.
    #[error("a grid of {}x{}x{} cells has no cells: every axis needs at least 1", dims[0], dims[1], dims[2])]
    NoCells {
        /// The requested cells.
        dims: [u32; 3],
    },
    /// Out of proportion to the triangles, or offsets would not fit 32 bits.
    #[error(
        "a grid of {}x{}x{} cells needs {needed} {what}, more than the {most} that are allowed: use fewer cells or the BVH",
        dims[0], dims[1], dims[2]
    )]
    TooLarge {
        /// Cells on each axis.
        dims: [u32; 3],
        /// What there is too much of.
        what: &'static str,
        /// How many are needed, at least.
        needed: u64,
        /// How many are allowed.
        most: u64,
    },
    /// Not enough memory.
    #[error("there is not enough memory for a grid of {}x{}x{} cells: {short}; use fewer cells or the BVH", dims[0], dims[1], dims[2])]
    Memory {
        /// Cells on each axis.
        dims: [u32; 3],
        /// Bytes needed and left.
        short: OverBudget,
    },
}
