// Merged rays on a CUDA device: twin of cpu.rs, one thread per ray.
//
// 1. `merge_mirrored`: which rays does each take? The thread of the first ray of a pixel finds it for all of them.
// 2. `count_merged`: how many rays are left of each block of 256; then a scan.
// 3. `emit_merged`: these rays, in their order.
#include "cuda/prelude.cuh"

#include "cuda/warp.cuh"
#include "shading/seen_lights.cuh"
#include "stages/pixel_samples/same_surface.cuh"

// What ray number `ray` sees.
DEVICE Facet facet_of_ray(const MergedRays &args, unsigned ray, const Hit &hit) {
    const Ray along = ray_at(args.rays, ray);
    const Vec3 position = surface_point(along, hit, corners_at(args.scene.triangles, hit.triangle)).position;
    return facet_of(args.scene, along, hit, args.spacing[0] + args.spacing[1] * length(position - args.rays.view.origin));
}

// Nor do those that see lights, or would if they were as wide as all.
DEVICE bool may_merge(const MergedRays &args, unsigned ray, const Hit &hit) {
    return hit.triangle != Hit::NONE && throughs_of(args.rays, ray) == 0 &&
           in_front(args.scene, args.rays, args.hits, ray, sqrtf((float)WARP)).left == 1.0f;
}

// The sum of the weights of the rays of a part: bit k stands for the k-th ray after the first.
DEVICE Vec3 weight_of_part(const MergedRays &args, unsigned first, unsigned part) {
    Vec3 sum = splat(0.0f);
    for (unsigned left = part; left != 0; left &= left - 1)
        sum = sum + weight_of(args.rays, first + __ffs(left) - 1);
    return sum;
}

// The rays that ray `first` of a pixel takes of those up to `end`; bit k of `taken` stands for the k-th ray after `start`.
DEVICE unsigned part_of(const MergedRays &args, unsigned first, unsigned start, unsigned end, unsigned taken) {
    const Hit hit = load_hit(args.hits, first);
    if (!may_merge(args, first, hit) || is_transmissive(args.scene, hit))
        return 1;
    const Facet own = facet_of_ray(args, first, hit);
    const bool blurred = lights_share(args.rays, first) < 1.0f;
    unsigned part = 1;
    for (unsigned other = first + 1; other < end; ++other) {
        const Hit beside = load_hit(args.hits, other);
        if ((taken >> (other - start) & 1) != 0 || !may_merge(args, other, beside))
            continue;
        bool like = beside.triangle == hit.triangle;
        if (!like) {
            const Facet facet = facet_of_ray(args, other, beside);
            like = continues(own, facet) || (blurred && lights_share(args.rays, other) < 1.0f && resembles(own, facet));
        }
        if (like)
            part |= 1u << (other - first);
    }
    const float varying = blurred ? 1.0f : mirrors(args.rays, first) ? most_mirrored(args.scene, hit) : 0.0f;
    return varying * max_element(weight_of_part(args, first, part)) <= MAX_MERGED ? part : 1;
}

KERNEL(merge_mirrored, MergedRays, BLOCK, 4) {
    const unsigned ray = blockIdx.x * BLOCK + threadIdx.x;
    if (ray >= args.rays.count)
        return;
    const unsigned pixel = pixel_of(args.rays, ray);
    if (ray > 0 && pixel_of(args.rays, ray - 1) == pixel)
        return;
    unsigned start = ray;
    while (start < args.rays.count && pixel_of(args.rays, start) == pixel) {
        unsigned end = start + 1;
        while (end < args.rays.count && end - start < WARP && pixel_of(args.rays, end) == pixel)
            ++end;
        unsigned taken = 0;
        for (unsigned first = start; first < end; ++first) {
            const bool is_taken = (taken >> (first - start) & 1) != 0;
            const unsigned part = is_taken ? 0 : part_of(args, first, start, end, taken);
            taken |= part << (first - start);
            args.merged[first] = part;
        }
        start = end;
    }
}

// Whether the thread's ray is left.
DEVICE bool is_left(const MergedRays &args, unsigned ray) { return ray < args.rays.count && args.merged[ray] != 0; }

// How many of the threads of the block before this one have a ray that is left, and how many in all.
DEVICE unsigned left_before(bool left, unsigned &all) {
    SHARED(unsigned, warps, [BLOCK / WARP]);
    const unsigned lane = lane_of_thread(), warp = threadIdx.x / WARP;
    const unsigned lanes = __ballot_sync(ALL_LANES, left);
    if (lane == 0)
        warps[warp] = __popc(lanes);
    __syncthreads();
    unsigned before = __popc(lanes & lanes_below(lane));
    all = 0;
    for (unsigned other = 0; other < BLOCK / WARP; ++other) {
        before += other < warp ? warps[other] : 0;
        all += warps[other];
    }
    return before;
}

KERNEL(count_merged, MergedRays, BLOCK, 4) {
    unsigned all;
    left_before(is_left(args, blockIdx.x * BLOCK + threadIdx.x), all);
    if (threadIdx.x == 0)
        args.counts[blockIdx.x] = all;
}

KERNEL(emit_merged, MergedRays, BLOCK, 4) {
    const unsigned ray = blockIdx.x * BLOCK + threadIdx.x;
    const bool left = is_left(args, ray);
    unsigned all;
    const unsigned place = args.counts[blockIdx.x] + left_before(left, all);
    if (!left)
        return;
    const unsigned part = args.merged[ray];
    const Ray along = ray_at(args.rays, ray);
    args.left[place] = ListedRay{
        along.origin, pixel_of(args.rays, ray), along.direction, sample_of(args.rays, ray), weight_of_part(args, ray, part), 0};
    store_hit(args.left_hits, place, load_hit(args.hits, ray));
    if (args.cones != nullptr) {
        const float times = sqrtf((float)__popc(part));
        const Cone cone = cone_of(args.rays, ray);
        args.cones[place] = Cone{times * cone.width, times * cone.spread};
    }
}
