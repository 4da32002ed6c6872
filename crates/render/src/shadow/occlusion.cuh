// Which samples of a light a triangle hides from a surface point: twin of occlusion.rs, bit by bit.
#pragma once

#include "accel/alpha_mask.cuh"
#include "shadow/projected_light.cuh"

// A triangle with what is the same for all surface points: three corners, and in their last words the normal.
struct Occluding {
    float4 parts[3];
};

DEVICE Vec3 corner_of(const float4 *triangle, unsigned k) { return Vec3{triangle[k].x, triangle[k].y, triangle[k].z}; }

// The edge opposite to a corner.
DEVICE Vec3 edge_of(const float4 *triangle, unsigned k) { return corner_of(triangle, (k + 2) % 3) - corner_of(triangle, (k + 1) % 3); }

DEVICE Vec3 plane_of(const float4 *triangle) { return Vec3{triangle[0].w, triangle[1].w, triangle[2].w}; }

DEVICE Occluding occluding(const Corners &corners) {
    const Vec3 &a = corners.a, &b = corners.b, &c = corners.c, plane = fused_cross(a - c, b - a);
    return Occluding{float4{a.x, a.y, a.z, plane.x}, float4{b.x, b.y, b.z, plane.y}, float4{c.x, c.y, c.z, plane.z}};
}

// `start + x · (step in x) + y · (step in y)`.
struct Linear {
    float start, x, y;
};

// The function n · d on the emitter.
DEVICE Linear linear(const Sight &projected, const Vec3 &n) {
    return Linear{fused_dot(n, projected.center), fused_dot(n, projected.along), fused_dot(n, projected.across)};
}

// More than a function changes from the middle of the emitter to any sample.
DEVICE float range_of(const Linear &f) { return (fabsf(f.x) + fabsf(f.y) + fabsf(f.y)) * 1.01f; }

// A triangle as a surface point sees it.
struct Seeing {
    // The corners.
    Vec3 a, b, c;
    float volume;
    // Whether it may hide anything.
    bool matters;
};

DEVICE Seeing seeing(const SurfacePoint &point, const float4 *triangle) {
    const Vec3 a = corner_of(triangle, 0) - point.origin, b = corner_of(triangle, 1) - point.origin,
               c = corner_of(triangle, 2) - point.origin;
    const Vec3 &n = point.normal;
    const bool above = fused_dot(n, a) > 0.0f || fused_dot(n, b) > 0.0f || fused_dot(n, c) > 0.0f;
    const float volume = fused_dot(plane_of(triangle), a);
    return Seeing{a, b, c, volume, above && (volume > 0.0f || volume < 0.0f)};
}

// The normals of the planes through the surface point and an edge.
DEVICE Vec3 side(const Seeing &seen, const float4 *triangle, unsigned k) {
    const Vec3 sum = k == 0 ? seen.b + seen.c : k == 1 ? seen.c + seen.a : seen.a + seen.b;
    return fused_cross(sum, edge_of(triangle, k));
}

// Bounds of x on a row at y: the largest `low + y step` and the smallest `high + y step`. An edge bounds one side only; on the other its
// start lies far beyond, whatever the step.
template <unsigned COUNT>
struct RowBounds {
    float low[COUNT], high[COUNT], step[COUNT];
};

// Cuts off where the function is negative, or positive if not `outer`.
template <unsigned COUNT>
DEVICE void cut(RowBounds<COUNT> &bounds, unsigned k, const Linear &f, bool outer) {
    const float slope = fabsf(f.x) < MIN_SLOPE ? copysignf(MIN_SLOPE, f.x) : f.x;
    const float inverse = -(1.0f / slope);
    const float start = f.start * inverse;
    const bool low = (slope > 0.0f) == outer;
    bounds.low[k] = low ? start : -UNBOUNDED;
    bounds.high[k] = low ? UNBOUNDED : start;
    bounds.step[k] = f.y * inverse;
}

// All bits from `first` on; none from 32 on.
DEVICE unsigned bits_from(unsigned first) { return __funnelshift_lc(0u, ~0u, first); }

// Rows of samples in shared memory.
struct RowTable {
    // y, density, the bits of all samples, and the place of the first in its word.
    const float4 *rows;
    // The end of each word's rows.
    const unsigned *ends;
    // The place of x = 0 in each row of a surface point's samples, WARP apart.
    float *offsets;
};

