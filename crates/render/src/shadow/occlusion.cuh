// Which samples of a light a triangle hides from a surface point: twin of occlusion.rs, bit by bit.
#pragma once

#include "accel/triangle.cuh"
#include "shadow/sight.cuh"

// A triangle with what is the same for all surface points.
struct Occluding {
    Vec3 a, b, c;
    // Opposite to each corner.
    Vec3 edge_a, edge_b, edge_c;
    Vec3 plane;
};

DEVICE Occluding occluding(const Corners &corners) {
    const Vec3 &a = corners.a, &b = corners.b, &c = corners.c;
    const Vec3 edge_b = a - c, edge_c = b - a;
    return Occluding{a, b, c, c - b, edge_b, edge_c, fused_cross(edge_b, edge_c)};
}

// `start + x · (step in x) + y · (step in y)`.
struct Linear {
    float start, x, y;
};

// The function n · d on the emitter.
DEVICE Linear linear(const Sight &sight, const Vec3 &n) {
    return Linear{fused_dot(n, sight.center), fused_dot(n, sight.along), fused_dot(n, sight.across)};
}

// More than a function changes from the middle of the emitter to any sample.
DEVICE float range_of(const Linear &f) { return (fabsf(f.x) + fabsf(f.y) + fabsf(f.y)) * 1.01f; }

// The planes through a surface point and the edges of a triangle, and its own.
struct Facets {
    Linear sides[3];
    Linear beyond;
    // Whether positive functions are inside.
    bool outer;
    // Whether the triangle may hide anything.
    bool matters;
};

DEVICE Facets facets_of(const SurfacePoint &point, const Sight &sight, const Occluding &triangle) {
    const Vec3 a = triangle.a - point.origin, b = triangle.b - point.origin, c = triangle.c - point.origin;
    const Vec3 &n = point.normal;
    const bool above = fused_dot(n, a) > 0.0f || fused_dot(n, b) > 0.0f || fused_dot(n, c) > 0.0f;
    const float volume = fused_dot(triangle.plane, a);
    Facets facets;
    facets.outer = volume > 0.0f;
    facets.matters = above && (volume > 0.0f || volume < 0.0f);
    facets.sides[0] = linear(sight, fused_cross(b + c, triangle.edge_a));
    facets.sides[1] = linear(sight, fused_cross(c + a, triangle.edge_b));
    facets.sides[2] = linear(sight, fused_cross(a + b, triangle.edge_c));
    facets.beyond = linear(sight, triangle.plane);
    facets.beyond.start = fmaf(-volume, sight.end, facets.beyond.start);
    return facets;
}

// Bounds of x on a row at y: the largest `low_start + y low_step` and the smallest of `high`.
template <unsigned COUNT>
struct RowBounds {
    float low_start[COUNT], low_step[COUNT], high_start[COUNT], high_step[COUNT];
};

// Cuts off where the function is negative, or positive if not `outer`.
template <unsigned COUNT>
DEVICE void cut(RowBounds<COUNT> &bounds, unsigned k, const Linear &f, bool outer) {
    const float slope = fabsf(f.x) < LEAST_SLOPE ? copysignf(LEAST_SLOPE, f.x) : f.x;
    const float inverse = -1.0f / slope;
    const float start = f.start * inverse, step = f.y * inverse;
    const bool low = (slope > 0.0f) == outer;
    bounds.low_start[k] = low ? start : -BEYOND;
    bounds.low_step[k] = low ? step : 0.0f;
    bounds.high_start[k] = low ? BEYOND : start;
    bounds.high_step[k] = low ? 0.0f : step;
}

// All bits from `first` on; none from 32 on.
DEVICE unsigned bits_from(unsigned first) { return __funnelshift_lc(0u, ~0u, first); }

// The samples of a row within the bounds, as its lowest bits. `offset` is the place of x = 0.
template <unsigned COUNT>
DEVICE unsigned row_bits(const RowBounds<COUNT> &bounds, const SampleRows &set, unsigned row, float offset) {
    const float y = set.y[row], density = set.density[row];
    float low = fmaf(bounds.low_step[0], y, bounds.low_start[0]), high = fmaf(bounds.high_step[0], y, bounds.high_start[0]);
    UNROLL
    for (unsigned k = 1; k < COUNT; ++k) {
        low = fmaxf(low, fmaf(bounds.low_step[k], y, bounds.low_start[k]));
        high = fminf(high, fmaf(bounds.high_step[k], y, bounds.high_start[k]));
    }
    const unsigned first = __float2uint_ru(fmaf(low, density, offset)), end = __float2uint_rd(fmaf(high, density, offset + 1.0f));
    return bits_from(first) & ~bits_from(end) & ~bits_from(set.count[row]);
}

