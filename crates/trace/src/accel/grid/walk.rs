//! The walk along a ray through the cells. Amanatides, Woo: *A Fast Voxel Traversal Algorithm for Ray Tracing* (1987).
//!
//! Crossing parameters are computed from the planes at each step, not accumulated, so that their error does not grow. Each step
//! advances one cell on one axis and never goes back: a grid of nx × ny × nz cells is left after at most nx + ny + nz − 2 cells.
//! By rounding, a ray may reach the border of a nested grid before it leaves the cell that contains that grid; then it stays in
//! its cell, once on each axis. The loop is bounded by nx + ny + nz + 1; should that bound ever be reached, all triangles are
//! tested and the event is counted, see [`Grid::overruns`].
//!
//! A triangle may be met in one cell and hit in a later one. The walk therefore keeps the best hit and ends only when that lies
//! before the exit from the current cell.

use glam::{IVec3, UVec3, Vec3};
use lightmesh_layout::constants::MIN_COMPONENT;

use super::cells::{Cell, Grid};
use crate::accel::visit::Visitor;

/// How a walk through one grid ended.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// The walk left the grid: there may be more to find.
    Left,
    /// There is nothing more to find.
    Done,
    /// The bound on the number of steps was reached.
    Overrun,
}

/// A ray relative to the lowest corner of a grid, and that grid's cells.
#[derive(Clone, Copy)]
struct March {
    origin: Vec3,
    direction: Vec3,
    /// Reciprocal direction; zero on axes on which the ray does not move.
    inverse: Vec3,
    size: Vec3,
    dims: UVec3,
}

impl March {
    /// The existing cell nearest to where the ray is at `t`.
    #[inline(always)]
    fn cell(&self, t: f32) -> [i32; 3] {
        let cell = (self.origin + t * self.direction) / self.size;
        let last = self.dims.as_vec3() - 1.0;
        // If nothing is negative, truncation equals the floor, and is faster.
        cell.max(Vec3::ZERO).min(last).as_ivec3().to_array()
    }

    /// One cell ahead on each axis.
    #[inline(always)]
    fn step(&self) -> [i32; 3] {
        let onward = |inverse: f32| if inverse > 0.0 { 1 } else { -1 };
        [onward(self.inverse.x), onward(self.inverse.y), onward(self.inverse.z)]
    }

    /// Where the ray leaves `cell` on one axis; infinite if it does not move.
    #[inline(always)]
    fn crossing(&self, axis: usize, cell: i32) -> f32 {
        let inverse = self.inverse[axis];
        if inverse == 0.0 {
            return f32::INFINITY;
        }
        let plane = self.size[axis] * (cell + i32::from(inverse > 0.0)) as f32;
        (plane - self.origin[axis]) * inverse
    }

    /// Where the ray enters the box of all cells, not before its origin; `None` if it misses the box.
    fn enter(&self) -> Option<f32> {
        let extent = self.size * self.dims.as_vec3();
        let (mut enter, mut leave) = (0.0f32, f32::INFINITY);
        for axis in 0..3 {
            let (origin, inverse) = (self.origin[axis], self.inverse[axis]);
            if inverse == 0.0 {
                if origin < 0.0 || origin > extent[axis] {
                    return None;
                }
                continue;
            }
            let (low, high) = (-origin * inverse, (extent[axis] - origin) * inverse);
            enter = enter.max(low.min(high));
            leave = leave.min(low.max(high));
        }
        (enter <= leave).then_some(enter)
    }

    /// The same ray in the grid nested in a cell.
    #[inline(always)]
    fn nested(&self, [x, y, z]: [i32; 3], dims: [u32; 3]) -> March {
        let cell = IVec3::new(x, y, z).as_vec3();
        let dims = UVec3::from(dims);
        March { origin: self.origin - self.size * cell, size: self.size / dims.as_vec3(), dims, ..*self }
    }
}

impl Grid {
    /// Visits the triangles of all cells along the ray up to the visitor's limit.
    pub(super) fn walk(&self, origin: Vec3, direction: Vec3, visitor: &mut impl Visitor) {
        let still = direction.abs().cmplt(Vec3::splat(MIN_COMPONENT * direction.abs().max_element()));
        let march = March {
            origin: (origin.as_dvec3() - self.lattice.origin).as_vec3(),
            direction: Vec3::select(still, Vec3::ZERO, direction),
            inverse: Vec3::select(still, Vec3::ZERO, direction.recip()),
            size: self.lattice.size,
            dims: self.lattice.dims,
        };
        let Some(enter) = march.enter() else { return };
        if self.march::<0>(&march, 0, enter, f32::INFINITY, visitor) == Outcome::Overrun {
            self.count_overrun();
            self.ask_all(visitor);
        }
    }

    #[cold]
    fn ask_all(&self, visitor: &mut impl Visitor) {
        let _ = self.triangles.iter().all(|triangle| visitor.triangle(triangle));
    }

    /// Walks the grid that begins at `base`, from parameter `enter` on, until it is left or `leave` is passed.
    #[inline(always)]
    fn march<const LEVEL: u32>(
        &self,
        march: &March,
        base: usize,
        enter: f32,
        leave: f32,
        visitor: &mut impl Visitor,
    ) -> Outcome {
        // 1. The first cell, and where the ray leaves it on each axis.
        let dims = march.dims.as_ivec3().to_array();
        let step = march.step();
        let mut cell = march.cell(enter);
        let mut next = [march.crossing(0, cell[0]), march.crossing(1, cell[1]), march.crossing(2, cell[2])];
        let mut enter = enter;
        for _ in 0..=march.dims.as_u64vec3().element_sum() {
            // 2. The nearest of the three planes ahead.
            let axis = if next[0] <= next[1] && next[0] <= next[2] {
                0
            } else if next[1] <= next[2] {
                1
            } else {
                2
            };
            let exit = next[axis].min(leave);

            // 3. Test what the cell holds.
            let index = (cell[2] as usize * dims[1] as usize + cell[1] as usize) * dims[0] as usize + cell[0] as usize;
            match self.cell(base, index) {
                Cell::Empty => {}
                Cell::Leaf(triangles) => {
                    for triangle in triangles {
                        if !visitor.triangle(triangle) {
                            return Outcome::Done;
                        }
                    }
                }
                Cell::Nested { base, dims } => {
                    let outcome = self.inner(&march.nested(cell, dims), base, enter, exit, LEVEL, visitor);
                    if outcome != Outcome::Left {
                        return outcome;
                    }
                }
            }

            // 4. Can nothing beyond this cell matter?
            if visitor.limit() <= exit {
                return Outcome::Done;
            }
            if exit >= leave {
                return Outcome::Left;
            }

            // 5. Step into the next cell.
            let onward = cell[axis] + step[axis];
            if (0..dims[axis]).contains(&onward) {
                cell[axis] = onward;
                next[axis] = march.crossing(axis, onward);
            } else if LEVEL == 0 {
                return Outcome::Left;
            } else {
                // The border of the outer cell, which the ray has not reached yet.
                next[axis] = f32::INFINITY;
            }
            enter = enter.max(exit);
        }
        Outcome::Overrun
    }

    /// The walk through a nested grid; grids nested deeper than two levels are neither built nor loaded.
    #[inline(never)]
    fn inner(
        &self,
        march: &March,
        base: usize,
        enter: f32,
        leave: f32,
        level: u32,
        visitor: &mut impl Visitor,
    ) -> Outcome {
        if level == 0 { self.march::<1>(march, base, enter, leave, visitor) } else { Outcome::Overrun }
    }
}
