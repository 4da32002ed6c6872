// A ray and a grid in the coordinates of the walk: units are cells of the grid, mirrored so that the ray ascends on every axis.
#pragma once

#include "cuda/prelude.cuh"

#include "accel/ray.cuh"

// Cells of an axis that the walk can tell apart: their numbers are exact in a float, and `bits_of_cell` needs room.
#define GRID_MAX_CELLS (1u << 22)
// A float around which the floats are the integers, and its bits.
#define WHOLE_FLOATS 12582912.0f
#define WHOLE_FLOATS_BITS 0x4b400000u

// How a ray passes through the outer grid.
struct March {
    // Ray parameter per cell, and at plane 0.
    Vec3 inverse, start;
    // Cells per ray parameter.
    Vec3 speed;
    // Whether each axis is mirrored.
    bool mirror_x, mirror_y, mirror_z;
};

// The cells that a walk is passing through: those of the outer grid, numbered from 0, or those of a nested one, numbered up to -1.
// So the last plane of a nested grid is plane 0, and is crossed at exactly `start`, where the ray leaves the cell of the outer grid.
struct Cells {
    Vec3 inverse, start;
    // Where cell (0, 0, 0) lies in memory, minus what `bits_of_cell` adds; the strides to the next cell on each axis.
    unsigned first, stride_x, stride_y, stride_z;
};

// A cell's number as an integer, plus WHOLE_FLOATS_BITS: an addition is faster than a conversion.
DEVICE unsigned bits_of_cell(float cell) { return __float_as_uint(cell + WHOLE_FLOATS); }

// Where a ray crosses a plane of each axis.
DEVICE Vec3 crossing(Vec3 planes, Vec3 inverse, Vec3 start) {
    return Vec3{fmaf(planes.x, inverse.x, start.x), fmaf(planes.y, inverse.y, start.y), fmaf(planes.z, inverse.z, start.z)};
}

// Cells numbered from 0; `place` is where the first lies in memory, before mirroring.
DEVICE Cells cells_of(const March &march, Vec3 inverse, Vec3 start, unsigned place, const unsigned (&dims)[3]) {
    const unsigned row = dims[0], layer = dims[0] * dims[1];
    Cells cells = {inverse, start, place, march.mirror_x ? 0u - 1u : 1u, march.mirror_y ? 0u - row : row,
                   march.mirror_z ? 0u - layer : layer};
    cells.first += march.mirror_x ? dims[0] - 1 : 0;
    cells.first += march.mirror_y ? layer - row : 0;
    cells.first += march.mirror_z ? layer * (dims[2] - 1) : 0;
    cells.first -= WHOLE_FLOATS_BITS * (cells.stride_x + cells.stride_y + cells.stride_z);
    return cells;
}

// The same cells numbered up to -1.
DEVICE Cells numbered_down(Cells cells, const unsigned (&dims)[3]) {
    cells.first += dims[0] * cells.stride_x + dims[1] * cells.stride_y + dims[2] * cells.stride_z;
    return cells;
}

DEVICE unsigned place_of(const Cells &cells, Vec3 cell) {
    return cells.first + bits_of_cell(cell.x) * cells.stride_x + bits_of_cell(cell.y) * cells.stride_y +
           bits_of_cell(cell.z) * cells.stride_z;
}

DEVICE Vec3 to_float(const unsigned (&dims)[3]) { return Vec3{(float)dims[0], (float)dims[1], (float)dims[2]}; }

// Where a ray leaves the outer grid.
DEVICE float leave_grid(Vec3 inverse, Vec3 start, Vec3 dims) {
    const Vec3 last = crossing(dims, inverse, start);
    return fminf(last.x, fminf(last.y, last.z));
}

// The cell at ray parameter t, clamped to those between two.
DEVICE float cell_at(float t, float start, float speed, float first, float last) {
    return fmaxf(fminf(floorf((t - start) * speed), last), first);
}

DEVICE Vec3 cell_at(float t, Vec3 start, Vec3 speed, Vec3 first, Vec3 last) {
    return Vec3{cell_at(t, start.x, speed.x, first.x, last.x), cell_at(t, start.y, speed.y, first.y, last.y),
                cell_at(t, start.z, speed.z, first.z, last.z)};
}

DEVICE void march_along(float origin, float direction, float size, float least, float dims, float &inverse, float &start,
                        float &speed, bool &mirror) {
    const float cells = 1.0f / size;
    mirror = direction < 0.0f;
    speed = fmaxf(fabsf(direction), least) * cells;
    inverse = 1.0f / speed;
    start = -((mirror ? dims - origin * cells : origin * cells) * inverse);
}

DEVICE March march_of(const Grid &grid, const Ray &ray) {
    const Vec3 origin = to_single(to_double(ray.origin) - grid.origin), dims = to_float(grid.dims);
    const float least = MIN_COMPONENT * max_element(abs(ray.direction));
    March m;
    march_along(origin.x, ray.direction.x, grid.size.x, least, dims.x, m.inverse.x, m.start.x, m.speed.x, m.mirror_x);
    march_along(origin.y, ray.direction.y, grid.size.y, least, dims.y, m.inverse.y, m.start.y, m.speed.y, m.mirror_y);
    march_along(origin.z, ray.direction.z, grid.size.z, least, dims.z, m.inverse.z, m.start.z, m.speed.z, m.mirror_z);
    return m;
}

DEVICE bool few_cells(const unsigned (&dims)[3]) { return (dims[0] | dims[1] | dims[2]) < GRID_MAX_CELLS; }

// Whether the walk can handle these numbers: neither too many cells nor scenes at the ends of the range of f32.
DEVICE bool can_march(const March &march, const unsigned (&dims)[3]) {
    return is_finite(march.start) && is_finite(march.speed) && few_cells(dims);
}
