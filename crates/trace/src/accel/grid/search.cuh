// The search for all triangles that meet a region, cell by cell: twin of search.rs.
//
// Every step is one for all lanes, and what the lanes find is shared out evenly before the next:
//
// 1. Lanes take the cells of a box of cells of the outer grid: that around the region, or, where the region is slanted, those around
//    its parts in layers of cells. A cell that holds something is looked into where the region meets its box.
// 2. Lanes take the rows of the grids nested in these cells. A row is read where the region meets its box.
// 3. Lanes take the cells in these rows that hold something. Their boxes are not tested, which would spare about a fifth of the
//    triangles.
// 4. Lanes take the triangles of the cells of step 1 or 3.
//
// Which cells these are, and why none is missed: searched_cells.cuh.
#pragma once

#include "accel/grid/searched_cells.cuh"
#include "accel/region_filter.cuh"

// A search in progress.
struct GridSearch {
    GridFrame *frame;
    // Slanted regions: the axis of the layers, and the layers from the next to the last.
    unsigned axis;
    int layer, last_layer;
    // Cells of the part that were taken.
    unsigned taken;
    // The rows of cells of the grids nested in the cells last taken, one grid after the other: where the lane's grid begins in memory,
    // and where its rows end in this list; how many were taken, of how many.
    int grid;
    unsigned end_of_rows, row, rows;
    // The cells that hold something in the rows last taken, one row after the other: those of the lane's row, a bit each, where the
    // first one's offset is in memory, and where they end in this list; how many were taken, of how many.
    unsigned occupied, place, end_of_cells, cell, cells;
    // The triangles of the cells last taken, one cell after the other: where those of the lane's cell end in this list, and what to add
    // to a place there for the place in memory; how many were taken, of how many.
    unsigned end, shift, next, all;
    // Triangles found recently, by a part of their index.
    unsigned *recent;
    // Whether no part is left.
    bool over;
};

DEVICE unsigned search_words(const Grid &) { return GRID_FRAME_WORDS + RECENT_TRIANGLES; }

// Sets the part of the region that is searched.
DEVICE void set_part(const Grid &grid, GridSearch &search, const Bounds &part) {
    // All have read what they need of the last one.
    __syncwarp();
    if (lane_of_thread() == 0) {
        search.frame->part = part;
        search.frame->cells = cell_box(part, grid.dims);
    }
    search.taken = 0;
    __syncwarp();
}

template <class RegionShape>
DEVICE GridSearch begin_search(const Grid &grid, const Region<RegionShape> &region, unsigned *memory) {
    GridSearch search = {};
    search.frame = reinterpret_cast<GridFrame *>(memory);
    search.recent = memory + GRID_FRAME_WORDS;
    for (unsigned i = lane_of_thread(); i < RECENT_TRIANGLES; i += WARP)
        search.recent[i] = 0;
    if (lane_of_thread() == 0) {
        search.frame->corner = to_single(grid.origin);
        search.frame->grow = growth(grid);
    }
    set_part(grid, search, in_cells(grid, region.bounds));
    if constexpr (RegionShape::SLANTED) {
        // Layers along the axis of most cells; the first is still to come.
        const CellBox cells = search.frame->cells;
        const unsigned width = cells.width, height = cells.height, depth = cells.depth;
        search.axis = width >= height && width >= depth ? 0 : depth > height ? 2 : 1;
        search.layer = component(search.axis, cells.x, cells.y, cells.z);
        search.last_layer = count_of(cells) == 0 ? search.layer - 1
                                                 : search.layer + (int)component(search.axis, width, height, depth) - 1;
        search.taken = count_of(cells);
    }
    return search;
}

// Searches through a grid begin in the cells around a region: there is nothing to start from.
template <class RegionShape>
DEVICE unsigned find_starts(const Grid &, const Region<RegionShape> &, unsigned *) { return FROM_ROOT; }

template <class RegionShape>
DEVICE GridSearch begin_search_at(const Grid &grid, const Region<RegionShape> &region, unsigned *memory, const unsigned *,
                                  unsigned) {
    return begin_search(grid, region, memory);
}

