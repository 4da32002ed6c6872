// The walk along a ray through the cells of a grid: twin of walk.rs, skipping empty space.
//
// # Theory
//
// Coordinates are cells of the grid, mirrored so that the ray ascends on every axis. Where it crosses plane p of an axis is
// computed from p alone, never accumulated: t(p) = p · inverse + start.
//
// An empty cell of the outer grid knows the distance to the nearest cell that holds something: all cells less than that many cells
// away, on any axis, are empty. So the walk skips to where the ray leaves this cube: on one axis its cell is known; on the others
// it follows from the position, but never lies before the previous one. A cell at distance 1, or one that holds something, is left
// by an ordinary step. Each step advances on at least one axis, so that a grid of nx × ny × nz cells is left after fewer than
// nx + ny + nz steps. Should that bound ever be reached, all triangles are tested and the event is counted.
//
// # How far the walk can err
//
// In units of ε S, as in lattice.rs: a reported hit lies up to 9 outside its triangle; the origin relative to the corner is rounded
// by 1, in cells by 2, mirrored by 1; a crossing errs by 5 along the ray, 2 more in a nested grid, whose planes are off by 1; a
// cell that follows from a position, which errs by 5, may be entered too soon by as much (too late does no harm: it is left at
// once); a component that is raised moves the ray by less than 1. Together that is less than the 32 by which cells are enlarged.
#pragma once

#include "accel/grid/march.cuh"
#include "accel/visit.cuh"
#include "cuda/tally.cuh"

// A walk in progress.
struct GridWalk {
    March march;
    // The grid that it is in, its cell there, and the ray parameter at which the ray entered it. The parameter does not follow from
    // the cell: by rounding, a cell may be entered before its planes are crossed.
    Cells cells;
    Vec3 cell;
    float t;
    // Where the grid is left, or the visitor's limit if that comes first.
    float stop;
    // Whether the walk is in a nested grid, and in which cell of the outer one.
    bool nested;
    Vec3 outer;
    // Steps left; if none are, something is wrong.
    unsigned steps;
};

// 1. Begins at the first cell; false if the ray misses the grid. If the walk cannot handle the numbers, it has no steps.
DEVICE bool begin_walk(const Grid &grid, const March &march, float limit, GridWalk &walk) {
    walk.steps = 0;
    if (!can_march(march, grid.dims))
        return true;
    const Vec3 dims = to_float(grid.dims);
    walk.march = march;
    walk.cells = cells_of(march, march.inverse, march.start, 0, grid.dims);
    const float leave = leave_grid(march.inverse, march.start, dims);
    walk.stop = fminf(leave, limit);
    walk.t = fmaxf(fmaxf(march.start.x, march.start.y), fmaxf(march.start.z, 0.0f));
    walk.cell = cell_at(walk.t, march.start, march.speed, splat(0.0f), dims - splat(1.0f));
    walk.nested = false;
    walk.steps = grid.dims[0] + grid.dims[1] + grid.dims[2];
    return walk.t <= leave;
}

// Continues within the grid nested in the current cell; false if it cannot.
DEVICE bool enter_nested(const Grid &grid, GridWalk &walk, int offset, float limit) {
    const unsigned dims[3] = {(unsigned)__ldg(grid.cells + offset), (unsigned)__ldg(grid.cells + offset + 1),
                              (unsigned)__ldg(grid.cells + offset + 2)};
    if (walk.nested || !few_cells(dims))
        return false;
    const March &march = walk.march;
    const Vec3 start = crossing(walk.cell + splat(1.0f), march.inverse, march.start);
    const Vec3 n = to_float(dims);
    walk.stop = fminf(fminf(start.x, fminf(start.y, start.z)), limit);
    walk.outer = walk.cell;
    walk.cells = numbered_down(cells_of(march, march.inverse / n, start, offset + 3, dims), dims);
    walk.cell = cell_at(walk.t, start, march.speed * n, -n, splat(-1.0f));
    walk.nested = true;
    walk.steps += dims[0] + dims[1] + dims[2];
    return true;
}

