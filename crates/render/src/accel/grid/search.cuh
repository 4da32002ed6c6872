// The search for all triangles that meet a region, cell by cell: twin of search.rs.
//
// Lanes take the cells of a box of cells: that around the region, or, where the region is slanted, those around its parts in layers
// of cells. A cell that holds something is looked into where the region meets its box, and the lanes share the triangles of all such
// cells. Nested grids follow, one after the other.
//
// # How far it can err
//
// In units of ε r as in lattice.rs, where the scene is 2 r wide and a triangle is listed in every cell that comes within 320 of it.
// The twin computes cells in double precision. Here the corners of a box, relative to the grid's, are rounded once, by 2; multiplied
// with the rounded reciprocal of a cell's edge, by 4 more; and for a nested grid with its number of cells, once the outer cell is taken
// off, by 4 more; planes of cells by 2. That is less than 16. So where a point of a triangle lies in the region, a cell is looked at
// that comes within 16 of the point, and therefore lists the triangle.
//
// The box of a cell is in world coordinates, which are below S = |corner| + extent of the grid. It is rounded by less than 8 ε S, and
// enlarged on each side by the margin and 32 ε S. So it holds the point, and leaves the 16 ε of its edges that tangent planes ask for.
// The layers of a slanted region lie between the planes of these boxes.
#pragma once

#include "accel/sieve.cuh"

// Numbers of the cells of a box of cells, x fastest.
struct CellBox {
    // The first cell on each axis, and how many there are.
    int x, y, z;
    unsigned width, height, depth;
};

// A search in progress.
struct GridSearch {
    // The part of the region that is searched, in cells of the outer grid.
    Bounds part;
    // Slanted regions: the axis of the layers, and the layers from the next to the last.
    unsigned axis;
    int layer, last_layer;
    // Cells of the part that were taken.
    unsigned taken;
    // The lanes whose cells hold grids that are still to be searched, where the lane's begins, and how many cells of the first lane's
    // were taken.
    unsigned nested;
    int grid;
    unsigned taken_nested;
    // The triangles of the cells that lanes look into, one cell after the other: where the lane's end in this list, and what to add
    // to a place there for the place in memory; how many were taken, of how many.
    unsigned end, shift, next, all;
    // Triangles found lately, by a part of their index.
    unsigned *recent;
    bool done;
};

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

DEVICE unsigned search_words(const Grid &) { return RECENT_TRIANGLES; }

template <class Form>
DEVICE GridSearch begin_search(const Grid &grid, const Region<Form> &region, unsigned *memory) {
    GridSearch search = {};
    search.part = in_cells(grid, region.bounds);
    search.recent = memory;
    for (unsigned i = lane_of_thread(); i < RECENT_TRIANGLES; i += WARP)
        memory[i] = 0;
    __syncwarp();
    if constexpr (Form::SLANTED) {
        // Layers along the axis of most cells; the first is still to come.
        const CellBox cells = cell_box(search.part, grid.dims);
        const unsigned width = cells.width, height = cells.height, depth = cells.depth;
        search.axis = width >= height && width >= depth ? 0 : depth > height ? 2 : 1;
        search.layer = component(search.axis, cells.x, cells.y, cells.z);
        search.last_layer = count_of(cells) == 0 ? search.layer - 1
                                                 : search.layer + (int)component(search.axis, width, height, depth) - 1;
        search.part = Bounds{splat(0.0f), splat(-1.0f)};
    }
    return search;
}

// Goes on with the next part of the region, or ends the search.
template <class Form>
DEVICE void next_part(const Grid &grid, const Region<Form> &region, GridSearch &search) {
    search.done = true;
    if constexpr (Form::SLANTED) {
        if (search.layer > search.last_layer)
            return;
        search.done = false;
        const unsigned axis = search.axis;
        const float grow = component(axis, growth(grid)), size = component(axis, grid.size), layer = (float)search.layer++;
        const float corner = component(axis, to_single(grid.origin));
        Bounds bounds;
        const bool any = region_between(region, axis, corner + size * layer - grow, corner + size * (layer + 1.0f) + grow, bounds);
        search.part = in_cells(grid, bounds);
        // On the axis, all of this layer and nothing of the next; and nothing at all where the region has no point in it.
        const float low = layer, high = any ? next_down(layer + 1.0f) : layer - 1.0f;
        if (axis == 0)
            search.part.low.x = low, search.part.high.x = high;
        else if (axis == 1)
            search.part.low.y = low, search.part.high.y = high;
        else
            search.part.low.z = low, search.part.high.z = high;
        search.taken = 0;
    }
}

DEVICE bool goes_on(const Grid &, const GridSearch &search) { return !search.done; }

// A grid whose cells lanes take: the outer one, or a nested one.
struct SearchedGrid {
    // World coordinates of the lowest corner, and edges of a cell.
    Vec3 corner, size;
    unsigned dims[3];
    // Where its cells are, and which of them are searched.
    unsigned first;
    CellBox cells;
};

DEVICE SearchedGrid outer_grid(const Grid &grid, const GridSearch &search) {
    return SearchedGrid{to_single(grid.origin), grid.size, {grid.dims[0], grid.dims[1], grid.dims[2]}, 3,
                        cell_box(search.part, grid.dims)};
}

