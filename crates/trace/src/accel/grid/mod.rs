//! The regular grid of the thesis (chapters 3.2 and 4.1), one level or two.
//!
//! Everything lies in one array of integers and one of triangles:
//!
//! ```text
//! <grid>   ::= nx ny nz <offset>…          nx·ny·nz offsets from the start of the array, x fastest
//! <offset> ::= −1 (empty) | offset of a <cell>
//! <cell>   ::= −(number of triangles) (offset into triangles) | <grid>
//! ```
//!
//! so a cell's first number tells a leaf (negative) from a nested grid (positive). Triangles are repeated for every cell that
//! they meet: neighbours in a cell are neighbours in memory.
//!
//! * `lattice`: where cells lie, and by how much they are enlarged so that rounding cannot lose a hit.
//! * `overlap`: the exact test of a triangle against a box.
//! * `build`: triangles to cells; `walk`: along a ray (Amanatides, Woo 1987); `search`: by a region; `file`: saved and loaded.
//! * `distance`: how far each cell is from the nearest non-empty one, for walks on devices.

mod build;
pub(crate) mod distance;
pub(crate) mod file;
mod hash;
mod lattice;
pub(crate) mod overlap;
mod search;
mod walk;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use fearless_simd::Level;
use lightmesh_memory::{Budget, Short};

use super::approach::{Approach, overlap};
use super::visit::{All, Any, Closest};
use super::{Accelerator, Coverage, Form, Hit, Ray, Region, ShortSegments, Take, Triangle};
use crate::simd::dispatch;
pub use file::{GridFault, GridFileError, GridSaveError};
pub use hash::geometry_hash;
use lattice::Lattice;

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
        short: Short,
    },
}

/// A regular grid of triangles.
#[derive(Debug)]
pub struct Grid {
    lattice: Lattice,
    margin: f32,
    /// The flat nested form.
    cells: Arc<[i32]>,
    /// The triangles of all cells, one cell after the other.
    triangles: Arc<[Triangle]>,
    /// The position of each in the list that the grid was built from.
    sources: Arc<[u32]>,
    approach: Approach,
    coverage: Coverage,
    /// Hash of the list that the grid was built from.
    geometry: u64,
    /// Length of that list.
    built_from: u32,
    overruns: AtomicU64,
}

impl Grid {
    /// Sorts the usable triangles into cells, one of identical ones.
    ///
    /// # Errors
    ///
    /// If the requested grid has no cells, or too many for so few triangles or for 32-bit offsets.
    pub fn new(triangles: &[Triangle], options: &GridOptions) -> Result<Grid, GridError> {
        build::build(triangles, options)
    }

    /// The opacities of triangles that are cut out.
    #[doc(hidden)]
    pub fn with_coverage(self, coverage: &Coverage) -> Grid {
        Grid { coverage: coverage.clone(), ..self }
    }

    /// Cells on each axis of the outer grid.
    pub fn dims(&self) -> [u32; 3] {
        self.lattice.dims.to_array()
    }

    /// How many walks took more steps than a grid of this size allows and tested all triangles instead. Always 0, unless the
    /// bound that `walk` derives is wrong.
    pub fn overruns(&self) -> u64 {
        self.overruns.load(Ordering::Relaxed)
    }

    /// The flat nested form.
    pub fn cells(&self) -> &[i32] {
        &self.cells
    }

    /// The triangles of all cells.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The triangles that it holds, each once, in the order of the list that it was built from.
    #[doc(hidden)]
    pub fn held(&self) -> Vec<Triangle> {
        let mut held: Vec<(u32, &Triangle)> = self.sources.iter().copied().zip(self.triangles.iter()).collect();
        held.sort_unstable_by_key(|(source, _)| *source);
        held.dedup_by_key(|(source, _)| *source);
        held.into_iter().map(|(_, triangle)| *triangle).collect()
    }

    /// Number of triangles in all cells: one in several counts for each.
    #[doc(hidden)]
    pub fn references(&self) -> usize {
        self.triangles.len()
    }

