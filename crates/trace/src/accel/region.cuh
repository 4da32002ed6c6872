// Regions of space that are searched for triangles, and which boxes they may meet: twin of region/, where rounding is explained.
//
// The region is the same for the whole warp; each lane has its own box. The shape is a type, so that a search does not hold the
// numbers of other forms. The steps are those of the twin, in the same order: both meet the same boxes.
#pragma once

#include "cuda/warp.cuh"

// A box around points.
struct Bounds {
    Vec3 low, high;
};

// ---- Tangent planes: twin of region/planes.rs ----

// The shared memory of a region's planes: PLANE_WORDS words.
struct PlanesMemory {
    // Unit normals, and the height of the lowest point above the corner along each.
    float4 planes[TANGENT_PLANES];
    // The same heights, lowered by the slack and the rounding: where a region is cut off.
    float heights[TANGENT_PLANES];
};

static_assert(sizeof(PlanesMemory) == 4 * PLANE_WORDS, "words of tangent planes");

// Up to TANGENT_PLANES planes; none means "nothing is known".
struct TangentPlanes {
    unsigned count;
    // Where heights are measured from.
    Vec3 corner;
    PlanesMemory *memory;
};

// The planes through the points of the lanes that are `alive`, with unit normals; none if there are too many normals. `corner` is a
// point near all of them.
DEVICE TangentPlanes tangent_planes(const Vec3 &corner, bool alive, const Vec3 &point, const Vec3 &normal, PlanesMemory *memory) {
    TangentPlanes result = {0, corner, memory};
    // Points of one normal have one plane: that through the lowest of them.
    unsigned rest = __ballot_sync(ALL_LANES, alive);
    ROLLED
    for (; rest != 0 && result.count < TANGENT_PLANES; result.count++) {
        const Vec3 shared = warp_broadcast(normal, __ffs(rest) - 1);
        const bool same = alive && normal == shared;
        const float lowest = warp_min(same ? dot(shared, point - corner) : F32_MAX);
        if (lane_of_thread() == 0)
            memory->planes[result.count] = float4{shared.x, shared.y, shared.z, lowest};
        rest &= ~__ballot_sync(ALL_LANES, same);
    }
    if (rest != 0)
        result.count = 0;
    __syncwarp();
    return result;
}

// Whether a box may reach above one of the planes.
DEVICE bool reached(const TangentPlanes &planes, const Vec3 &low, const Vec3 &high, float loose) {
    bool reached = false;
    ROLLED
    for (unsigned i = 0; i < planes.count; i++) {
        const float4 plane = planes.memory->planes[i];
        float top = loose;
        top += ((plane.x > 0.0f ? high.x : low.x) - planes.corner.x) * plane.x;
        top += ((plane.y > 0.0f ? high.y : low.y) - planes.corner.y) * plane.y;
        top += ((plane.z > 0.0f ? high.z : low.z) - planes.corner.z) * plane.z;
        reached |= top >= planes.memory->heights[i];
    }
    return reached;
}

// ---- Forms ----

// A closed box: the bounds themselves.
struct BoxShape {
    enum { SLANTED = false };
    Bounds bounds;
};

DEVICE bool shape_meets(const BoxShape &box, const Vec3 &low, const Vec3 &high) {
    const Vec3 &min = box.bounds.low, &max = box.bounds.high;
    return low.x <= max.x && high.x >= min.x && low.y <= max.y && high.y >= min.y && low.z <= max.z && high.z >= min.z;
}

// All points near a box.
struct NearShape {
    enum { SLANTED = false };
    Bounds origins;
    // A little more than the square of the distance.
    float square;
};

DEVICE bool shape_meets(const NearShape &near, const Vec3 &low, const Vec3 &high) {
    const Vec3 apart = max(max(low - near.origins.high, near.origins.low - high), splat(0.0f));
    return dot(apart, apart) <= near.square;
}

