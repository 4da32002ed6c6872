// What an object point sees of a light: twin of mod.rs and of `fallback` in cpu.rs.
#pragma once

#include "accel/walk.cuh"
#include "cuda/tally.cuh"
#include "sampling.cuh"
#include "surface.cuh"

// χ of formula (3) for a light that stands across the horizon: the share of it above.
COLD float share_above_horizon(SurfacePoint point, const Light *light, float reach) {
    const Pattern pattern = pattern_of(0, 0, 0);
    unsigned above = 0;
    for (unsigned index = 0; index < HORIZON_SAMPLES; ++index) {
        const Vec3 target = light_point(*light, point.origin, reach, pattern_point(pattern, index));
        above += dot(point.normal, target - point.origin) > 0.0f;
    }
    return (float)above / (float)HORIZON_SAMPLES;
}

// χ of formula (3) for a light: 1 where it is on the outer side of the surface at `point`, 0 where it is behind.
DEVICE float above_horizon(const SurfacePoint &point, const Light &light, float reach) {
    const float height = dot(point.normal, light_center(light, point.origin, reach) - point.origin);
    if (fabsf(height) >= light.size)
        return height > 0.0f ? 1.0f : 0.0f;
    return share_above_horizon(point, &light, reach);
}

// Whether a ray from an object point reaches `target`, which is in front of its surface.
template <class Structure>
DEVICE bool reaches(const Structure &structure, const Tally &tally, const SurfacePoint &point, Vec3 target) {
    return !occluded(structure, tally, long_segment(point.origin, target));
}

// The visible share of light number `index` from an object point, without χ: the fallback where no light point is used.
template <class Structure>
DEVICE float fallback_share(const Structure &structure, const Scene &scene, const Sampling &sampling, const Tally &tally,
                            const SurfacePoint &point, unsigned long long key, unsigned index) {
    const Light &light = scene.lights[index];
    const float reach = scene_reach(scene, point.origin);
    const bool sized = has_size(light);
    const unsigned samples = sized ? sampling.samples : 1;
    const Pattern pattern = pattern_of(sampling.seed, key, index);
    unsigned cast = 0, seen = 0;
    for (unsigned sample = 0; sample < samples; ++sample) {
        const Vec3 target = sized ? light_point(light, point.origin, reach, pattern_point(pattern, sample))
                                  : light_center(light, point.origin, reach);
        if (!(dot(point.normal, target - point.origin) > 0.0f))
            continue;
        ++cast;
        seen += reaches(structure, tally, point, target);
    }
    atomicAdd(&tally_shard(tally).shadow_rays, (unsigned long long)cast);
    return (float)seen / (float)samples;
}
