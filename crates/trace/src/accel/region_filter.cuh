// Triangles that a region may meet, one per lane: twin of region_filter.rs.
#pragma once

#include "accel/region.cuh"
#include "accel/instanced.cuh"

DEVICE Bounds bounds_of(const Corners &corners) {
    return Bounds{min(min(corners.a, corners.b), corners.c), max(max(corners.a, corners.b), corners.c)};
}

// Whether the region may meet the bounding box of a triangle.
template <class RegionShape>
DEVICE bool meets_triangle(const Region<RegionShape> &region, const Corners &corners) {
    const Bounds bounds = bounds_of(corners);
    return meets(region, bounds.low, bounds.high, REGION_ROUNDING * element_sum(bounds.high - bounds.low));
}

// Lists the places of those of the lanes' triangles whose bounding boxes the region may meet, or of all unless FILTERED. Not every
// lane has a triangle.
template <bool FILTERED, class RegionShape, class Handle>
DEVICE void filter_by_region(const Region<RegionShape> &region, const Handle &triangle, bool has, unsigned place, unsigned *list,
                             unsigned &count) {
    warp_append(has && (!FILTERED || meets_triangle(region, load_corners(triangle))), place, list, count);
}