// The lower or the upper faces of a shaft.
struct Faces {
    Vec3 from, to;
    // Reciprocals of how far they move, to two units of roundoff; never infinite, never zero.
    Vec3 inverse;
};

// One axis: a face that does not move, or moves less than the smallest normal number, has the sign of `still`: outward.
DEVICE float inverse_way(float from, float to, float still) {
    const float way = to - from;
    return rough_reciprocal(fabsf(way) >= F32_MIN_POSITIVE ? way : still * F32_MIN_POSITIVE);
}

DEVICE Vec3 faces_at(const Faces &faces, float t) { return faces.from + t * (faces.to - faces.from); }

// The faces of a shaft, in shared memory: they are the same for all lanes, and too much for their registers.
struct ShaftFaces {
    Faces low, high;
};

static_assert(sizeof(ShaftFaces) <= 4 * SHAFT_WORDS, "words of the faces of a shaft");

// The space between two boxes: twin of region/shaft.rs.
struct ShaftShape {
    enum { SLANTED = true };
    const ShaftFaces *faces;
};

// For which parameters a shaft may overlap a box on one axis.
DEVICE void narrow_shaft(float low_from, float low_inverse, float high_from, float high_inverse, float low, float high,
                         float &first, float &last) {
    // The lower face must not be above the box, nor the upper face below it.
    const float above = (high - low_from) * low_inverse, below = (low - high_from) * high_inverse;
    if (low_inverse > 0.0f)
        last = fminf(last, above);
    else
        first = fmaxf(first, above);
    if (high_inverse > 0.0f)
        first = fmaxf(first, below);
    else
        last = fminf(last, below);
}

DEVICE bool shape_meets(const ShaftShape &shaft, const Vec3 &low, const Vec3 &high) {
    const Faces &lower = shaft.faces->low, &upper = shaft.faces->high;
    float first = 0.0f, last = 1.0f;
    narrow_shaft(lower.from.x, lower.inverse.x, upper.from.x, upper.inverse.x, low.x, high.x, first, last);
    narrow_shaft(lower.from.y, lower.inverse.y, upper.from.y, upper.inverse.y, low.y, high.y, first, last);
    narrow_shaft(lower.from.z, lower.inverse.z, upper.from.z, upper.inverse.z, low.z, high.z, first, last);
    return first <= last + REGION_ROUNDING;
}

// The way from the middle of a shaft's first box to that of its second; zero for other forms.
DEVICE Vec3 heading_of(const BoxShape &) { return splat(0.0f); }
DEVICE Vec3 heading_of(const NearShape &) { return splat(0.0f); }
DEVICE Vec3 heading_of(const ShaftShape &shaft) {
    const Faces &low = shaft.faces->low, &high = shaft.faces->high;
    return 0.5f * (low.to - low.from + high.to - high.from);
}

// The octant that a direction points into: in the order of slot xor this, near children of a node come last.
DEVICE unsigned octant_of(const Vec3 &direction) {
    return (direction.x >= 0.0f ? 4u : 0u) | (direction.y >= 0.0f ? 2u : 0u) | (direction.z >= 0.0f ? 1u : 0u);
}

// ---- Regions ----

template <class RegionShape>
struct Region {
    RegionShape shape;
    TangentPlanes planes;
    // No point of the region lies outside.
    Bounds bounds;
};

// The next numbers below and above a number that is finite or the opposite infinity.
DEVICE float next_down(float a) {
    const unsigned bits = __float_as_uint(a);
    return a == 0.0f ? -__uint_as_float(1) : __uint_as_float(a > 0.0f ? bits - 1 : bits + 1);
}
DEVICE float next_up(float a) { return -next_down(-a); }
DEVICE Vec3 next_down(const Vec3 &a) { return Vec3{next_down(a.x), next_down(a.y), next_down(a.z)}; }
DEVICE Vec3 next_up(const Vec3 &a) { return Vec3{next_up(a.x), next_up(a.y), next_up(a.z)}; }