// Goes on with the next part of the region, if any.
template <class RegionShape>
DEVICE void next_part(const Grid &grid, const Region<RegionShape> &region, GridSearch &search) {
    search.over = true;
    if constexpr (RegionShape::SLANTED) {
        if (search.layer > search.last_layer)
            return;
        search.over = false;
        const unsigned axis = search.axis;
        const float grow = component(axis, search.frame->grow), size = component(axis, grid.size), layer = (float)search.layer++;
        const float corner = component(axis, search.frame->corner);
        Bounds bounds;
        const bool any = region_between(region, axis, corner + size * layer - grow, corner + size * (layer + 1.0f) + grow, bounds);
        Bounds part = in_cells(grid, bounds);
        // On the axis, all of this layer and nothing of the next; and nothing at all where the region has no point in it.
        const float low = layer, high = any ? next_down(layer + 1.0f) : layer - 1.0f;
        if (axis == 0)
            part.low.x = low, part.high.x = high;
        else if (axis == 1)
            part.low.y = low, part.high.y = high;
        else
            part.low.z = low, part.high.z = high;
        set_part(grid, search, part);
    }
}

DEVICE bool goes_on(const Grid &, const GridSearch &search) { return !search.over; }

// Lanes may have a cell with triangles each: these are to be taken next.
DEVICE void take_cells(const Grid &grid, GridSearch &search, bool has, int offset) {
    const unsigned triangles = has ? (unsigned)-__ldg(grid.cells + offset) : 0;
    const unsigned first = has ? (unsigned)__ldg(grid.cells + offset + 1) : 0;
    search.end = warp_running_sum(triangles);
    search.shift = first - (search.end - triangles);
    search.next = 0;
    search.all = __shfl_sync(ALL_LANES, search.end, WARP - 1);
}

// 1. Lanes take cells of the outer grid.
template <class RegionShape>
DEVICE void next_cells(const Grid &grid, const Region<RegionShape> &region, GridSearch &search) {
    const GridFrame &frame = *search.frame;
    const unsigned number = search.taken + lane_of_thread();
    int head = 0, offset = -1;
    if (number < count_of(frame.cells)) {
        const IVec3 cell = cell_of(frame.cells, number);
        offset = __ldg(grid.cells + 3 + ((unsigned)cell.z * grid.dims[1] + (unsigned)cell.y) * grid.dims[0] + (unsigned)cell.x);
        const Vec3 first = {(float)cell.x, (float)cell.y, (float)cell.z};
        if (offset >= 0 && meets_cells(region, frame, frame.corner, grid.size, first, first + splat(1.0f)))
            head = __ldg(grid.cells + offset);
    }
    take_cells(grid, search, head < 0, offset);
    unsigned rows = 0;
    if (head > 0) {
        const NestedGrid nested = nested_grid(grid, frame, number, offset);
        rows = nested.cells.height * nested.cells.depth * nested.parts;
    }
    search.grid = offset;
    search.end_of_rows = warp_running_sum(rows);
    search.row = 0;
    search.rows = __shfl_sync(ALL_LANES, search.end_of_rows, WARP - 1);
    search.taken += WARP;
}

// A bit for each cell of a row that holds something.
DEVICE unsigned occupied_cells(const int *row, unsigned count) {
    unsigned occupied = 0;
    for (unsigned x = 0; x < count; x++)
        occupied |= __ldg(row + x) >= 0 ? 1u << x : 0;
    return occupied;
}

