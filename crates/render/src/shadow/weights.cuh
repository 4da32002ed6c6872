// How much each sample of a light counts where the light is near or wide: twin of weights.rs.
#pragma once

#include "shading/irradiance.cuh"
#include "shadow/seen.cuh"

// The weight of the sample at `way` of a light at a surface with this normal; not above 0 if it is below a horizon.
DEVICE float weight_of(const Light &light, Vec3 normal, Vec3 way) {
    const float square = length_squared(way), above = dot(normal, way);
    float emitted = 1.0f;
    if (light.surface)
        emitted = larger(-dot(light.direction, way), 0.0f);
    else if (light.kind == Light::DISK || light.kind == Light::RECTANGLE)
        emitted = sqrtf(square);
    return above * emitted / (square * square);
}

// The sums of the weights of a set's samples, and of those that are seen.
struct WeightSums {
    float all, lit;
};

// A function of its own, so that its callers keep their registers.
template <unsigned WORDS>
COLD WeightSums weights_of(const Light *light, Vec3 normal, Sight projected, const SampleRows *set, RowTable table,
                           Seen<WORDS> seen) {
    const Vec3 sizes = max(max(abs(projected.center), abs(projected.along)), abs(projected.across));
    const float scale = 1.0f / larger(max_element(sizes), F32_MIN_POSITIVE);
    WeightSums sums = {0.0f, 0.0f};
    unsigned row = 0;
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word) {
        const unsigned bits = seen.bits[word];
        ROLLED
        for (const unsigned end = table.ends[word]; row < end; ++row) {
            const float4 own = table.rows[row];
            const float offset = table.offsets[row * WARP];
            for (unsigned rest = valid_samples(projected, *set, row); rest != 0; rest &= rest - 1) {
                const unsigned place = __ffs(rest) - 1;
                const float x = ((float)place - offset) / own.y;
                const Vec3 way = projected.center + x * projected.along + own.x * projected.across;
                const float weight = weight_of(*light, normal, scale * way);
                if (!(weight > 0.0f))
                    continue;
                sums.all += weight;
                if (bits >> (__float_as_uint(own.w) + place) & 1)
                    sums.lit += weight;
            }
        }
    }
    return sums;
}

// How near a light is to a surface point; 0: its samples are counted.
DEVICE float nearness_of(const Shadows &args, Shape shape, const Light &light, const SurfacePoint &point) {
    if (shape == SHAPE_POINT || light.kind == Light::POINT)
        return 0.0f;
    return nearness(light, light_center(light, point.origin, scene_reach(args.scene, point.origin)) - point.origin);
}

// Whether counting is enough: there are no more sets, and all samples above the horizon are seen, or none.
DEVICE bool is_plain(const Shadows &args, unsigned above, unsigned seen) { return args.set_count == 1 && (seen == above || seen == 0); }

// The visible share of a light: exactly 1 for all of it.
DEVICE float weighed_share(const Weighed &weighed, float nearness) {
    if (weighed.seen == 0)
        return 0.0f;
    if (weighed.seen == weighed.above)
        return 1.0f;
    const float counted = (float)weighed.seen / (float)weighed.above;
    const float share = weighed.all > 0.0f ? weighed.lit / weighed.all : counted;
    return counted + nearness * (share - counted);
}

// Adds what a lane sees of a light that is near with this set of samples to its share.
DEVICE void add_weighed(const Shadows &args, unsigned light, unsigned ray, float nearness, Weighed weighed) {
    const unsigned long long place = (unsigned long long)light * args.rays.count + ray;
    if (args.set_count > 1) {
        Weighed &sums = args.weighed[place];
        if (args.set != 0)
            weighed = Weighed{sums.above + weighed.above, sums.seen + weighed.seen, sums.all + weighed.all, sums.lit + weighed.lit};
        sums = weighed;
    }
    if (args.set + 1 == args.set_count)
        args.share[place] = weighed_share(weighed, nearness);
}
