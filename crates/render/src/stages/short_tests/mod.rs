//! Step 2: which light points does each surface point see? Formula (2).
//!
//! In: rays and hits. Out: [`Masks`]. Light point k of the template belongs to the half-ball D(P, r) of surface point P when
//!
//! 1. |x − P| < r,
//! 2. (n, x − P) > ε h (see [`LightMesh::least_height`]),
//! 3. no triangle stands between P and x, by [`ShortTest`](lightmesh_trace::accel::ShortTest).
//!
//! Surface points are grouped by light-mesh cell, because all points of a cell share their template, its positions and the
//! triangles that can matter. [`cells`] uses that; [`plain`] queries the acceleration structure segment by segment and is the
//! reference: both give the same masks in every bit, and so do their twins on a CUDA device (`by_cell.cuh`, `plain.cuh`).

pub(crate) mod batch;
pub(crate) mod cells;
pub(crate) mod cpu;
pub(crate) mod cuda;
pub(crate) mod plain;

#[cfg(doc)]
use crate::light_mesh::LightMesh;

/// Counts from the computation of masks.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MaskCounts {
    /// Light points in the half-balls, before visibility.
    pub half_ball: u64,
    /// Light points in the masks.
    pub used: u64,
    /// Segments that were tested against triangles.
    pub tested: u64,
}

impl std::ops::Add for MaskCounts {
    type Output = MaskCounts;

    fn add(self, other: MaskCounts) -> MaskCounts {
        MaskCounts {
            half_ball: self.half_ball + other.half_ball,
            used: self.used + other.used,
            tested: self.tested + other.tested,
        }
    }
}
