// Rays to the samples of a light through a BVH, one after another: twin of sample_ray.rs. Whether a triangle hides a sample is decided as for a
// row of samples, with the bits of `hide`.
#pragma once

#include "accel/bvh/walk.cuh"
#include "shadow/seen.cuh"

// A ray to one sample.
struct SampleRay {
    const SurfacePoint &point;
    const Sight &projected;
    // The row of samples, the place of x = 0 in it, and the sample's bit in its word.
    float4 row;
    float offset;
    unsigned bit;
    // The place of a triangle that hides it.
    unsigned hit;
};

DEVICE float limit(const SampleRay &) { return 1.0f; }

// The sample, seen from the point and scaled.
DEVICE Vec3 target_of(const SampleRay &ray) {
    const float x = ((float)(ray.bit - __float_as_uint(ray.row.w)) - ray.offset) / ray.row.y;
    return ray.projected.center + x * ray.projected.along + ray.row.x * ray.projected.across;
}

// Whether a triangle hides the sample: as `hide`, for a lane on its own.
DEVICE bool hides_sample(const SampleRay &ray, const Hiding &hiding) {
    const float4 *triangle = hiding.parts;
    const Seeing own = seeing(ray.point, triangle);
    if (!own.matters)
        return false;
    const bool outer = own.volume > 0.0f;
    RowBounds<4> bounds;
    UNROLL
    for (unsigned k = 0; k < 3; ++k) {
        const Linear f = linear(ray.projected, side(own, triangle, k));
        if (never(f, outer))
            return false;
        cut(bounds, k, f, outer);
    }
    Linear beyond = linear(ray.projected, plane_of(triangle));
    beyond.start = fmaf(-own.volume, ray.projected.end, beyond.start);
    cut(bounds, 3, beyond, outer);
    if (!(row_bits<4>(bounds, ray.row, ray.offset) >> ray.bit & 1))
        return false;
    if (hiding.alpha_mask == nullptr || *hiding.cut == 0)
        return true;
    return stops_cut(*hiding.alpha_mask, *hiding.cut, corners_of(triangle), ray.point.origin, target_of(ray));
}

template <class Structure, class Set>
DEVICE bool ask(SampleRay &ray, const Structure &structure, Set set) {
    unsigned triangle;
    while (take(set, triangle)) {
        const auto handle = triangle_at(structure, triangle);
        const Occluding own = occluding(load_corners(handle));
        if (hides_sample(ray, Hiding{own.parts, alpha_mask_of(structure), cut_of(handle)})) {
            ray.hit = noted_place(structure, triangle);
            return false;
        }
    }
    return true;
}

// Casts rays to the samples in `seen`, and clears those that do not arrive. `scale` is that of the light.
template <unsigned WORDS, class Tree>
DEVICE void cast_to_samples(const Tree &tree, float scale, const SurfacePoint &point, const Sight &projected, const RowTable &table,
                            Seen<WORDS> &seen) {
    const Vec3 size = abs(projected.center) + abs(projected.along) + abs(projected.across);
    const float slack = SHADOW_MARGIN * max_element(size) / scale;
    unsigned last = Hit::NONE, row = 0;
    ROLLED
    for (unsigned word = 0; word < WORDS; ++word) {
        ROLLED
        for (const unsigned end = table.ends[word]; row < end; ++row) {
            const float4 own = table.rows[row];
            const unsigned samples = __float_as_uint(own.z) << __float_as_uint(own.w);
            for (unsigned rest = seen.bits[word] & samples; rest != 0; rest &= rest - 1) {
                SampleRay ray = {point, projected, own, table.offsets[row * WARP], (unsigned)__ffs(rest) - 1, Hit::NONE};
                if (last == Hit::NONE || ask(ray, tree, Run{last, last + 1}))
                    walk_segment(tree, point.origin, target_of(ray) / scale, slack, ray);
                if (ray.hit == Hit::NONE)
                    continue;
                seen.bits[word] &= ~(1u << ray.bit);
                last = ray.hit;
            }
        }
    }
}
