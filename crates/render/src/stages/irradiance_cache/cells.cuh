// Surface cells and their records: twin of cells.rs.
#pragma once

#include "accel/region.cuh"
#include "surface.cuh"

// The largest power of two up to `width`, as its exponent; `rest` is what remains, from 1 to 2.
DEVICE int level_of_width(float width, float &rest) {
    const unsigned bits = __float_as_uint(larger(width, F32_MIN_POSITIVE));
    rest = __uint_as_float((bits & ~F32_INFINITY_BITS) | __float_as_uint(1.0f));
    return max(MIN_LEVEL, min((int)(bits >> 23) - 127, MAX_LEVEL));
}

// The size of the cells of a level.
DEVICE float size_of_level(int level) { return __uint_as_float((unsigned)(level + 127) << 23); }

DEVICE Vec3 cell_offset() { return Vec3{CELL_OFFSET_X, CELL_OFFSET_Y, CELL_OFFSET_Z}; }

// The cell of a level in which a position lies.
DEVICE IVec3 cell_at(int level, Vec3 position) {
    const Vec3 place = position / size_of_level(level) + cell_offset();
    return IVec3{(int)floorf(place.x), (int)floorf(place.y), (int)floorf(place.z)};
}

// The lowest corner of a cell.
DEVICE Vec3 corner_of_cell(int level, IVec3 cell) {
    return size_of_level(level) * (Vec3{(float)cell.x, (float)cell.y, (float)cell.z} - cell_offset());
}

// The edges of a cell.
DEVICE Bounds bounds_of_cell(int level, IVec3 cell) {
    const Vec3 low = corner_of_cell(level, cell);
    return Bounds{low, low + splat(size_of_level(level))};
}

DEVICE unsigned long long cell_axis(int index) { return (unsigned)index & ((1u << CELL_INDEX_BITS) - 1); }

// A cell in 58 bits.
DEVICE unsigned long long cell_key(int level, IVec3 cell) {
    return (unsigned long long)(level + LEVEL_BIAS) << 3 * CELL_INDEX_BITS | cell_axis(cell.z) << 2 * CELL_INDEX_BITS |
           cell_axis(cell.y) << CELL_INDEX_BITS | cell_axis(cell.x);
}

// A cell among names.
DEVICE Name name_of_cell(int level, IVec3 cell) { return Name{cell_key(level, cell), {cell.x, cell.y, cell.z}, level, 0, 0}; }

// One kind of surface in a cell among names; the cell is smaller by so many levels than what was asked at first.
DEVICE Name name_of_node(int level, IVec3 cell, unsigned kind, unsigned finer) {
    return Name{cell_key(level, cell) << 6 | finer << 4 | kind, {cell.x, cell.y, cell.z}, level, kind, finer};
}

DEVICE IVec3 cell_of_name(const Name &name) { return IVec3{name.cell[0], name.cell[1], name.cell[2]}; }

DEVICE Bounds bounds_of_name(const Name &name) { return bounds_of_cell(name.level, cell_of_name(name)); }

DEVICE Vec3 middle_of(const Bounds &bounds) { return 0.5f * (bounds.low + bounds.high); }

// Along the normal of a triangle's front.
DEVICE Vec3 outward_of(const Corners &corners) { return cross(corners.b - corners.a, corners.c - corners.a); }

// The kind of the side of a surface that `normal` leaves: even on fronts.
DEVICE unsigned surface_kind(Vec3 normal, bool front) {
    const Vec3 size = abs(normal);
    const unsigned axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 4 * axis + 2 * (component(axis, normal) < 0.0f) + !front;
}

// A point of a triangle with the weights of its second and third corner.
struct WeighedPoint {
    Vec3 point;
    float u, v;
};

DEVICE WeighedPoint weighed_point(const Corners &corners, float u, float v) {
    return WeighedPoint{corners.a + u * (corners.b - corners.a) + v * (corners.c - corners.a), u, v};
}

// The point of a triangle that is closest to `p`.
DEVICE WeighedPoint closest_point(Vec3 p, const Corners &corners) {
    const Vec3 ab = corners.b - corners.a, ac = corners.c - corners.a;
    const Vec3 ap = p - corners.a, bp = p - corners.b, cp = p - corners.c;
    const float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d1 <= 0.0f && d2 <= 0.0f)
        return weighed_point(corners, 0.0f, 0.0f);
    if (d3 >= 0.0f && d4 <= d3)
        return weighed_point(corners, 1.0f, 0.0f);
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f)
        return weighed_point(corners, d1 / (d1 - d3), 0.0f);
    if (d6 >= 0.0f && d5 <= d6)
        return weighed_point(corners, 0.0f, 1.0f);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f)
        return weighed_point(corners, 0.0f, d2 / (d2 - d6));
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
        const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return weighed_point(corners, 1.0f - w, w);
    }
    const float sum = va + vb + vc;
    return sum > 0.0f ? weighed_point(corners, vb / sum, vc / sum) : weighed_point(corners, 0.0f, 0.0f);
}

