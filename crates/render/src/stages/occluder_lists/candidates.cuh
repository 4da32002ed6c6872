// Which triangles can hide an emitter from a box of surface points, one triangle per lane: twin of candidates.rs, where the bounds are
// derived.
#pragma once

#include "accel/region_filter.cuh"
#include "shadow/occlusion.cuh"

// The boxes of a bundle and an emitter.
struct Shaft {
    // The middle of the box around the surface points, and half its edges.
    Vec3 middle, half;
    // The middle of the emitter's box, relative to the other, and half its edges.
    Vec3 emitter, emitter_half;
    // No sample is farther from the middle.
    float radius;
    // The square of the radius of an emissive ball about that middle: what lies in it hides nothing.
    float body;
    // Sums over the axes: the points' farthest, and the samples'. Products of half diagonals.
    float reach, far, diagonals;
};

// Half the edges of a box, and a little more.
DEVICE Vec3 grown_half(const Bounds &bounds) {
    return 0.5f * ENLARGEMENT * (bounds.high - bounds.low) + 2.0f * UNIT_ROUNDOFF * abs(bounds.low + bounds.high);
}

// The length of a vector, rounded up.
DEVICE float length_bound(const Vec3 &v) { return ENLARGEMENT * rough_root(fused_dot(v, v)); }

DEVICE Shaft shaft_of(const Bounds &origins, const Bounds &emitter, float radius, float body) {
    Shaft shaft;
    shaft.middle = 0.5f * (origins.low + origins.high);
    shaft.half = grown_half(origins);
    shaft.emitter = 0.5f * (emitter.low + emitter.high) - shaft.middle;
    shaft.emitter_half = grown_half(emitter);
    shaft.radius = ENLARGEMENT * radius;
    shaft.body = body * body;
    shaft.reach = element_sum(shaft.half);
    shaft.far = element_sum(abs(shaft.emitter)) + element_sum(shaft.emitter_half);
    shaft.diagonals = length_bound(shaft.half) * length_bound(shaft.emitter_half);
    return shaft;
}

// The largest product of `v` and a vector in a box of these half edges.
DEVICE float extent_along(const Vec3 &v, const Vec3 &half) { return fused_dot(abs(v), half); }

// The largest product of `v` and the way from the middle of the emitter to a sample.
DEVICE float to_samples(const Shaft &shaft, const Vec3 &v) {
    return fminf(extent_along(v, shaft.emitter_half), length_bound(v) * shaft.radius);
}

// Whether a shaft may meet the bounding box of a triangle.
DEVICE bool in_shaft(const ShaftShape &shaft, const Corners &corners) {
    const Bounds bounds = bounds_of(corners);
    return shape_meets(shaft, bounds.low, bounds.high);
}

// Whether a corner of a triangle may lie above the tangent plane of any of the points, which are not farther than `extent` from the
// lowest corner of their box.
DEVICE bool above_planes(const TangentPlanes &planes, const Vec3 &extent, const Corners &corners) {
    const Vec3 a = corners.a - planes.corner, b = corners.b - planes.corner, c = corners.c - planes.corner;
    const Vec3 far = max(max(abs(a), abs(b)), abs(c)) + extent;
    bool above = planes.count == 0;
    ROLLED
    for (unsigned k = 0; k < planes.count; ++k) {
        const float4 plane = planes.memory->planes[k];
        const Vec3 n = {plane.x, plane.y, plane.z};
        const float top = fmaxf(fmaxf(fused_dot(n, a), fused_dot(n, b)), fused_dot(n, c));
        above |= top + REGION_ROUNDING * fused_dot(abs(n), far) > plane.w;
    }
    return above;
}

enum Choice { DROPPED, KEPT, DARK };

// What becomes of a triangle: it hides nothing, may hide something, or hides everything from all points.
DEVICE Choice choose(const Shaft &shaft, const Occluding &triangle) {
    const float4 *parts = triangle.parts;
    const Vec3 corners[3] = {corner_of(parts, 0) - shaft.middle, corner_of(parts, 1) - shaft.middle,
                             corner_of(parts, 2) - shaft.middle};
    const Vec3 edges[3] = {edge_of(parts, 0), edge_of(parts, 1), edge_of(parts, 2)};
    const float slack = 64.0f * UNIT_ROUNDOFF;

    // The triangle's plane: on which side are the points, and the samples?
    const Vec3 plane = plane_of(parts);
    const float rounding = slack * element_sum(abs(edges[1])) * element_sum(abs(edges[2])), away = element_sum(abs(corners[0]));
    const float points = fused_dot(plane, corners[0]), samples = fused_dot(plane, corners[0] - shaft.emitter);
    const float points_room = extent_along(plane, shaft.half) + rounding * (away + shaft.reach);
    const float samples_room = to_samples(shaft, plane) + rounding * (away + shaft.far);
    const bool points_above = points > points_room, points_below = points < -points_room;
    const bool samples_above = samples > samples_room, samples_below = samples < -samples_room;
    if ((points_above && samples_above) || (points_below && samples_below))
        return DROPPED;
    if (shaft.body > 0.0f) {
        const Vec3 a = corners[0] - shaft.emitter, b = corners[1] - shaft.emitter, c = corners[2] - shaft.emitter;
        if (fmaxf(fmaxf(fused_dot(a, a), fused_dot(b, b)), fused_dot(c, c)) < shaft.body)
            return DROPPED;
    }

    // Its edges.
    unsigned inside = 0, outside = 0;
    UNROLL
    for (unsigned k = 0; k < 3; ++k) {
        const Vec3 &edge = edges[k], sum = corners[(k + 1) % 3] + corners[(k + 2) % 3];
        const Vec3 x = 0.5f * fused_cross(sum, edge);
        const float f = fused_dot(shaft.emitter, x), length = element_sum(abs(edge));
        const Vec3 turned = fused_cross(edge, shaft.emitter) + x;
        const float distances = element_sum(abs(corners[(k + 1) % 3])) + element_sum(abs(corners[(k + 2) % 3])) + 2.0f * shaft.reach;
        const float room = to_samples(shaft, x) + extent_along(turned, shaft.half) + length * shaft.diagonals +
                           slack * length * distances * (shaft.far + shaft.reach);
        outside |= (f < -room ? 1u : 0u) << k;
        inside |= (f > room ? 1u : 0u) << k;
    }
    if ((outside && inside) || (points_above && outside) || (points_below && inside))
        return DROPPED;
    const bool dark = (points_above && samples_below && inside == 7) || (points_below && samples_above && outside == 7);
    return dark ? DARK : KEPT;
}
