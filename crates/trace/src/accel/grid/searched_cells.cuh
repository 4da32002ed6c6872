// Which cells of a grid a search by region looks at: of the outer grid, and of those nested in its cells.
//
// # How far it can err
//
// In units of ε r as in lattice.rs, where the scene is 2 r wide and a triangle is listed in every cell that comes within 320 of it.
// The twin computes cells in double precision. Here the corners of a box, relative to the grid's, are rounded once, by 2; multiplied
// with the rounded reciprocal of a cell's edge, by 4 more; and for a nested grid with its number of cells, once the outer cell is taken
// off, by 4 more; planes of cells by 2. That is less than 16. So where a point of a triangle lies in the region, a cell is looked at
// that comes within 16 of the point, and therefore lists the triangle.
//
// The box of a cell, or of cells in a row, is in world coordinates, which are below S = |corner| + extent of the grid. It is rounded by
// less than 8 ε S, and enlarged on each side by the margin and 32 ε S. So it holds the point, and leaves the 16 ε of its edges that
// tangent planes ask for. The layers of a slanted region lie between the planes of these boxes.
#pragma once

#include "accel/region.cuh"

// Numbers of the cells of a box of cells, x fastest.
struct CellBox {
    // The first cell on each axis, and how many there are.
    int x, y, z;
    unsigned width, height, depth;
};

// What is searched of a grid. The same for all lanes: it is kept in shared memory.
struct GridFrame {
    // The part of the region that is searched, in cells of the outer grid, and these cells.
    Bounds part;
    CellBox cells;
    // World coordinates of the lowest corner of the grid, and by how much boxes of cells are enlarged.
    Vec3 corner, grow;
    unsigned spare[2];
};

static_assert(sizeof(GridFrame) == 4 * GRID_FRAME_WORDS, "words that describe what is searched of a grid");

DEVICE unsigned cells_of_axis(float low, float high, unsigned dims, int &first) {
    first = max(__float2int_rd(low), 0);
    return (unsigned)max(min(__float2int_rd(high), (int)dims - 1) - first + 1, 0);
}

// The cells that a box meets.
DEVICE CellBox cell_box(const Bounds &box, const unsigned (&dims)[3]) {
    CellBox cells;
    cells.width = cells_of_axis(box.low.x, box.high.x, dims[0], cells.x);
    cells.height = cells_of_axis(box.low.y, box.high.y, dims[1], cells.y);
    cells.depth = cells_of_axis(box.low.z, box.high.z, dims[2], cells.z);
    return cells;
}

DEVICE unsigned count_of(const CellBox &cells) { return cells.width * cells.height * cells.depth; }

// The cell of a number.
DEVICE IVec3 cell_of(const CellBox &cells, unsigned number) {
    const unsigned row = number / cells.width;
    return IVec3{cells.x + (int)(number - row * cells.width), cells.y + (int)(row % cells.height),
                 cells.z + (int)(row / cells.height)};
}

// Bounds in cells of the outer grid.
DEVICE Bounds in_cells(const Grid &grid, const Bounds &bounds) {
    const Vec3 inverse = {1.0f / grid.size.x, 1.0f / grid.size.y, 1.0f / grid.size.z};
    return Bounds{to_single(to_double(bounds.low) - grid.origin) * inverse,
                  to_single(to_double(bounds.high) - grid.origin) * inverse};
}

// By how much boxes of cells are enlarged.
DEVICE Vec3 growth(const Grid &grid) {
    const Vec3 extent = grid.size * Vec3{(float)grid.dims[0], (float)grid.dims[1], (float)grid.dims[2]};
    return 2.0f * REGION_ROUNDING * (abs(to_single(grid.origin)) + extent) + splat(grid.margin);
}

// Whether the region may meet the box of some cells.
template <class RegionShape>
DEVICE bool meets_cells(const Region<RegionShape> &region, const GridFrame &frame, const Vec3 &corner, const Vec3 &size,
                        const Vec3 &first, const Vec3 &end) {
    return meets(region, corner + size * first - frame.grow, corner + size * end + frame.grow, 0.0f);
}

// A grid nested in a cell.
struct NestedGrid {
    // World coordinates of the lowest corner, and edges of a cell.
    Vec3 corner, size;
    unsigned width, height;
    // Where its cells are.
    unsigned first;
    // Which of its cells are searched, and in how many parts their rows are taken: of 32 cells, and the rest.
    CellBox cells;
    unsigned parts;
};

// The grid nested in the cell of a number, that begins at an offset.
DEVICE NestedGrid nested_grid(const Grid &grid, const GridFrame &frame, unsigned number, int offset) {
    const IVec3 place = cell_of(frame.cells, number);
    const Vec3 cell = {(float)place.x, (float)place.y, (float)place.z};
    unsigned dims[3];
    for (unsigned axis = 0; axis < 3; axis++)
        dims[axis] = (unsigned)__ldg(grid.cells + offset + axis);
    const Vec3 n = {(float)dims[0], (float)dims[1], (float)dims[2]};
    NestedGrid nested;
    nested.corner = frame.corner + grid.size * cell;
    nested.size = grid.size / n;
    nested.width = dims[0];
    nested.height = dims[1];
    nested.first = (unsigned)offset + 3;
    nested.cells = cell_box(Bounds{n * (frame.part.low - cell), n * (frame.part.high - cell)}, dims);
    nested.parts = (nested.cells.width + WARP - 1) / WARP;
    return nested;
}
