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
//! * `cells`: these arrays; `options`: what grids can be asked for.
//! * `lattice`: where cells lie, and by how much they are enlarged so that rounding cannot lose a hit.
//! * `overlap`: the exact test of a triangle against a box.
//! * `build`: triangles to cells; `walk`: along a ray (Amanatides, Woo 1987); `search`: by a region; `file`: saved and loaded.
//! * `distance`: how far each cell is from the nearest non-empty one, for walks on devices.

mod build;
mod cells;
pub(crate) mod distance;
pub(crate) mod file;
mod hash;
mod lattice;
mod options;
pub(crate) mod overlap;
mod search;
mod walk;

use std::sync::Arc;

use fearless_simd::Level;

use super::ray_clamp::overlap;
use super::visit::{All, Any, Closest};
use super::{Accelerator, AcceleratorKind, AlphaMask, ChunkSink, Hit, Ray, Region, ShortSegments, Triangle};
use crate::simd::dispatch;
pub use cells::Grid;
pub use file::{GridFault, GridFileError, GridSaveError};
pub use hash::geometry_hash;
pub use options::{GridError, GridOptions, Levels};

impl Grid {
    /// Sorts the usable triangles into cells, one of identical ones.
    ///
    /// # Errors
    ///
    /// If the requested grid has no cells, or too many for so few triangles or for 32-bit offsets.
    pub fn new(triangles: &[Triangle], options: &GridOptions) -> Result<Grid, GridError> {
        build::build(triangles, options)
    }
}

impl Accelerator for Grid {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (hit, ray) in hits.iter_mut().zip(rays) {
            *hit = self.ray_clamp.ray(ray).map_or(Hit::MISS, |near| {
                let mut closest = Closest::new(&near, &self.alpha_mask);
                self.walk(near.origin, near.direction, &mut closest);
                near.finish(closest.best)
            });
        }
    }

    fn all_hits(&self, rays: &[Ray], take: &mut dyn FnMut(usize, &[Hit])) {
        let mut hits = Vec::new();
        for (number, ray) in rays.iter().enumerate() {
            let Some(near) = self.ray_clamp.ray(ray) else { continue };
            let mut all = All::new(&near, &self.alpha_mask, &mut hits);
            self.walk(near.origin, near.direction, &mut all);
            all.finish(&near, |hits| take(number, hits));
        }
    }

    fn occluded(&self, segments: &[Ray], occluded: &mut [bool]) {
        for (occluded, segment) in occluded.iter_mut().zip(segments) {
            *occluded = self.ray_clamp.ray(segment).is_some_and(|near| {
                let mut any = Any::new(&near, &self.alpha_mask);
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

    fn search(&self, region: &Region, take: ChunkSink) {
        dispatch!(Level::new(), simd => search::search(simd, self, region, take));
    }

    fn masked_by(&self, alpha_mask: &AlphaMask) -> Box<dyn Accelerator> {
        Box::new(Grid {
            cells: Arc::clone(&self.cells),
            triangles: Arc::clone(&self.triangles),
            sources: Arc::clone(&self.sources),
            alpha_mask: alpha_mask.clone(),
            overruns: 0.into(),
            ..*self
        })
    }

    fn name(&self) -> &'static str {
        "grid"
    }

    fn kind(&self) -> AcceleratorKind<'_> {
        AcceleratorKind::Grid(self)
    }

    fn memory(&self) -> usize {
        size_of_val(&*self.cells) + size_of_val(&*self.triangles) + size_of_val(&*self.sources)
    }
}
