//! From triangles to cells: find the pairs of cell and triangle, sort them by cell, write the flat form.

use glam::{DVec3, UVec3, Vec3};
use lightmesh_scene::Bounds;
use rayon::prelude::*;

use super::cells::Grid;
use super::hash::geometry_hash;
use super::lattice::{Lattice, cells_between, margin};
use super::options::{GridError, GridOptions, Levels};
use super::overlap::triangle_meets_box;
use crate::accel::deduplicate::deduplicate;
use crate::accel::ray_clamp::RayClamp;
use crate::accel::{AlphaMask, Triangle};

/// Cells per triangle, if there is one level.
const DENSITY: f64 = 8.0;
/// Cells of the outer grid per triangle, if there are two levels.
const OUTER_DENSITY: f64 = 0.5;
/// Cells per triangle of a nested grid.
const INNER_DENSITY: f64 = 4.0;
/// A cell with more triangles than this becomes a grid.
const MANY: usize = 8;
/// Most cells along an axis that are chosen automatically: smaller cells would be dominated by the margin.
const MOST: [f64; 2] = [1024.0, 32.0];
/// How many cells a triangle's box may overlap on average before an automatic grid is made coarser: one number per level.
const COPIES: [u64; 2] = [32, 16];
/// The same for both levels together: where triangles are large, nested grids would repeat them once more.
const ALL_COPIES: u64 = 64;
/// Most cells of the outer grid: 512 on each axis.
const MAX_CELLS: u64 = 1 << 27;
/// Most cells that a ray may cross, the sum of those along the axes: a millisecond for each of a million rays would be too long.
const MAX_CROSSED: u64 = 1 << 14;
/// Most references that a requested grid may need: a second's work, or this many per triangle.
const MAX_REFERENCES: u64 = 1 << 24;
const MAX_COPIES: u64 = 256;
/// Bytes that a cell takes while the grid is built: where its list begins, twice, and its integer in a vector that grows.
const CELL_BYTES: u64 = 2 * 8 + 2 * 4;
/// Bytes that a reference takes at most: with its cell, sorted, and in the flat form with a copy of its triangle.
const REFERENCE_BYTES: u64 = 16 + 4 + 2 * 4 + size_of::<Triangle>() as u64;
/// Triangles that one task sorts into cells.
const TASK: usize = 2048;

pub(super) fn build(triangles: &[Triangle], options: &GridOptions) -> Result<Grid, GridError> {
    let usable = deduplicate(triangles);
    let bounds = Bounds::around(usable.iter().flat_map(|&at| triangles[at as usize].corners()));
    let density = if options.levels == Levels::One { DENSITY } else { OUTER_DENSITY };
    let mut sorter = Sorter { triangles, inner_copies: COPIES[1], margin: margin(RayClamp::new(&bounds).radius()) };
    let dims = match options.dims {
        Some(dims) => dims.into(),
        None => {
            let dims = automatic(&bounds, density * usable.len() as f64, MOST[0]);
            sorter.coarsened(dims, &usable, COPIES[0], |dims| Lattice::new(&bounds, sorter.margin, dims))
        }
    };
    let (lattice, ray_clamp, margin) = frame(&bounds, dims)?;
    let most = MAX_REFERENCES.max(MAX_COPIES * usable.len() as u64);
    let candidates = sorter.candidates(&lattice, &usable);
    bounded(candidates, most, "triangle references", dims)?;
    let needed = lattice.len() as u64 * CELL_BYTES + candidates * REFERENCE_BYTES;
    options.budget.check(needed).map_err(|short| GridError::Memory { dims: dims.to_array(), short })?;

    let lists = sorter.sort(&lattice, &usable);
    sorter.inner_copies = (ALL_COPIES * usable.len() as u64 / lists.sources.len().max(1) as u64).clamp(1, COPIES[1]);
    let nested = |cell: usize| {
        let list = lists.of(cell);
        let many = options.levels == Levels::Two && list.len() > MANY;
        many.then(|| sorter.nested(&lattice, cell, list)).flatten().map(|nested| (cell, nested))
    };
    let nested: Vec<(usize, Nested)> = (0..lattice.len()).into_par_iter().filter_map(nested).collect();
    let (cells, sources) = Writer::write(&lattice, &lists, &nested)?;
    Ok(Grid {
        triangles: sources.iter().map(|&at| triangles[at as usize]).collect(),
        geometry: geometry_hash(triangles),
        built_from: triangles.len() as u32,
        overruns: 0.into(),
        alpha_mask: AlphaMask::default(),
        lattice,
        margin,
        cells: cells.into(),
        sources: sources.into(),
        ray_clamp,
    })
}

