// Step 1 on a CUDA device: what does each ray see? Twin of cpu.rs, one thread a ray.
#include "cuda/prelude.cuh"

#include "accel/walk.cuh"
#include "cuda/rays.cuh"
#include "cuda/tally.cuh"

template <class Structure>
DEVICE void primary_rays(const PrimaryRays &args, const Structure &structure) {
    unsigned ray;
    bool found = false;
    if (ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray)) {
        const Hit hit = closest_hit(structure, args.tally, ray_at(args.rays, ray));
        store_hit(args.hits, ray, hit);
        found = hit.triangle != HIT_NONE;
    }
    Counters &shard = tally_shard(args.tally);
    count(shard.object_points, found);
    count(shard.hits, found && args.rays.list == nullptr);
}

KERNEL(primary_rays_bvh, PrimaryRays, 256, 4) { primary_rays(args, args.scene.bvh); }

KERNEL(primary_rays_grid, PrimaryRays, 256, 4) { primary_rays(args, args.scene.grid); }

KERNEL(primary_rays_brute_force, PrimaryRays, 256, 4) { primary_rays(args, args.scene.brute_force); }
