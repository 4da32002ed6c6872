//! The search for all triangles that meet a region, cell by cell.
//!
//! A triangle that meets the region has a point in it, and is listed in every cell within the [margin](super::lattice) of that point.
//! Cells are computed in double precision from a box around the region or, if that may be far larger than the region, from boxes
//! around its parts in layers of cells. These parts are clipped in single precision, so layers overlap by one rounding.

use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use glam::UVec3;

use super::cells::{Cell, Grid};
use super::lattice::{Lattice, cells_between};
use crate::accel::region_filter::{ChunkSink, RegionFilter};
use crate::accel::{Hit, Region, Triangle};

/// A triangle that lies in several cells is mostly found once: so many are remembered.
const RECENT: usize = 256;

/// Hands over the triangles of the region's cells whose bounding boxes it may meet.
#[simd]
pub(super) fn search<S: Simd>(simd: S, grid: &Grid, region: &Region, take: ChunkSink) {
    let mut leaves = Vec::new();
    grid.visit_region(region, &mut |triangles| leaves.push(triangles));
    let mut filter = RegionFilter::new(simd, region, take);
    let mut recent = [Hit::NONE; RECENT];
    for &triangles in &leaves {
        for triangle in triangles {
            let before = &mut recent[triangle.index() as usize % RECENT];
            if std::mem::replace(before, triangle.index()) != triangle.index() && !filter.take(triangle) {
                return;
            }
        }
    }
    filter.finish();
}

impl Grid {
    /// Calls `visit` with the triangles of every cell that the region may meet; some come several times.
    pub(super) fn visit_region<'a>(&'a self, region: &Region, visit: &mut impl FnMut(&'a [Triangle])) {
        self.visit_grid(&self.lattice, 0, region, visit);
    }

    /// The same for the grid that begins at `base`.
    fn visit_grid<'a>(
        &'a self,
        lattice: &Lattice,
        base: usize,
        region: &Region,
        visit: &mut impl FnMut(&'a [Triangle]),
    ) {
        let Some((first, last)) = lattice.cells(region.bounds(), self.margin) else { return };
        if !region.is_slanted() {
            return self.visit_cells(lattice, base, [first, last], region, visit);
        }
        let span = last - first;
        let axis = if span.x >= span.y && span.x >= span.z { 0 } else { 1 + usize::from(span.z > span.y) };
        for layer in first[axis]..=last[axis] {
            let (low, high) = planes_of(lattice, axis, layer);
            if let Some((mut first, mut last)) = lattice.cells(&region.between(axis, low, high), self.margin) {
                (first[axis], last[axis]) = (layer, layer);
                self.visit_cells(lattice, base, [first, last], region, visit);
            }
        }
    }

    /// Visits the cells of a box of cells of the grid that begins at `base`.
    fn visit_cells<'a>(
        &'a self,
        lattice: &Lattice,
        base: usize,
        [first, last]: [UVec3; 2],
        region: &Region,
        visit: &mut impl FnMut(&'a [Triangle]),
    ) {
        for cell in cells_between(first, last) {
            match self.cell(base, lattice.index(cell)) {
                Cell::Empty => {}
                Cell::Leaf(triangles) => visit(triangles),
                Cell::Nested { base, dims } => self.visit_grid(&lattice.nested(cell, dims.into()), base, region, visit),
            }
        }
    }
}

/// The planes before and behind a layer of cells, rounded outward.
fn planes_of(lattice: &Lattice, axis: usize, layer: u32) -> (f32, f32) {
    let plane = |number: f64| (lattice.origin[axis] + f64::from(lattice.size[axis]) * number) as f32;
    (plane(f64::from(layer)).next_down(), plane(f64::from(layer) + 1.0).next_up())
}