// The grid nested in the cell of the first lane that has one.
DEVICE SearchedGrid nested_grid(const Grid &grid, const GridSearch &search, const SearchedGrid &outer) {
    const unsigned owner = __ffs(search.nested) - 1;
    const int offset = __shfl_sync(ALL_LANES, search.grid, owner);
    const IVec3 place = cell_of(outer.cells, search.taken - WARP + owner);
    const Vec3 cell = {(float)place.x, (float)place.y, (float)place.z};
    SearchedGrid nested;
    for (unsigned axis = 0; axis < 3; axis++)
        nested.dims[axis] = (unsigned)__ldg(grid.cells + offset + axis);
    const Vec3 n = {(float)nested.dims[0], (float)nested.dims[1], (float)nested.dims[2]};
    nested.corner = outer.corner + outer.size * cell;
    nested.size = outer.size / n;
    nested.first = (unsigned)offset + 3;
    nested.cells = cell_box(Bounds{n * (search.part.low - cell), n * (search.part.high - cell)}, nested.dims);
    return nested;
}

// Whether the region may meet the box of a cell.
template <class Form>
DEVICE bool meets_cell(const Grid &grid, const Region<Form> &region, const SearchedGrid &searched, const IVec3 &cell) {
    const Vec3 grow = growth(grid), number = {(float)cell.x, (float)cell.y, (float)cell.z};
    const Vec3 low = searched.corner + searched.size * number, high = searched.corner + searched.size * (number + splat(1.0f));
    return meets(region, low - grow, high + grow, 0.0f);
}

// Lanes take up to 32 cells and look into those that the region meets.
template <class Form>
DEVICE void next_cells(const Grid &grid, const Region<Form> &region, GridSearch &search) {
    SearchedGrid searched = outer_grid(grid, search);
    const bool is_nested = search.nested != 0;
    if (!is_nested && search.taken >= count_of(searched.cells)) {
        next_part(grid, region, search);
        return;
    }
    if (is_nested)
        searched = nested_grid(grid, search, searched);
    const unsigned number = (is_nested ? search.taken_nested : search.taken) + lane_of_thread(), cells = count_of(searched.cells);
    int first = 0, head = 0, offset = -1;
    if (number < cells) {
        const IVec3 cell = cell_of(searched.cells, number);
        const unsigned place = ((unsigned)cell.z * searched.dims[1] + (unsigned)cell.y) * searched.dims[0] + (unsigned)cell.x;
        offset = __ldg(grid.cells + searched.first + place);
        if (offset >= 0 && meets_cell(grid, region, searched, cell)) {
            head = __ldg(grid.cells + offset);
            first = __ldg(grid.cells + offset + 1);
        }
    }
    // Triangles to share, and grids to search.
    const unsigned triangles = head < 0 ? (unsigned)-head : 0;
    search.end = warp_running_sum(triangles);
    search.shift = (unsigned)first - (search.end - triangles);
    search.all = __shfl_sync(ALL_LANES, search.end, WARP - 1);
    search.next = 0;
    if (is_nested) {
        search.taken_nested += WARP;
        if (search.taken_nested >= cells) {
            search.nested &= search.nested - 1;
            search.taken_nested = 0;
        }
        return;
    }
    search.taken += WARP;
    search.nested = __ballot_sync(ALL_LANES, head > 0);
    search.grid = offset;
}

// Whether a triangle was neither found lately nor is that of a lane before this one. What is remembered does not depend on an order in
// which lanes write: of those that want the same place, the last has it.
DEVICE bool is_new(GridSearch &search, bool has, unsigned index) {
    const unsigned lane = lane_of_thread(), place = index % RECENT_TRIANGLES, number = has ? index + 1 : 0;
    const unsigned same = __match_any_sync(ALL_LANES, number);
    const bool is_new = has && (same & lanes_below(lane)) == 0 && search.recent[place] != number;
    // All have read before any writes.
    __syncwarp();
    const unsigned rivals = __match_any_sync(ALL_LANES, is_new ? place : RECENT_TRIANGLES);
    if (is_new && rivals >> lane == 1)
        search.recent[place] = number;
    __syncwarp();
    return is_new;
}

// One round: lanes take three triangles each of the cells last looked into; or cells.
template <bool SIEVED, class Form>
DEVICE void next_triangles(const Grid &grid, const Region<Form> &region, GridSearch &search, unsigned *found, unsigned &count) {
    if (search.next >= search.all) {
        next_cells(grid, region, search);
        return;
    }
    for (unsigned i = 0; i < 3 && search.next < search.all; i++) {
        const unsigned number = search.next + lane_of_thread();
        const unsigned place = number + __shfl_sync(ALL_LANES, search.shift, warp_owner(search.end, number));
        bool has = number < search.all && (!SIEVED || meets_triangle(region, grid.triangles + place));
        has = is_new(search, has, has ? triangle_index(grid.triangles + place) : 0);
        warp_append(has, place, found, count);
        search.next += WARP;
    }
    __syncwarp();
}
