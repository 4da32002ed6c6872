// Shadow rays on a CUDA device: twin of cpu.rs, one thread per surface point.
//
// `shadow_rays_*`: one ray to the centre of each light; `area_shadows_*`: many to points distributed over it. If a surface point
// has very many rays, a launch casts only some of them, and later launches continue.
#include "cuda/prelude.cuh"

#include "cuda/rays.cuh"
#include "shadow/shadow.cuh"

// The share of a light for a ray.
DEVICE float &share_of(const ShadowRays &args, unsigned light, unsigned ray) {
    return args.share[(unsigned long long)light * args.rays.count + ray];
}

// Nothing is lit where nothing was seen.
DEVICE void no_shares(const ShadowRays &args, unsigned ray) {
    for (unsigned light = 0; light < args.scene.light_count; ++light)
        share_of(args, light, ray) = 0.0f;
}

// Casts one ray from a surface point to the centre of each light of this launch. Returns how many were cast.
template <class Structure>
DEVICE unsigned trace_hard(const ShadowRays &args, const Structure &structure, unsigned ray, const SurfacePoint &point) {
    unsigned cast = 0;
    const unsigned first = (unsigned)args.first_sample;
    for (unsigned light = first; light < first + args.sample_count; ++light) {
        const Vec3 middle = light_center(args.scene.lights[light], point.origin, scene_reach(args.scene, point.origin));
        bool lit = false;
        if (dot(point.normal, middle - point.origin) > 0.0f) {
            ++cast;
            lit = !hidden(structure, args.tally, point.origin, middle);
        }
        share_of(args, light, ray) = lit ? 1.0f : 0.0f;
    }
    return cast;
}

// Adds a light at a surface point, the samples from `first` to `end`. Its share is a number of rays until the last sample is added.
template <class Structure>
DEVICE void gather_light(const ShadowRays &args, const Structure &structure, unsigned ray, unsigned index, unsigned first,
                         unsigned end, const SurfacePoint &point, unsigned &cast) {
    const Targets targets = targets_of(args.scene, args.sampling, index, point.origin, ray_key(args.rays, ray));
    const unsigned samples = sample_count(args.sampling, targets.light);
    if (first >= samples)
        return;
    end = end < samples ? end : samples;
    float share = first == 0 ? 0.0f : share_of(args, index, ray);
    share += (float)rays_that_arrive(structure, args.tally, point, targets, first, end, cast);
    if (end == samples) {
        const float weight = 1.0f / (float)samples;
        share *= weight;
        // The product of N and 1/N may differ from 1 by rounding.
        share = share > 1.0f - 0.5f * weight ? 1.0f : share;
    }
    share_of(args, index, ray) = share;
}

// Casts many rays from a surface point to the lights of this launch. Returns how many were cast.
template <class Structure>
DEVICE unsigned trace_area(const ShadowRays &args, const Structure &structure, unsigned ray, const SurfacePoint &point) {
    unsigned cast = 0;
    const unsigned all = args.sampling.samples;
    unsigned light = (unsigned)(args.first_sample / all), first = (unsigned)(args.first_sample % all);
    for (unsigned left = (unsigned)args.sample_count; left > 0; ++light) {
        const unsigned count = left < all - first ? left : all - first;
        gather_light(args, structure, ray, light, first, first + count, point, cast);
        left -= count;
        first = 0;
    }
    return cast;
}

// The rays of one thread: one hard-shadow ray per light, or many.
template <bool HARD, class Structure>
DEVICE void trace(const ShadowRays &args, const Structure &structure) {
    unsigned ray, cast = 0;
    if (ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray)) {
        if (load_hit(args.hits, ray).triangle == Hit::NONE) {
            if (args.first_sample == 0)
                no_shares(args, ray);
        } else {
            const SurfacePoint point = surface_point_of(args.scene, args.rays, args.hits, ray);
            cast = HARD ? trace_hard(args, structure, ray, point) : trace_area(args, structure, ray, point);
        }
    }
    count(tally_shard(args.tally).shadow_rays, cast);
}

template <class Structure>
DEVICE void shadow_rays(const ShadowRays &args, const Structure &structure) {
    trace<true>(args, structure);
}

template <class Structure>
DEVICE void area_shadows(const ShadowRays &args, const Structure &structure) {
    trace<false>(args, structure);
}

KERNEL_PER_STRUCTURE(shadow_rays, ShadowRays, BLOCK, 4)

KERNEL_PER_STRUCTURE(area_shadows, ShadowRays, BLOCK, 3)
