// The triangles that can hide light points from a bundle's surface points, each with the box of these light points: twin of cells.rs.
#pragma once

#include "light_mesh/lattice.cuh"
#include "stages/short_tests/memory.cuh"
#include "stages/short_tests/span.cuh"

// Added to offsets, which are at least 1 - MAX_REACH, so that they have no sign.
#define BOX_BIAS (MAX_REACH - 1)

// Whether the plane of a triangle comes nearer than `reach` to the box around the origins.
DEVICE bool plane_is_near(const CellBundle &bundle, const Vec3 &a, const Vec3 &b, const Vec3 &c, float reach) {
    const Vec3 normal = cross(b - a, c - a);
    const Vec3 center = 0.5f * (bundle.low + bundle.high), extent = bundle.high - bundle.low;
    const float apart = fabsf(dot(normal, center - a)) - 0.5f * dot(abs(normal), extent);
    return apart <= 0.0f || apart * apart <= reach * reach * dot(normal, normal);
}

// Whether a triangle certainly lies on or behind the tangent planes of all surface points.
DEVICE bool is_behind(const CellBundle &bundle, const Vec3 &a, const Vec3 &b, const Vec3 &c) {
    bool behind = bundle.planes.count != 0;
    const Vec3 from_a = a - bundle.low, from_b = b - bundle.low, from_c = c - bundle.low, extent = bundle.high - bundle.low;
    const Vec3 size = max(max(abs(from_a), abs(from_b)), abs(from_c)) + extent;
    for (unsigned i = 0; i < bundle.planes.count; i++) {
        const float4 plane = bundle.planes.memory->planes[i];
        const Vec3 normal = {plane.x, plane.y, plane.z};
        // Relative to the box, so that rounding is relative to the size of the box and the triangle: 8 ε bounds that of both products.
        const float top = fmaxf(fmaxf(dot(normal, from_a), dot(normal, from_b)), dot(normal, from_c));
        behind &= top + 8.0f * UNIT_ROUNDOFF * dot(abs(normal), size) < plane.w;
    }
    return behind;
}

// One axis of the box of light points, as offsets from the cell, that a triangle can hide from the bundle's surface points: see
// `shadow_box` in cells.rs. `most` is the largest factor by which a shadow is stretched.
DEVICE Span span_to(float low, float high, float a, float b, float c, float slack) {
    return Span{fminf(fminf(a, b), c) - high - slack, fmaxf(fmaxf(a, b), c) - low + slack};
}

// A lower bound on the distance of all q - P from zero.
DEVICE float distance_apart(const Span &x, const Span &y, const Span &z) {
    const Vec3 apart = {fmaxf(fmaxf(x.low, -x.high), 0.0f), fmaxf(fmaxf(y.low, -y.high), 0.0f),
                        fmaxf(fmaxf(z.low, -z.high), 0.0f)};
    return sqrtf(dot(apart, apart));
}

// The largest s for which s (q - P) can be within reach; unbounded if the triangle may touch an origin.
DEVICE float most_stretch(float apart, float reach) { return apart > reach * 1e-20f ? reach / apart : 1e20f; }

DEVICE void stretch(Span &span, float most, float reach) {
    if (span.low < 0.0f)
        span.low = fmaxf(most * span.low, -reach);
    if (span.high > 0.0f)
        span.high = fminf(most * span.high, reach);
}

// The light points of a span on one axis: offsets from the cell, at least 1 - reach, at most reach.
DEVICE void span_in_steps(const LightMesh &mesh, float inverse_step, const Span &span, float low, float high, float origin,
                          int cell, int &first, int &last) {
    const float corner = lattice_coordinate(origin, mesh.step, cell);
    first = max(__float2int_ru((low + span.low - mesh.slack - corner) * inverse_step), 1 - mesh.reach);
    last = min(__float2int_rd((high + span.high + mesh.slack - corner) * inverse_step), mesh.reach);
}

