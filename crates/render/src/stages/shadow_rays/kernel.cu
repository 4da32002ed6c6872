// Shadow rays on a CUDA device: twin of cpu.rs, one thread an object point.
//
// `shadow_rays_*`: one ray to the middle of each light; `area_shadows_*`: many to points spread over it. Where an object point has
// very many rays, a launch takes only some of them, and later ones go on.
#include "cuda/prelude.cuh"

#include "stages/shade/shade.cuh"
#include "stages/shadow_rays/shadow_rays.cuh"

// Where the share of a light for a ray lies.
DEVICE float &share_of(const ShadowRays &args, unsigned light, unsigned ray) {
    return args.share[(unsigned long long)light * args.rays.count + ray];
}

// Nothing is lit where nothing was seen.
DEVICE void no_shares(const ShadowRays &args, unsigned ray) {
    for (unsigned light = 0; light < args.scene.light_count; ++light)
        share_of(args, light, ray) = 0.0f;
}

// One ray from an object point to the middle of each light of this launch. Returns how many were cast.
template <class Structure>
DEVICE unsigned trace_hard(const ShadowRays &args, const Structure &structure, unsigned ray) {
    const SurfacePoint point = object_point(args.scene, args.rays, args.hits, ray);
    unsigned cast = 0;
    const unsigned first = (unsigned)args.first_sample;
    for (unsigned light = first; light < first + args.sample_count; ++light) {
        const Vec3 target = light_center(args.scene.lights[light], point.origin, scene_reach(args.scene, point.origin));
        bool lit = false;
        if (dot(point.normal, target - point.origin) > 0.0f) {
            ++cast;
            lit = reaches(structure, args.tally, point, target);
        }
        share_of(args, light, ray) = lit ? 1.0f : 0.0f;
    }
    return cast;
}

template <class Structure>
DEVICE void shadow_rays(const ShadowRays &args, const Structure &structure) {
    unsigned ray, cast = 0;
    if (ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray)) {
        if (load_hit(args.hits, ray).triangle == HIT_NONE) {
            if (args.first_sample == 0)
                no_shares(args, ray);
        } else {
            cast = trace_hard(args, structure, ray);
        }
    }
    count(tally_shard(args.tally).shadow_rays, cast);
}

// Rays that area mode casts to a light: one where it has no extent.
DEVICE unsigned sample_count(const Sampling &sampling, const Light &light) {
    const bool spread = sampling.spread && light.kind == LIGHT_POINT && light.radius > 0.0f;
    return has_size(light) || spread ? sampling.samples : 1;
}

// Adds a light to an object point, the samples from `first` to `end`. Its share is a number of rays until the last sample is added.
template <class Structure>
DEVICE void gather_light(const ShadowRays &args, const Structure &structure, unsigned ray, unsigned index, unsigned first,
                         unsigned end, const Surface &surface, Vec3 &direct, unsigned &cast) {
    const Light &light = args.scene.lights[index];
    const unsigned samples = sample_count(args.sampling, light);
    if (first >= samples)
        return;
    end = end < samples ? end : samples;
    const float weight = 1.0f / (float)samples, reach = scene_reach(args.scene, surface.point.origin);
    const bool single = samples == 1 && !has_size(light);
    const Pattern pattern = pattern_of(args.sampling.seed, ray_key(args.rays, ray), index);
    float share = first == 0 ? 0.0f : share_of(args, index, ray);
    for (unsigned sample = first; sample < end; ++sample) {
        const Vec3 target = single ? light_center(light, surface.point.origin, reach)
                                   : light_point(light, surface.point.origin, reach, pattern_point(pattern, sample));
        // A sample behind the surface is dark without a ray.
        if (!(dot(surface.point.normal, target - surface.point.origin) > 0.0f))
            continue;
        ++cast;
        if (reaches(structure, args.tally, surface.point, target)) {
            share += 1.0f;
            direct = direct + weight * reflected(surface, light, target);
        }
    }
    if (end == samples) {
        share *= weight;
        // The product of N and 1/N may miss 1 by a rounding.
        share = share > 1.0f - 0.5f * weight ? 1.0f : share;
    }
    share_of(args, index, ray) = share;
}

// Many rays from an object point to the lights: those of this launch. Returns how many were cast.
template <class Structure>
DEVICE unsigned trace_area(const ShadowRays &args, const Structure &structure, unsigned ray) {
    Material own;
    const Surface surface = surface_at(args.scene, args.rays, args.hits, ray, own);
    Vec3 direct = args.first_sample == 0 ? splat(0.0f) : args.direct[ray];
    unsigned cast = 0;
    const unsigned all = args.sampling.samples;
    unsigned light = (unsigned)(args.first_sample / all), first = (unsigned)(args.first_sample % all);
    for (unsigned left = (unsigned)args.sample_count; left > 0; ++light) {
        const unsigned count = left < all - first ? left : all - first;
        gather_light(args, structure, ray, light, first, first + count, surface, direct, cast);
        left -= count;
        first = 0;
    }
    args.direct[ray] = direct;
    return cast;
}

template <class Structure>
DEVICE void area_shadows(const ShadowRays &args, const Structure &structure) {
    unsigned ray, cast = 0;
    if (ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray)) {
        if (load_hit(args.hits, ray).triangle == HIT_NONE) {
            if (args.first_sample == 0) {
                no_shares(args, ray);
                args.direct[ray] = splat(0.0f);
            }
        } else {
            cast = trace_area(args, structure, ray);
        }
    }
    count(tally_shard(args.tally).shadow_rays, cast);
}

KERNEL(shadow_rays_bvh, ShadowRays, 256, 4) { shadow_rays(args, args.scene.bvh); }

KERNEL(shadow_rays_grid, ShadowRays, 256, 4) { shadow_rays(args, args.scene.grid); }

KERNEL(shadow_rays_brute_force, ShadowRays, 256, 4) { shadow_rays(args, args.scene.brute_force); }

KERNEL(area_shadows_bvh, ShadowRays, 256, 3) { area_shadows(args, args.scene.bvh); }

KERNEL(area_shadows_grid, ShadowRays, 256, 3) { area_shadows(args, args.scene.grid); }

KERNEL(area_shadows_brute_force, ShadowRays, 256, 3) { area_shadows(args, args.scene.brute_force); }