// The samples within the bounds. `offsets` has those of the rows, STRIDE apart.
template <unsigned WORDS, unsigned STRIDE, unsigned COUNT>
DEVICE void set_bits(const RowBounds<COUNT> &bounds, const SampleRows &set, const float *offsets, unsigned *bits) {
    unsigned row = 0;
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word) {
        unsigned all = 0;
        for (; row < set.ends[word]; ++row)
            all |= row_bits(bounds, set, row, offsets[row * STRIDE]) << set.place[row];
        bits[word] = all;
    }
}

// The samples that count and are in front of the surface, before anything hides them.
template <unsigned WORDS, unsigned STRIDE>
DEVICE void samples_above_horizon(const SurfacePoint &point, const Sight &sight, const SampleRows &set, const float *offsets,
                                  unsigned *bits) {
    RowBounds<1> bounds;
    cut(bounds, 0, linear(sight, point.normal), true);
    set_bits<WORDS, STRIDE>(bounds, set, offsets, bits);
    unsigned row = 0;
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word) {
        unsigned valid = 0;
        for (; row < set.ends[word]; ++row)
            valid |= valid_samples(sight, set, row) << set.place[row];
        bits[word] &= valid;
    }
}

// Whether the centre is in front of the surface.
DEVICE bool center_above_horizon(const SurfacePoint &point, const Sight &sight) {
    return fused_dot(point.normal, sight.center) > 0.0f;
}

// Whether a function is certainly negative on the whole emitter; positive if not `outer`.
DEVICE bool never(const Linear &f, bool outer) { return (outer ? f.start : -f.start) < -range_of(f); }

// Clears the bits of the samples that a triangle hides. The lanes of a warp come together; only those that are `alive` matter.
template <unsigned WORDS, unsigned STRIDE>
DEVICE void hide(const SurfacePoint &point, const Sight &sight, const Occluding &triangle, const SampleRows &set,
                 const float *offsets, bool alive, unsigned *seen) {
    const Facets facets = facets_of(point, sight, triangle);
    const bool passed =
        never(facets.sides[0], facets.outer) || never(facets.sides[1], facets.outer) || never(facets.sides[2], facets.outer);
    const bool matters = alive && facets.matters && !passed;
    if (!__any_sync(ALL_LANES, matters))
        return;
    unsigned hidden[WORDS];
    // All of most emitters lies beyond the plane; then that bounds no row.
    const bool clear = (facets.outer ? facets.beyond.start : -facets.beyond.start) > range_of(facets.beyond);
    if (__any_sync(ALL_LANES, matters && !clear)) {
        RowBounds<4> bounds;
        UNROLL
        for (unsigned k = 0; k < 3; ++k)
            cut(bounds, k, facets.sides[k], facets.outer);
        cut(bounds, 3, facets.beyond, facets.outer);
        set_bits<WORDS, STRIDE>(bounds, set, offsets, hidden);
    } else {
        RowBounds<3> bounds;
        UNROLL
        for (unsigned k = 0; k < 3; ++k)
            cut(bounds, k, facets.sides[k], facets.outer);
        set_bits<WORDS, STRIDE>(bounds, set, offsets, hidden);
    }
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word)
        seen[word] &= matters ? ~hidden[word] : ~0u;
}

// Whether a triangle hides the centre.
DEVICE bool hides_center(const SurfacePoint &point, const Sight &sight, const Occluding &triangle) {
    const Facets facets = facets_of(point, sight, triangle);
    const float u = facets.sides[0].start, v = facets.sides[1].start, w = facets.sides[2].start, q = facets.beyond.start;
    const float least = fminf(fminf(u, v), fminf(w, q)), most = fmaxf(fmaxf(u, v), fmaxf(w, q));
    return facets.matters && (facets.outer ? least >= 0.0f : most <= 0.0f);
}
