// What all stages that cast shadow rays share: where the rays end, whether anything hides a light, and χ of formula (3). Twin of
// mod.rs.
#pragma once

#include "accel/walk.cuh"
#include "cuda/tally.cuh"
#include "shadow/projected_light.cuh"

// χ of formula (3) for a light that straddles the horizon: its share above the horizon.
COLD float share_above_horizon(SurfacePoint point, const Light *light, float reach) {
    const Pattern pattern = pattern_of(0, 0, 0);
    unsigned above = 0;
    for (unsigned index = 0; index < HORIZON_SAMPLES; ++index) {
        const Vec3 target = light_point(*light, point.origin, reach, pattern_point(pattern, index));
        above += dot(point.normal, target - point.origin) > 0.0f;
    }
    return (float)above / (float)HORIZON_SAMPLES;
}

// χ of formula (3) for a light: 1 if it is in front of the surface at `point`, 0 if it is behind.
DEVICE float above_horizon(const SurfacePoint &point, const Light &light, float reach) {
    const float height = dot(point.normal, light_center(light, point.origin, reach) - point.origin);
    if (fabsf(height) >= (light.kind == Light::DIRECTIONAL ? reach * light.size : light.size))
        return height > 0.0f ? 1.0f : 0.0f;
    return share_above_horizon(point, &light, reach);
}

// Number of shadow rays from a point to a light.
DEVICE unsigned sample_count(const Sampling &sampling, const Light &light) {
    return is_spread_over(sampling, light) ? sampling.samples : 1;
}

// The points of one light that shadow rays from one point are cast to.
struct Targets {
    const Light &light;
    Vec3 from;
    // The distance of a directional light.
    float reach;
    // Whether they follow the pattern; otherwise the centre is used.
    bool spread;
    Pattern pattern;
};

// Those of light number `index` from `from`; `key` selects the random pattern.
DEVICE Targets targets_of(const Scene &scene, const Sampling &sampling, unsigned index, Vec3 from, unsigned long long key) {
    const Light &light = scene.lights[index];
    return Targets{light, from, scene_reach(scene, from), is_spread_over(sampling, light), pattern_of(sampling.seed, key, index)};
}

// The target of sample number `sample`.
DEVICE Vec3 target(const Targets &targets, unsigned sample) {
    return targets.spread ? light_point(targets.light, targets.from, targets.reach, pattern_point(targets.pattern, sample))
                          : light_center(targets.light, targets.from, targets.reach);
}

// The shadow ray from `from` to a point of a light.
DEVICE Ray shadow_segment(const Light &light, Vec3 from, Vec3 target) { return long_segment(from, before_body(light, from, target)); }

// Whether anything hides the point `target` of a light from `from`. Everything that can hide a light is decided here.
template <class Structure>
DEVICE bool hidden(const Structure &structure, const Tally &tally, const Light &light, Vec3 from, Vec3 target) {
    return occluded(structure, tally, shadow_segment(light, from, target));
}

// The number of shadow rays from a surface point that reach the light, of the samples from `first` to `end`. Counts those that are
// cast: a sample behind the surface is dark without a ray.
template <class Structure>
DEVICE unsigned rays_that_arrive(const Structure &structure, const Tally &tally, const SurfacePoint &point, const Targets &targets,
                                 unsigned first, unsigned end, unsigned &cast) {
    unsigned seen = 0;
    for (unsigned sample = first; sample < end; ++sample) {
        const Vec3 to = target(targets, sample);
        if (!(dot(point.normal, to - point.origin) > 0.0f))
            continue;
        ++cast;
        seen += !hidden(structure, tally, targets.light, point.origin, to);
    }
    return seen;
}

// The visible share of light number `index` from a surface point, without χ: the fallback where no light point is used.
template <class Structure>
DEVICE float fallback_share(const Structure &structure, const Scene &scene, const Sampling &sampling, const Tally &tally,
                            const SurfacePoint &point, unsigned long long key, unsigned index) {
    const Targets targets = targets_of(scene, sampling, index, point.origin, key);
    const unsigned samples = sample_count(sampling, targets.light);
    unsigned cast = 0;
    const unsigned seen = rays_that_arrive(structure, tally, point, targets, 0, samples, cast);
    atomicAdd(&tally_shard(tally).shadow_rays, (unsigned long long)cast);
    return (float)seen / (float)samples;
}
