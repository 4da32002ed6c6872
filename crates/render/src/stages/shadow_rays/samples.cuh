// Rays to the samples of a light, one thread per surface point: what sample_rays and the second step of adaptive shadow rays share.
#pragma once

#include "data/rays.cuh"
#include "shadow/seen.cuh"
#include "shadow/shadow.cuh"

// Casts a ray to each sample of a row. Returns how many arrive.
template <class Structure>
DEVICE unsigned trace_row(const Shadows &args, const Structure &structure, const SurfacePoint &point, const Sight &projected,
                          const SampleRows &set, unsigned row, float scale, unsigned &last, unsigned &cast) {
    unsigned seen = 0;
    for (unsigned rest = valid_samples(projected, set, row); rest != 0; rest &= rest - 1) {
        const Vec3 target = point.origin + sample_at(projected, set, row, __ffs(rest) - 1, scale);
        if (!(dot(point.normal, target - point.origin) > 0.0f))
            continue;
        ++cast;
        seen += !occluded(structure, args.tally, long_segment(point.origin, target), last);
    }
    return seen;
}

// Casts a ray from a surface point to each sample of light number `index`. Returns how many arrive.
template <class Structure>
DEVICE unsigned trace_samples(const Shadows &args, const Structure &structure, const SurfacePoint &point, unsigned index,
                              unsigned ray, Shape shape, unsigned &cast) {
    const Light &light = args.scene.lights[index];
    if (shape == SHAPE_POINT) {
        const Vec3 middle = light_center(light, point.origin, scene_reach(args.scene, point.origin));
        cast = dot(point.normal, middle - point.origin) > 0.0f;
        return cast && !hidden(structure, args.tally, light, point.origin, middle);
    }
    const SampleRows &set = args.sets[shape];
    const Sight projected = projected_light_of(args.scene, args.sampling, index, shape, set.lines, point, ray_key(args.rays, ray));
    unsigned seen = 0, last = Hit::NONE;
    for (unsigned row = 0; row < set.rows; ++row)
        seen += trace_row(args, structure, point, projected, set, row, light.scale, last, cast);
    return seen;
}
