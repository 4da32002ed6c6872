//! Why a mesh cannot get smooth normals.

use lightmesh_memory::Short;

/// Why a mesh cannot get normals.
#[derive(Debug)]
pub enum Unsmooth {
    /// They need more memory than there is.
    Memory(Short),
    /// Its corners, or the vertices that it would have, have no 32-bit indices.
    TooMany,
}

impl From<Short> for Unsmooth {
    fn from(short: Short) -> Unsmooth {
        Unsmooth::Memory(short)
    }
}