// Back in the outer grid.
DEVICE void leave_nested(const Grid &grid, GridWalk &walk, float limit) {
    const March &march = walk.march;
    walk.cells = cells_of(march, march.inverse, march.start, 0, grid.dims);
    walk.cell = walk.outer;
    walk.stop = fminf(leave_grid(march.inverse, march.start, to_float(grid.dims)), limit);
    walk.nested = false;
}

// Besides offsets: the cell is empty; the ray ends; the walk cannot continue.
enum Content { NOTHING = -1, END = -2, LOST = -3 };

// 2. The offset of what the current cell holds; or that it holds nothing, and how many cells ahead something may be.
DEVICE int look(const Grid &grid, const GridWalk &walk, float &ahead) {
    ahead = 1.0f;
    if (walk.steps == 0)
        return LOST;
    const unsigned place = place_of(walk.cells, walk.cell);
    if (walk.nested)
        return __ldg(grid.cells + place);
    const unsigned distance = __ldg(grid.distances + place);
    if (distance == 0)
        return __ldg(grid.cells + 3 + place);
    ahead = (float)distance;
    return NOTHING;
}

// 3. Steps into the next cell, or past all that are less than `ahead` cells away; false if nothing beyond can matter.
DEVICE bool step(const Grid &grid, GridWalk &walk, float ahead, float limit) {
    Vec3 planes, next;
    float exit;
    while (true) {
        // a. The nearest of the three planes ahead.
        planes = walk.cell + splat(ahead);
        next = crossing(planes, walk.cells.inverse, walk.cells.start);
        exit = fminf(next.x, fminf(next.y, next.z));
        if (exit < walk.stop)
            break;
        // b. The end, or the end of a nested grid; then the step is one in the outer grid.
        if (!walk.nested)
            return false;
        leave_nested(grid, walk, limit);
        ahead = 1.0f;
    }
    // c. On the other axes, a skip may pass several planes.
    walk.t = fmaxf(walk.t, exit);
    if (ahead > 1.0f)
        walk.cell = cell_at(walk.t, walk.march.start, walk.march.speed, walk.cell, to_float(grid.dims) - splat(1.0f));
    walk.cell.x = next.x == exit ? planes.x : walk.cell.x;
    walk.cell.y = next.y == exit ? planes.y : walk.cell.y;
    walk.cell.z = next.z == exit ? planes.z : walk.cell.z;
    --walk.steps;
    return true;
}

// Visits the triangles of all cells along the ray up to the visitor's limit.
//
// If TOGETHER, all rays of a warp walk on until each has found something, and then examine it at the same time: faster if what is
// met first is mostly what is hit. Otherwise, rays that have found something examine it while the others wait.
template <bool TOGETHER, class Visitor>
DEVICE void walk_cells(const Grid &grid, const Tally &tally, const Ray &ray, Visitor &visitor) {
    GridWalk walk;
    if (!begin_walk(grid, march_of(grid, ray), limit(visitor), walk))
        return;
    while (true) {
        float ahead;
        int found = look(grid, walk, ahead);
        if (TOGETHER)
            while (found == NOTHING)
                found = step(grid, walk, ahead, limit(visitor)) ? look(grid, walk, ahead) : END;
        if (found == END)
            return;
        Run run = {0, 0};
        if (found >= 0) {
            const int head = __ldg(grid.cells + found), first = __ldg(grid.cells + found + 1);
            run = Run{(unsigned)first, (unsigned)(first - head)};
            if (head >= 0) {
                if (enter_nested(grid, walk, found, limit(visitor)))
                    continue;
                found = LOST;
            }
        }
        if (found == LOST) {
            atomicAdd(&tally_shard(tally).overruns, 1ull);
            run = Run{0, grid.triangle_count};
        }
        if (found != NOTHING) {
            if (!ask(visitor, grid, run) || found == LOST)
                return;
            walk.stop = fminf(walk.stop, limit(visitor));
        }
        if (!step(grid, walk, TOGETHER ? 1.0f : ahead, limit(visitor)))
            return;
    }
}

DEVICE void walk(const Grid &grid, const Tally &tally, const Ray &ray, Closest &closest) {
    walk_cells<true>(grid, tally, ray, closest);
}

DEVICE void walk(const Grid &grid, const Tally &tally, const Ray &ray, Any &any) { walk_cells<false>(grid, tally, ray, any); }