// Fills the table of a shape; `shared` has ROW_TABLE_WORDS.
DEVICE void fill_row_table(const SampleRows &set, unsigned *shared) {
    const unsigned lane = lane_of_thread();
    if (lane < MAX_ROWS) {
        const unsigned samples = (1u << set.count[lane]) - 1;
        reinterpret_cast<float4 *>(shared)[lane] =
            float4{set.y[lane], set.density[lane], __uint_as_float(samples), __uint_as_float(set.place[lane])};
    }
    if (lane < MAX_WORDS)
        shared[4 * MAX_ROWS + lane] = set.ends[lane];
    __syncwarp();
}

// The table of a shape, of the tables of discs and rectangles.
DEVICE RowTable row_table(const unsigned *tables, Shape shape, float *offsets) {
    const unsigned *own = tables + (shape == SHAPE_RECTANGLE ? ROW_TABLE_WORDS : 0);
    return RowTable{reinterpret_cast<const float4 *>(own), own + 4 * MAX_ROWS, offsets};
}

// The samples of a row within the first COUNT bounds, in their places. `offset` is the place of x = 0.
template <unsigned COUNT, class Bounds>
DEVICE unsigned row_bits(const Bounds &bounds, const float4 &row, float offset) {
    const float y = row.x, density = row.y;
    float low = fmaf(bounds.step[0], y, bounds.low[0]), high = fmaf(bounds.step[0], y, bounds.high[0]);
    UNROLL
    for (unsigned k = 1; k < COUNT; ++k) {
        low = fmaxf(low, fmaf(bounds.step[k], y, bounds.low[k]));
        high = fminf(high, fmaf(bounds.step[k], y, bounds.high[k]));
    }
    const unsigned first = __float2uint_ru(fmaf(low, density, offset)), end = __float2uint_rd(fmaf(high, density, offset + 1.0f));
    return (bits_from(first) & ~bits_from(end) & __float_as_uint(row.z)) << __float_as_uint(row.w);
}

// The samples within the first COUNT bounds.
template <unsigned WORDS, unsigned COUNT, class Bounds>
DEVICE void set_bits(const Bounds &bounds, const RowTable &table, unsigned *bits) {
    unsigned row = 0;
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word) {
        unsigned all = 0;
        ROLLED
        for (const unsigned end = table.ends[word]; row < end; ++row)
            all |= row_bits<COUNT>(bounds, table.rows[row], table.offsets[row * WARP]);
        bits[word] = all;
    }
}

// The samples that count and are in front of the surface, before anything hides them.
template <unsigned WORDS>
DEVICE void samples_above_horizon(const SurfacePoint &point, const Sight &projected, const SampleRows &set, const RowTable &table,
                                  unsigned *bits) {
    RowBounds<1> bounds;
    cut(bounds, 0, linear(projected, point.normal), true);
    set_bits<WORDS, 1>(bounds, table, bits);
    unsigned row = 0;
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word) {
        unsigned valid = 0;
        ROLLED
        for (; row < set.ends[word]; ++row)
            valid |= valid_samples(projected, set, row) << set.place[row];
        bits[word] &= valid;
    }
}

// Whether the centre is in front of the surface.
DEVICE bool center_above_horizon(const SurfacePoint &point, const Sight &projected) {
    return fused_dot(point.normal, projected.center) > 0.0f;
}

// Whether a function is certainly negative on the whole emitter; positive if not `outer`.
DEVICE bool never(const Linear &f, bool outer) { return (outer ? f.start : -f.start) < -range_of(f); }

// A triangle by its parts, and where it is cut out. The number of its opacities, 0 if it is opaque, is only read with an alpha mask.
struct Hiding {
    const float4 *parts;
    const AlphaMask *alpha_mask;
    const unsigned *cut;
};

DEVICE Corners corners_of(const float4 *triangle) {
    return Corners{corner_of(triangle, 0), corner_of(triangle, 1), corner_of(triangle, 2)};
}

// Bits of samples, by word.
template <unsigned WORDS>
struct Samples {
    unsigned bits[WORDS];
};

// Where the samples of a light are, seen from `origin` and scaled: at `center + x · along + y · across`.
struct Lines {
    Vec3 origin, center, along, across;
};

