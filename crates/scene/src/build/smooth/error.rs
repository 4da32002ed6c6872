//! Why a mesh cannot get smooth normals.

use lightmesh_memory::OverBudget;

/// Why a mesh cannot get normals.
#[derive(Debug)]
pub enum Unsmooth {
    /// They need more memory than there is.
    Memory(OverBudget),
    /// Its corners, or the vertices that it would have, have no 32-bit indices.
    TooMany,
}

impl From<OverBudget> for Unsmooth {
    fn from(short: OverBudget) -> Unsmooth {
        Unsmooth::Memory(short)
    }
}