DEVICE TangentPlanes no_planes() { return TangentPlanes{0, splat(0.0f), nullptr}; }

// A closed box.
DEVICE Region<BoxShape> region_within(const Bounds &bounds) { return Region<BoxShape>{BoxShape{bounds}, no_planes(), bounds}; }

// All points at most `reach` away from some point of `origins`.
DEVICE Region<NearShape> region_near(const Bounds &origins, float reach) {
    const float square = reach * reach * (1.0f + REGION_ROUNDING) + F32_MIN_POSITIVE;
    const Bounds bounds = {next_down(origins.low - splat(reach)), next_up(origins.high + splat(reach))};
    return Region<NearShape>{NearShape{origins, square}, no_planes(), bounds};
}

// All points of all segments from a point of `origins` to a point of `emitter`; neither is empty. Each of six lanes computes a face.
DEVICE Region<ShaftShape> region_shaft(const Bounds &origins, const Bounds &emitter, ShaftFaces *memory) {
    const unsigned lane = lane_of_thread(), axis = lane % 3;
    if (lane < 6) {
        const bool upper = lane >= 3;
        const float from = component(axis, upper ? origins.high : origins.low), to = component(axis, upper ? emitter.high : emitter.low);
        float *face = reinterpret_cast<float *>(memory) + (upper ? sizeof(Faces) / sizeof(float) : 0) + axis;
        face[0] = from;
        face[3] = to;
        face[6] = inverse_way(from, to, upper ? 1.0f : -1.0f);
    }
    __syncwarp();
    return Region<ShaftShape>{ShaftShape{memory}, no_planes(),
                              Bounds{min(origins.low, emitter.low), max(origins.high, emitter.high)}};
}

// The part of a region that does not lie below all the planes lowered by `slack`; everything if there are none.
template <class RegionShape>
DEVICE Region<RegionShape> region_above(Region<RegionShape> region, const TangentPlanes &planes, float slack) {
    const unsigned lane = lane_of_thread();
    if (lane < planes.count) {
        const float4 plane = planes.memory->planes[lane];
        const Vec3 far = max(abs(region.bounds.low - planes.corner), abs(region.bounds.high - planes.corner));
        planes.memory->heights[lane] = plane.w - slack - REGION_ROUNDING * dot(abs(Vec3{plane.x, plane.y, plane.z}), far);
    }
    __syncwarp();
    region.planes = planes;
    return region;
}

// Whether the region may meet the lane's box. `loose` is added to the height that the box reaches above a plane: 16 ε times the sum
// of its edges; zero for a box that was enlarged by as much on each side.
template <class RegionShape>
DEVICE bool meets(const Region<RegionShape> &region, const Vec3 &low, const Vec3 &high, float loose) {
    return shape_meets(region.shape, low, high) && (region.planes.count == 0 || reached(region.planes, low, high, loose));
}

// A box around all points of a shaft whose coordinate on `axis` lies between `low` and `high`; false if there are none.
DEVICE bool region_between(const Region<ShaftShape> &region, unsigned axis, float low, float high, Bounds &bounds) {
    const Faces &lower = region.shape.faces->low, &upper = region.shape.faces->high;
    float first = 0.0f, last = 1.0f;
    narrow_shaft(component(axis, lower.from), component(axis, lower.inverse), component(axis, upper.from),
                 component(axis, upper.inverse), low, high, first, last);
    first = fmaxf(first - REGION_ROUNDING, 0.0f);
    last = fminf(last + REGION_ROUNDING, 1.0f);
    bounds.low = min(faces_at(lower, first), faces_at(lower, last)) - REGION_ROUNDING * (abs(lower.from) + abs(lower.to));
    bounds.high = max(faces_at(upper, first), faces_at(upper, last)) + REGION_ROUNDING * (abs(upper.from) + abs(upper.to));
    return first <= last;
}