// The box of light points that a triangle can hide, packed: six numbers of five bits, each offset + BOX_BIAS; `false` if there is none.
DEVICE bool shadow_box(const LightMesh &mesh, const CellBundle &bundle, const Vec3 &a, const Vec3 &b, const Vec3 &c, unsigned &box,
                       Span &own_x, Span &own_y, Span &own_z, float &most) {
    const float reach = mesh.radius + mesh.slack;
    // 1. All q - P.
    Span x = span_to(bundle.low.x, bundle.high.x, a.x, b.x, c.x, mesh.slack);
    Span y = span_to(bundle.low.y, bundle.high.y, a.y, b.y, c.y, mesh.slack);
    Span z = span_to(bundle.low.z, bundle.high.z, a.z, b.z, c.z, mesh.slack);
    own_x = x;
    own_y = y;
    own_z = z;
    // 2. All s (q - P) within the ball. An unbounded s leaves the box of the ball itself.
    const float apart = distance_apart(x, y, z);
    if (apart > reach)
        return false;
    most = most_stretch(apart, reach);
    stretch(x, most, reach);
    stretch(y, most, reach);
    stretch(z, most, reach);
    // 3. In steps from the cell.
    int x0, x1, y0, y1, z0, z1;
    span_in_steps(mesh, bundle.inverse_step, x, bundle.low.x, bundle.high.x, mesh.anchor.x, bundle.cell.x, x0, x1);
    span_in_steps(mesh, bundle.inverse_step, y, bundle.low.y, bundle.high.y, mesh.anchor.y, bundle.cell.y, y0, y1);
    span_in_steps(mesh, bundle.inverse_step, z, bundle.low.z, bundle.high.z, mesh.anchor.z, bundle.cell.z, z0, z1);
    box = (unsigned)(x0 + BOX_BIAS) | (unsigned)(x1 + BOX_BIAS) << 5 | (unsigned)(y0 + BOX_BIAS) << 10 |
          (unsigned)(y1 + BOX_BIAS) << 15 | (unsigned)(z0 + BOX_BIAS) << 20 | (unsigned)(z1 + BOX_BIAS) << 25;
    return x0 <= x1 && y0 <= y1 && z0 <= z1;
}

// A number of a packed box.
DEVICE int box_bound(unsigned box, int index) {
    return (int)(box >> 5 * index & 31) - BOX_BIAS;
}

// 3. b. Lanes take up to 32 of the triangles found; those that can matter are kept as candidates. Returns how many rows of light
// points the lane's candidate reaches; candidates are in the order of the lanes, and `count` becomes their number.
template <class Structure>
DEVICE unsigned choose_candidates(const LightMesh &mesh, const CellBundle &bundle, const Structure &structure, const CellMemory &memory,
                                  unsigned first, unsigned &count) {
    const unsigned lane = lane_of_thread();
    bool kept = false;
    unsigned box = 0;
    Corners corners;
    Span x, y, z;
    float most = 0.0f;
    if (lane < count) {
        corners = load_corners(triangle_at(structure, memory.found[first + lane]));
        const Vec3 a = corners.a, b = corners.b, c = corners.c;
        kept = !is_behind(bundle, a, b, c) && plane_is_near(bundle, a, b, c, mesh.radius + mesh.slack) &&
               shadow_box(mesh, bundle, a, b, c, box, x, y, z, most);
    }
    const unsigned lanes = __ballot_sync(ALL_LANES, kept);
    if (kept) {
        const Vec3 a = corners.a, b = corners.b, c = corners.c;
        Candidate &candidate = memory.candidates[__popc(lanes & lanes_below(lane))];
        candidate.corners[0] = float4{a.x, a.y, a.z, __uint_as_float(box)};
        candidate.corners[1] = float4{b.x, b.y, b.z, x.low};
        candidate.corners[2] = float4{c.x, c.y, c.z, x.high};
        candidate.span_yz = float4{y.low, y.high, z.low, z.high};
        candidate.inverse_yz = float4{1.0f / y.low, 1.0f / y.high, 1.0f / z.low, 1.0f / z.high};
        const unsigned cut = alpha_mask_of(structure) != nullptr ? triangle_cut(triangle_at(structure, memory.found[first + lane])) : 0;
        candidate.most =
            float4{most, 1.0f / (float)(box_bound(box, 3) - box_bound(box, 2) + 1), __uint_as_float(cut), 0.0f};
    }
    __syncwarp();
    count = __popc(lanes);
    if (lane >= count)
        return 0;
    box = __float_as_uint(memory.candidates[lane].corners[0].w);
    return (box_bound(box, 3) - box_bound(box, 2) + 1) * (box_bound(box, 5) - box_bound(box, 4) + 1);
}