/// Where the cells lie. A loaded grid must get the same frame.
pub(super) fn frame(bounds: &Bounds, dims: UVec3) -> Result<(Lattice, RayClamp, f32), GridError> {
    let cells = dims.to_array().map(u128::from).iter().product::<u128>();
    if cells == 0 {
        return Err(GridError::NoCells { dims: dims.to_array() });
    }
    bounded(u64::try_from(cells).unwrap_or(u64::MAX), MAX_CELLS, "cells", dims)?;
    let crossed = dims.to_array().map(u64::from).iter().sum();
    bounded(crossed, MAX_CROSSED, "cells on the way of a ray", dims)?;
    let ray_clamp = RayClamp::new(bounds);
    let margin = margin(ray_clamp.radius());
    let bounds = if bounds.is_empty() { Bounds::around([Vec3::ZERO]) } else { *bounds };
    Ok((Lattice::new(&bounds, margin, dims), ray_clamp, margin))
}

fn bounded(needed: u64, most: u64, what: &'static str, dims: UVec3) -> Result<(), GridError> {
    if needed <= most { Ok(()) } else { Err(GridError::TooLarge { dims: dims.to_array(), what, needed, most }) }
}

/// An offset of the flat form.
fn fit(needed: u64, what: &'static str, dims: UVec3) -> Result<i32, GridError> {
    bounded(needed, i32::MAX as u64, what, dims).map(|()| needed as i32)
}

/// About `wanted` cells that are nearly cubes: the largest cube edge that yields that many.
fn automatic(bounds: &Bounds, wanted: f64, most: f64) -> UVec3 {
    let extent = bounds.extent().as_dvec3();
    let longest = extent.max_element();
    if longest == 0.0 {
        return UVec3::ONE;
    }
    let dims = |share: f64| (extent / (longest * share)).ceil().clamp(DVec3::ONE, DVec3::splat(most));
    let (mut fine, mut coarse) = (1.0 / most, 1.0);
    for _ in 0..20 {
        let middle = 0.5 * (fine + coarse);
        if dims(middle).element_product() > wanted { fine = middle } else { coarse = middle }
    }
    dims(coarse).as_uvec3()
}

/// Positions of triangles, cell by cell.
struct Lists {
    /// Where each cell's list begins; one more than there are cells.
    starts: Vec<usize>,
    sources: Vec<u32>,
}

impl Lists {
    fn of(&self, cell: usize) -> &[u32] {
        &self.sources[self.starts[cell]..self.starts[cell + 1]]
    }
}

struct Nested {
    lattice: Lattice,
    lists: Lists,
}

/// Sorts triangles into the cells that they overlap.
struct Sorter<'a> {
    triangles: &'a [Triangle],
    margin: f32,
    /// How many cells of a nested grid a triangle's box may overlap on average.
    inner_copies: u64,
}

