// The last term of formula (1) on a CUDA device: twin of cpu.rs, one thread per ray.
//
// 1. `mirror_rays_count`: how many rays of each block of 256 are mirrored; then a scan.
// 2. `mirror_rays_emit`: the mirror rays, in the order of the rays.
#include "cuda/prelude.cuh"

#include "cuda/warp.cuh"
#include "shading/shading.cuh"

// The share of what a mirror at the surface point of `ray` shows that reaches the pixel; zero if there is no mirror.
DEVICE Vec3 mirror_weight(const MirrorRays &args, unsigned ray) {
    if (ray >= args.rays.count)
        return splat(0.0f);
    const Hit hit = load_hit(args.hits, ray);
    if (hit.triangle == Hit::NONE)
        return splat(0.0f);
    Material own;
    return weight_of(args.rays, ray) * material_at(args.scene, args.rays, ray, hit, own)->ks;
}

// The cone that the mirror at a surface point reflects.
DEVICE Cone reflected_cone(const MirrorRays &args, unsigned ray, const Surface &surface) {
    const Hit hit = load_hit(args.hits, ray);
    const Corners corners = load_corners(args.scene.triangles + hit.triangle);
    const Cone cone = cone_after(cone_of(args.rays, ray), hit.t);
    return cone_reflected(cone, curvature(args.scene, hit, corners, surface.point.normal));
}

// How many threads of the block before this one have the flag set, and how many in all.
DEVICE unsigned flags_before(bool flag, unsigned &all) {
    SHARED(unsigned, warps, [BLOCK / WARP]);
    const unsigned lane = lane_of_thread(), warp = threadIdx.x / WARP;
    const unsigned flags = __ballot_sync(ALL_LANES, flag);
    if (lane == 0)
        warps[warp] = __popc(flags);
    __syncthreads();
    unsigned before = __popc(flags & lanes_below(lane));
    all = 0;
    for (unsigned other = 0; other < BLOCK / WARP; ++other) {
        before += other < warp ? warps[other] : 0;
        all += warps[other];
    }
    return before;
}

KERNEL(mirror_rays_count, MirrorRays, BLOCK, 4) {
    const Vec3 weight = mirror_weight(args, blockIdx.x * BLOCK + threadIdx.x);
    unsigned all;
    flags_before(weight != splat(0.0f), all);
    if (threadIdx.x == 0)
        args.counts[blockIdx.x] = all;
}

KERNEL(mirror_rays_emit, MirrorRays, BLOCK, 4) {
    const unsigned ray = blockIdx.x * BLOCK + threadIdx.x;
    const Vec3 weight = mirror_weight(args, ray);
    const bool mirrors = weight != splat(0.0f);
    unsigned all;
    const unsigned before = flags_before(mirrors, all);
    if (!mirrors)
        return;
    Material own;
    const Surface surface = surface_at(args.scene, args.rays, args.hits, ray, own);
    const Vec3 direction = normalize(mirrored(surface));
    const unsigned place = args.counts[blockIdx.x] + before;
    if (args.cones != nullptr)
        args.cones[place] = reflected_cone(args, ray, surface);
    args.mirrored[place] =
        ListedRay{surface.point.origin, pixel_of(args.rays, ray), direction, sample_of(args.rays, ray), weight, 0};
}
