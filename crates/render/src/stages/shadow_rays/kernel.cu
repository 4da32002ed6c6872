// Shadow rays on a CUDA device: twin of cpu.rs, one thread per surface point.
//
// `shadow_rays_*`: one ray to the centre of each light; `sample_rays_*`: one to each sample of a light.
#define ALPHA_TEST 1
#ifndef INSTANCES
// Scenes with instances use the module with INSTANCES.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "data/rays.cuh"
#include "shadow/seen.cuh"
#include "shadow/shadow.cuh"
#include "shadow/terminator.cuh"
#include "stages/shadow_rays/samples.cuh"

// The share of a light for a ray.
DEVICE float &share_of(const ShadowRays &args, unsigned light, unsigned ray) {
    return args.share[(unsigned long long)light * args.rays.count + ray];
}

// Casts one ray from a surface point to the centre of each light of this launch. Returns how many were cast.
template <class Structure>
DEVICE unsigned trace_hard(const ShadowRays &args, const Structure &structure, unsigned ray, const SurfacePoint &flat) {
    unsigned cast = 0;
    for (unsigned light = args.first_light; light < args.first_light + args.light_count; ++light) {
        const Light &emitter = args.scene.lights[light];
        const SurfacePoint point = shadow_point_of(args.scene, args.rays, args.hits, ray, emitter, flat);
        const Vec3 middle = light_center(emitter, point.origin, scene_reach(args.scene, point.origin));
        bool lit = false;
        if (dot(point.normal, middle - point.origin) > 0.0f) {
            ++cast;
            lit = !hidden(structure, args.tally, emitter, point.origin, middle);
        }
        share_of(args, light, ray) = lit ? 1.0f : 0.0f;
    }
    return cast;
}

template <class Structure>
DEVICE void shadow_rays(const ShadowRays &args, const Structure &structure) {
    unsigned ray, cast = 0;
    if (ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray) && load_hit(args.hits, ray).triangle != Hit::NONE)
        cast = trace_hard(args, structure, ray, surface_point_of(args.scene, args.rays, args.hits, ray));
    count(tally_shard(args.tally).shadow_rays, cast);
}

template <class Structure>
DEVICE void sample_rays(const Shadows &args, const Structure &structure) {
    unsigned ray, cast = 0;
    const Shape shape = shape_of(args.sampling, args.scene.lights[args.first_light]);
    const bool has = !(shape == SHAPE_POINT && args.set != 0) && ray_of_thread(args.rays, args.first + blockIdx.x, threadIdx.x, ray) &&
                     load_hit(args.hits, ray).triangle != Hit::NONE;
    if (has) {
        const SurfacePoint point =
            shadow_point_of(args.scene, args.rays, args.hits, ray, args.scene.lights[args.first_light]);
        add_seen(args, shape, args.first_light, ray, trace_samples(args, structure, point, args.first_light, ray, shape, cast));
    }
    count(tally_shard(args.tally).shadow_rays, cast);
}

KERNEL_PER_STRUCTURE(shadow_rays, ShadowRays, BLOCK, 4)

KERNEL_PER_STRUCTURE(sample_rays, Shadows, BLOCK, 3)