impl Sorter<'_> {
    /// `dims`, made fewer until triangles that span many cells no longer dominate.
    fn coarsened(&self, mut dims: UVec3, sources: &[u32], copies: u64, lattice: impl Fn(UVec3) -> Lattice) -> UVec3 {
        while dims != UVec3::ONE && self.candidates(&lattice(dims), sources) > copies * sources.len() as u64 {
            dims = (dims * 3 / 4).max(UVec3::ONE);
        }
        dims
    }

    /// Pairs of a triangle and a cell whose boxes overlap: at least as many as there will be references.
    fn candidates(&self, lattice: &Lattice, sources: &[u32]) -> u64 {
        let cells = |&source: &u32| {
            let range = lattice.cells(&self.triangles[source as usize].bounds(), self.margin);
            range.map_or(0, |(first, last)| (last - first + 1).as_u64vec3().element_product())
        };
        sources.iter().map(cells).fold(0, u64::saturating_add)
    }

    /// The triangles at `sources`, grouped by cell; each list is in the order of `sources`.
    fn sort(&self, lattice: &Lattice, sources: &[u32]) -> Lists {
        let tasks = sources.par_chunks(TASK);
        let pairs: Vec<Vec<(usize, u32)>> = tasks.map(|sources| self.pairs(lattice, sources)).collect();
        let mut starts = vec![0; lattice.len() + 1];
        for (cell, _) in pairs.iter().flatten() {
            starts[cell + 1] += 1;
        }
        for cell in 0..lattice.len() {
            starts[cell + 1] += starts[cell];
        }
        let mut ends = starts.clone();
        let mut sorted = vec![0; starts[lattice.len()]];
        for &(cell, source) in pairs.iter().flatten() {
            sorted[ends[cell]] = source;
            ends[cell] += 1;
        }
        Lists { starts, sources: sorted }
    }

    fn pairs(&self, lattice: &Lattice, sources: &[u32]) -> Vec<(usize, u32)> {
        let margin = f64::from(self.margin);
        let half = 0.5 * lattice.size.as_dvec3() + margin;
        let mut pairs = Vec::new();
        for &source in sources {
            let triangle = &self.triangles[source as usize];
            let Some((first, last)) = lattice.cells(&triangle.bounds(), self.margin) else { continue };
            let corners = triangle.corners();
            pairs.extend(
                cells_between(first, last)
                    .filter(|&cell| {
                        let center = lattice.corner(cell) + 0.5 * lattice.size.as_dvec3();
                        first == last || triangle_meets_box(corners, center, half)
                    })
                    .map(|cell| (lattice.index(cell), source)),
            );
        }
        pairs
    }

    /// The grid within a cell; `None` if it would not separate its triangles.
    fn nested(&self, outer: &Lattice, cell: usize, list: &[u32]) -> Option<Nested> {
        let at = position(outer, cell);
        let bounds = Bounds { min: Vec3::ZERO, max: outer.size };
        let dims = automatic(&bounds, INNER_DENSITY * list.len() as f64, MOST[1]);
        let dims = self.coarsened(dims, list, self.inner_copies, |dims| outer.nested(at, dims));
        let lattice = outer.nested(at, dims);
        // Cells no larger than their margins separate nothing.
        let useful = lattice.size.min_element() > 8.0 * self.margin && dims != UVec3::ONE;
        useful.then(|| Nested { lists: self.sort(&lattice, list), lattice })
    }
}

fn position(lattice: &Lattice, cell: usize) -> UVec3 {
    let (x, y) = (lattice.dims.x as usize, lattice.dims.y as usize);
    UVec3::new((cell % x) as u32, (cell / x % y) as u32, (cell / x / y) as u32)
}

/// Writes the flat form.
struct Writer {
    dims: UVec3,
    cells: Vec<i32>,
    sources: Vec<u32>,
}

impl Writer {
    fn write(lattice: &Lattice, lists: &Lists, nested: &[(usize, Nested)]) -> Result<(Vec<i32>, Vec<u32>), GridError> {
        let mut writer = Writer { dims: lattice.dims, cells: Vec::new(), sources: Vec::new() };
        writer.grid(lattice, lists, nested)?;
        Ok((writer.cells, writer.sources))
    }

    /// Writes a grid; `nested` are those in its cells, in order.
    fn grid(&mut self, lattice: &Lattice, lists: &Lists, nested: &[(usize, Nested)]) -> Result<(), GridError> {
        let mut nested = nested.iter().peekable();
        let base = self.cells.len();
        self.cells.extend(lattice.dims.to_array().map(|count| count as i32));
        self.cells.resize(base + 3 + lattice.len(), -1);
        for cell in 0..lattice.len() {
            let list = lists.of(cell);
            if list.is_empty() {
                continue;
            }
            self.cells[base + 3 + cell] = fit(self.cells.len() as u64, "integers", self.dims)?;
            match nested.next_if(|(at, _)| *at == cell) {
                Some((_, nested)) => self.grid(&nested.lattice, &nested.lists, &[])?,
                None => self.leaf(list)?,
            }
        }
        fit(self.cells.len() as u64, "integers", self.dims).map(|_| ())
    }

    fn leaf(&mut self, list: &[u32]) -> Result<(), GridError> {
        let first = fit(self.sources.len() as u64, "triangle references", self.dims)?;
        fit((self.sources.len() + list.len()) as u64, "triangle references", self.dims)?;
        self.cells.extend([-(list.len() as i32), first]);
        self.sources.extend(list);
        Ok(())
    }
}