    /// Lowest corner of the outer grid, and edges of its cells.
    #[doc(hidden)]
    pub fn geometry(&self) -> (glam::DVec3, glam::Vec3) {
        (self.lattice.origin, self.lattice.size)
    }

    /// By how much cells were enlarged when triangles were sorted into them.
    pub fn margin(&self) -> f32 {
        self.margin
    }

    /// For each of its triangles, where that was among those it was built over.
    #[doc(hidden)]
    pub fn sources(&self) -> &[u32] {
        &self.sources
    }

    /// Centre and radius of the sphere of interest.
    pub fn approach(&self) -> (glam::Vec3, f32) {
        self.approach.parts()
    }

    /// The lowest corner of a cell of the outer grid.
    #[doc(hidden)]
    pub fn corner(&self, cell: [u32; 3]) -> glam::Vec3 {
        self.lattice.corner(cell.into()).as_vec3()
    }

    fn count_overrun(&self) {
        self.overruns.fetch_add(1, Ordering::Relaxed);
    }

    /// Reads one cell of the grid that begins at `base`.
    #[inline(always)]
    fn cell(&self, base: usize, index: usize) -> Cell<'_> {
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
enum Cell<'a> {
    Empty,
    Leaf(&'a [Triangle]),
    Nested { base: usize, dims: [u32; 3] },
}

impl Accelerator for Grid {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (hit, ray) in hits.iter_mut().zip(rays) {
            *hit = self.approach.ray(ray).map_or(Hit::MISS, |near| {
                let mut closest = Closest::new(&near, &self.coverage);
                self.walk(near.origin, near.direction, &mut closest);
                near.finish(closest.best)
            });
        }
    }

    fn all_hits(&self, rays: &[Ray], take: &mut dyn FnMut(usize, &[Hit])) {
        let mut hits = Vec::new();
        for (number, ray) in rays.iter().enumerate() {
            let Some(near) = self.approach.ray(ray) else { continue };
            let mut all = All::new(&near, &self.coverage, &mut hits);
            self.walk(near.origin, near.direction, &mut all);
            all.finish(&near, |hits| take(number, hits));
        }
    }

    fn occluded(&self, segments: &[Ray], occluded: &mut [bool]) {
        for (occluded, segment) in occluded.iter_mut().zip(segments) {
            *occluded = self.approach.ray(segment).is_some_and(|near| {
                let mut any = Any::new(&near, &self.coverage);
                self.walk(near.origin, near.direction, &mut any);
                any.hit
            });
        }
    }

    fn short_segments(&self, segments: &ShortSegments, blocked: &mut [bool]) {
        // The segments are short and leave one point: the cells around all of them are roughly those that each would visit.
        let mut triangles: Vec<&Triangle> = Vec::new();
        let bounds = segments.region();
        self.visit_region(&Region::within(bounds), &mut |cell| {
            triangles.extend(cell.iter().filter(|triangle| overlap(&triangle.bounds(), &bounds)));
        });
        triangles.sort_unstable_by_key(|triangle| triangle.index());
        triangles.dedup_by_key(|triangle| triangle.index());
        segments.ask(triangles.into_iter(), blocked);
    }

    fn search(&self, region: &Region, take: Take) {
        dispatch!(Level::new(), simd => search::search(simd, self, region, take));
    }

    fn covered_by(&self, coverage: &Coverage) -> Box<dyn Accelerator> {
        Box::new(Grid {
            cells: Arc::clone(&self.cells),
            triangles: Arc::clone(&self.triangles),
            sources: Arc::clone(&self.sources),
            coverage: coverage.clone(),
            overruns: 0.into(),
            ..*self
        })
    }

    fn name(&self) -> &'static str {
        "grid"
    }

    fn form(&self) -> Form<'_> {
        Form::Grid(self)
    }

    fn memory(&self) -> usize {
        size_of_val(&*self.cells) + size_of_val(&*self.triangles) + size_of_val(&*self.sources)
    }
}