// Those of some samples whose ray a triangle stops where it is not cut out.
template <unsigned WORDS>
COLD Samples<WORDS> stopped_samples(AlphaMask alpha_mask, unsigned cut, Corners corners, Lines from, RowTable table,
                                    Samples<WORDS> samples) {
    if (cut == 0)
        return samples;
    unsigned row = 0;
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word) {
        unsigned bits = samples.bits[word];
        ROLLED
        for (const unsigned end = table.ends[word]; row < end; ++row) {
            const float4 own = table.rows[row];
            const unsigned first = __float_as_uint(own.w);
            for (unsigned rest = bits & __float_as_uint(own.z) << first; rest != 0; rest &= rest - 1) {
                const unsigned bit = __ffs(rest) - 1;
                const float x = ((float)(bit - first) - table.offsets[row * WARP]) / own.y;
                if (!stops_cut(alpha_mask, cut, corners, from.origin, from.center + x * from.along + own.x * from.across))
                    bits &= ~(1u << bit);
            }
        }
        samples.bits[word] = bits;
    }
    return samples;
}

// Clears the bits of the samples that a triangle hides. The lanes of a warp come together; only those that are `alive` matter.
template <unsigned WORDS>
DEVICE void hide(const SurfacePoint &point, const Sight &projected, const Hiding &hiding, const RowTable &table, bool alive,
                 unsigned *seen) {
    const float4 *triangle = hiding.parts;
    const Seeing own = seeing(point, triangle);
    const bool outer = own.volume > 0.0f;
    // Most triangles are passed by on the outer side of an edge.
    Linear sides[3];
    bool matters = alive && own.matters;
    UNROLL
    for (unsigned k = 0; k < 3; ++k) {
        sides[k] = linear(projected, side(own, triangle, k));
        matters = matters && !never(sides[k], outer);
    }
    if (!__any_sync(ALL_LANES, matters))
        return;
    Linear beyond = linear(projected, plane_of(triangle));
    beyond.start = fmaf(-own.volume, projected.end, beyond.start);
    // All of most emitters lies beyond the plane; then that bounds no row.
    const bool clear = (outer ? beyond.start : -beyond.start) > range_of(beyond);
    unsigned hidden[WORDS];
    RowBounds<4> bounds;
    UNROLL
    for (unsigned k = 0; k < 3; ++k)
        cut(bounds, k, sides[k], outer);
    if (__any_sync(ALL_LANES, matters && !clear)) {
        cut(bounds, 3, beyond, outer);
        set_bits<WORDS, 4>(bounds, table, hidden);
    } else {
        set_bits<WORDS, 3>(bounds, table, hidden);
    }
    if (hiding.alpha_mask != nullptr) {
        Samples<WORDS> all;
        UNROLL
        for (unsigned word = 0; word < WORDS; ++word)
            all.bits[word] = matters ? hidden[word] & seen[word] : 0;
        const Lines from = {point.origin, projected.center, projected.along, projected.across};
        all = stopped_samples<WORDS>(*hiding.alpha_mask, *hiding.cut, corners_of(triangle), from, table, all);
        UNROLL
        for (unsigned word = 0; word < WORDS; ++word)
            hidden[word] = all.bits[word];
    }
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word)
        seen[word] &= matters ? ~hidden[word] : ~0u;
}

// Whether a triangle hides the centre.
DEVICE bool hides_center(const SurfacePoint &point, const Sight &projected, const Hiding &hiding) {
    const float4 *triangle = hiding.parts;
    const Seeing own = seeing(point, triangle);
    const float beyond = fmaf(-own.volume, projected.end, fused_dot(plane_of(triangle), projected.center));
    float least = beyond, most = beyond;
    UNROLL
    for (unsigned k = 0; k < 3; ++k) {
        const float f = fused_dot(side(own, triangle, k), projected.center);
        least = fminf(least, f);
        most = fmaxf(most, f);
    }
    const bool hides = own.matters && (own.volume > 0.0f ? least >= 0.0f : most <= 0.0f);
    if (!hides || hiding.alpha_mask == nullptr || *hiding.cut == 0)
        return hides;
    return stops_cut(*hiding.alpha_mask, *hiding.cut, corners_of(triangle), point.origin, projected.center);
}
