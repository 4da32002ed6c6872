// Step 1 on a CUDA device: what does each ray see? Twin of cpu.rs, one thread per ray.
#ifndef ALPHA_TEST
// Scenes with cut-outs or instances use the module with ALPHA_TEST.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "accel/walk.cuh"
#include "data/clip.cuh"
#include "cuda/tally.cuh"

template <class Structure>
DEVICE void primary_rays(const PrimaryRays &args, const Structure &structure) {
    unsigned ray;
    bool found = false;
    if (ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray)) {
        const Ray along = ray_at(args.rays, ray);
        const Limits limits = limits_of(args.rays, ray, along);
        const Hit hit = from_origin(limits, closest_hit(structure, args.tally, between(limits, along)));
        store_hit(args.hits, ray, hit);
        found = hit.triangle != Hit::NONE;
    }
    Counters &shard = tally_shard(args.tally);
    count(shard.surface_points, found);
    count(shard.hits, found && args.rays.list == nullptr);
}

KERNEL_PER_STRUCTURE(primary_rays, PrimaryRays, BLOCK, 4)
