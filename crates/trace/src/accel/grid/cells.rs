//! The cells of a grid in their flat form, and the triangles in them.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, Vec3};

use super::lattice::Lattice;
use crate::accel::ray_clamp::RayClamp;
use crate::accel::{AlphaMask, Triangle};

/// A regular grid of triangles.
#[derive(Debug)]
pub struct Grid {
    pub(super) lattice: Lattice,
    pub(super) margin: f32,
    /// The flat nested form.
    pub(super) cells: Arc<[i32]>,
    /// The triangles of all cells, one cell after the other.
    pub(super) triangles: Arc<[Triangle]>,
    /// The position of each in the list that the grid was built from.
    pub(super) sources: Arc<[u32]>,
    pub(super) ray_clamp: RayClamp,
    pub(super) alpha_mask: AlphaMask,
    /// Hash of the list that the grid was built from.
    pub(super) geometry: u64,
    /// Length of that list.
    pub(super) built_from: u32,
    pub(super) overruns: AtomicU64,
}

impl Grid {
    /// The opacities of triangles that are cut out.
    #[doc(hidden)]
    #[inline]
    pub fn with_alpha_mask(self, alpha_mask: &AlphaMask) -> Grid {
        Grid { alpha_mask: alpha_mask.clone(), ..self }
    }

    /// Cells on each axis of the outer grid.
    #[inline]
    pub fn dims(&self) -> [u32; 3] {
        self.lattice.dims.to_array()
    }

    /// How many walks took more steps than a grid of this size allows and tested all triangles instead. Always 0, unless the
    /// bound that `walk` derives is wrong.
    #[inline]
    pub fn overruns(&self) -> u64 {
        self.overruns.load(Ordering::Relaxed)
    }

    /// The flat nested form.
    #[inline]
    pub fn cells(&self) -> &[i32] {
        &self.cells
    }

    /// The triangles of all cells.
    #[inline]
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The triangles that it holds, each once, in the order of the list that it was built from.
    #[doc(hidden)]
    #[inline]
    pub fn held(&self) -> Vec<Triangle> {
        let mut held: Vec<(u32, &Triangle)> = self.sources.iter().copied().zip(self.triangles.iter()).collect();
        held.sort_unstable_by_key(|(source, _)| *source);
        held.dedup_by_key(|(source, _)| *source);
        held.into_iter().map(|(_, triangle)| *triangle).collect()
    }

    /// Number of triangles in all cells: one in several counts for each.
    #[doc(hidden)]
    #[inline]
    pub fn references(&self) -> usize {
        self.triangles.len()
    }

    /// Lowest corner of the outer grid, and edges of its cells.
    #[doc(hidden)]
    #[inline]
    pub fn geometry(&self) -> (DVec3, Vec3) {
        (self.lattice.origin, self.lattice.size)
    }

    /// By how much cells were enlarged when triangles were sorted into them.
    #[inline]
    pub fn margin(&self) -> f32 {
        self.margin
    }

    /// For each of its triangles, where that was among those it was built over.
    #[doc(hidden)]
    #[inline]
    pub fn sources(&self) -> &[u32] {
        &self.sources
    }

    /// Centre and radius of the sphere of interest.
    #[inline]
    pub fn ray_clamp(&self) -> (Vec3, f32) {
        self.ray_clamp.parts()
    }

    /// The lowest corner of a cell of the outer grid.
    #[doc(hidden)]
    #[inline]
    pub fn corner(&self, cell: [u32; 3]) -> Vec3 {
        self.lattice.corner(cell.into()).as_vec3()
    }

    #[inline]
    pub(super) fn count_overrun(&self) {
        self.overruns.fetch_add(1, Ordering::Relaxed);
    }

    /// Reads one cell of the grid that begins at `base`.
    #[inline(always)]
    pub(super) fn cell(&self, base: usize, index: usize) -> Cell<'_> {
        let offset = self.cells[base + 3 + index];
        if offset < 0 {
            return Cell::Empty;
        }
        let offset = offset as usize;
        let count = self.cells[offset];
        if count < 0 {
            let first = self.cells[offset + 1] as usize;
            return Cell::Leaf(&self.triangles[first..first + count.unsigned_abs() as usize]);
        }
        let dims = [count as u32, self.cells[offset + 1] as u32, self.cells[offset + 2] as u32];
        Cell::Nested { base: offset, dims }
    }
}

/// What a cell holds.
pub(super) enum Cell<'a> {
    Empty,
    Leaf(&'a [Triangle]),
    Nested { base: usize, dims: [u32; 3] },
}
