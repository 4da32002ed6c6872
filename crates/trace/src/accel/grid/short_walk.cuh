// The cells around a short segment.
//
// By rounding, a triangle that blocks a segment according to the plane form of the test may lie next to it: all triangles within
// `slack` must be tested. So the walk visits the layers of cells along the segment's longest axis, and in each layer the
// rectangle of cells that the segment, thickened by the slack, passes through. Rounding here is covered by the margin of the
// cells (lattice.rs). A triangle may be tested several times.
#pragma once

#include "accel/visit.cuh"

// A segment in cells of a grid.
struct CellSegment {
    Vec3 origin, direction, slack;
    unsigned dims[3];
    // Where the cells begin.
    unsigned first;
};

// Cells of an axis, first and last included; none if last < first.
struct CellRange {
    int first, last;
};

// The cells that the path from a to b, thickened by the slack, meets.
DEVICE CellRange cells_between(float a, float b, float slack, unsigned dims) {
    return CellRange{max(__float2int_rd(fminf(a, b) - slack), 0), min(__float2int_rd(fmaxf(a, b) + slack), (int)dims - 1)};
}

// The segment parameter at which an axis has this coordinate; that of an end if the segment does not reach it.
DEVICE float parameter_at(float coordinate, float origin, float inverse) {
    return fminf(fmaxf((coordinate - origin) * inverse, 0.0f), 1.0f);
}

// One axis of a segment in cells.
struct CellAxis {
    float origin, direction, slack;
    unsigned cells;
    // Distance in the list of cells from one cell of this axis to the next.
    int stride;
};

DEVICE CellAxis cell_axis(const CellSegment &cells, unsigned axis) {
    const unsigned x = cells.dims[0], y = cells.dims[1], z = cells.dims[2];
    return CellAxis{component(axis, cells.origin.x, cells.origin.y, cells.origin.z),
                    component(axis, cells.direction.x, cells.direction.y, cells.direction.z),
                    component(axis, cells.slack.x, cells.slack.y, cells.slack.z), component(axis, x, y, z),
                    (int)component(axis, 1u, x, x * y)};
}

template <int LEVEL>
DEVICE bool ask_cell(const Grid &grid, const CellSegment &cells, int place, Short &segment);

// Tests the triangles of the cells around a segment: layers along its longest axis, and rectangles in these; false ends the walk.
template <int LEVEL>
DEVICE bool ask_around(const Grid &grid, const CellSegment &cells, Short &segment) {
    const Vec3 way = abs(cells.direction);
    const unsigned longest = way.x >= way.y && way.x >= way.z ? 0 : way.y >= way.z ? 1 : 2;
    const CellAxis x = cell_axis(cells, longest == 2 ? 0 : longest + 1), y = cell_axis(cells, longest == 0 ? 2 : longest - 1),
                   z = cell_axis(cells, longest);
    const float inverse = 1.0f / z.direction;
    const CellRange layers = cells_between(z.origin, z.origin + z.direction, z.slack, z.cells);
    for (int layer = layers.first; layer <= layers.last; ++layer) {
        const float from = parameter_at((float)layer - z.slack, z.origin, inverse);
        const float to = parameter_at((float)(layer + 1) + z.slack, z.origin, inverse);
        const CellRange rows = cells_between(y.origin + from * y.direction, y.origin + to * y.direction, y.slack, y.cells);
        const CellRange columns = cells_between(x.origin + from * x.direction, x.origin + to * x.direction, x.slack, x.cells);
        for (int row = rows.first; row <= rows.last; ++row)
            for (int column = columns.first; column <= columns.last; ++column)
                if (!ask_cell<LEVEL>(grid, cells, layer * z.stride + row * y.stride + column * x.stride, segment))
                    return false;
    }
    return true;
}

template <int LEVEL>
DEVICE bool ask_cell(const Grid &grid, const CellSegment &cells, int place, Short &segment) {
    const int offset = __ldg(grid.cells + cells.first + place);
    if (offset < 0)
        return true;
    const int head = __ldg(grid.cells + offset), second = __ldg(grid.cells + offset + 1);
    if (head < 0)
        return ask(segment, grid, Run{(unsigned)second, (unsigned)(second - head)});
    // Grids are nested one level deep.
    if constexpr (LEVEL == 0) {
        const unsigned dims[3] = {(unsigned)head, (unsigned)second, (unsigned)__ldg(grid.cells + offset + 2)};
        const Vec3 n = {(float)dims[0], (float)dims[1], (float)dims[2]};
        const unsigned number = place, width = cells.dims[0], height = cells.dims[1];
        const Vec3 corner = {(float)(number % width), (float)(number / width % height), (float)(number / width / height)};
        const CellSegment inner = {n * (cells.origin - corner), n * cells.direction, n * cells.slack,
                                   {dims[0], dims[1], dims[2]}, (unsigned)offset + 3};
        return ask_around<1>(grid, inner, segment);
    }
    return true;
}

DEVICE void walk_short(const Grid &grid, Short &segment, float slack) {
    // The compiler computes only once what all segments of a surface point have in common.
    const Vec3 origin = to_single(to_double(segment.test.origin) - grid.origin);
    const Vec3 inverse = {1.0f / grid.size.x, 1.0f / grid.size.y, 1.0f / grid.size.z};
    const CellSegment cells = {origin * inverse, segment.direction * inverse, slack * inverse,
                               {grid.dims[0], grid.dims[1], grid.dims[2]}, 3};
    ask_around<0>(grid, cells, segment);
}