// Looks for cells that hold something in a row of a nested grid, where the region meets the row's box.
template <class RegionShape>
DEVICE void look_into_row(const Grid &grid, const Region<RegionShape> &region, const NestedGrid &nested, unsigned number,
                          GridSearch &search) {
    const CellBox &cells = nested.cells;
    const unsigned line = number / nested.parts, skipped = WARP * (number - line * nested.parts), layer = line / cells.height;
    const unsigned count = min(cells.width - skipped, WARP), x = (unsigned)cells.x + skipped,
                   y = (unsigned)cells.y + line - layer * cells.height, z = (unsigned)cells.z + layer;
    const Vec3 first = {(float)x, (float)y, (float)z}, end = first + Vec3{(float)count, 1.0f, 1.0f};
    search.place = nested.first + (z * nested.height + y) * nested.width + x;
    if (meets_cells(region, *search.frame, nested.corner, nested.size, first, end))
        search.occupied = occupied_cells(grid.cells + search.place, count);
}

// 2. Lanes take rows of the grids nested in the cells last taken.
template <class RegionShape>
DEVICE void next_rows(const Grid &grid, const Region<RegionShape> &region, GridSearch &search) {
    const unsigned number = search.row + lane_of_thread(), owner = warp_owner(search.end_of_rows, number);
    const int offset = __shfl_sync(ALL_LANES, search.grid, owner);
    const unsigned before = __shfl_sync(ALL_LANES, search.end_of_rows, owner - 1);
    search.occupied = 0;
    if (number < search.rows) {
        const NestedGrid nested = nested_grid(grid, *search.frame, search.taken - WARP + owner, offset);
        look_into_row(grid, region, nested, number - (owner == 0 ? 0 : before), search);
    }
    search.row += WARP;
    search.end_of_cells = warp_running_sum(__popc(search.occupied));
    search.cell = 0;
    search.cells = __shfl_sync(ALL_LANES, search.end_of_cells, WARP - 1);
}

// The place of a bit of those that are set, the lowest being number 0.
DEVICE unsigned place_of_bit(unsigned bits, unsigned number) {
    for (; number != 0; number--)
        bits &= bits - 1;
    return __ffs(bits) - 1;
}

// 3. Lanes take cells of the rows last taken.
DEVICE void next_occupied(const Grid &grid, GridSearch &search) {
    const unsigned number = search.cell + lane_of_thread(), owner = warp_owner(search.end_of_cells, number);
    const unsigned occupied = __shfl_sync(ALL_LANES, search.occupied, owner), place = __shfl_sync(ALL_LANES, search.place, owner);
    const unsigned end = __shfl_sync(ALL_LANES, search.end_of_cells, owner);
    const bool has = number < search.cells;
    const int offset = has ? __ldg(grid.cells + place + place_of_bit(occupied, __popc(occupied) - (end - number))) : 0;
    take_cells(grid, search, has, offset);
    search.cell += WARP;
}

// Whether a triangle was neither found recently nor belongs to a lane before this one. What is remembered does not depend on the order
// in which lanes write: of those that want the same place, the last one gets it.
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

// 4. Lanes take up to three triangles each of the cells last taken.
template <bool FILTERED, class RegionShape>
DEVICE void next_listed(const Grid &grid, const Region<RegionShape> &region, GridSearch &search, unsigned *found, unsigned &count) {
    for (unsigned i = 0; i < 3 && search.next < search.all; i++) {
        const unsigned number = search.next + lane_of_thread();
        const unsigned place = number + __shfl_sync(ALL_LANES, search.shift, warp_owner(search.end, number));
        bool has = number < search.all && (!FILTERED || meets_triangle(region, load_corners(grid.triangles + place)));
        has = is_new(search, has, has ? triangle_index(grid.triangles + place) : 0);
        warp_append(has, place, found, count);
        search.next += WARP;
    }
    __syncwarp();
}

// One step: the last one for which there is something left.
template <bool FILTERED, class RegionShape>
DEVICE void next_triangles(const Grid &grid, const Region<RegionShape> &region, GridSearch &search, unsigned *found,
                           unsigned &count) {
    if (search.next < search.all)
        next_listed<FILTERED>(grid, region, search, found, count);
    else if (search.cell < search.cells)
        next_occupied(grid, search);
    else if (search.row < search.rows)
        next_rows(grid, region, search);
    else if (search.taken < count_of(search.frame->cells))
        next_cells(grid, region, search);
    else
        next_part(grid, region, search);
}
