// Rays that go on, on a CUDA device: twin of cpu.rs, one thread per ray.
//
// 1. `mirror_rays_thin`: the shares of thin rays, if some are thinned.
// 2. `mirror_rays_count`: how many rays go on from each block of 256; then a scan.
// 3. `mirror_rays_emit`: these rays, in the order of the rays.
#include "cuda/prelude.cuh"

#include "cuda/warp.cuh"
#include "shading/seen_lights.cuh"

// The shares of what is behind the surface point of a ray, and in the mirror there, that reach the pixel; zero where no ray goes on.
struct Shares {
    Vec3 through, mirrored;
};

DEVICE Shares all_shares_of(const MirrorRays &args, unsigned ray) {
    const Shares none = {splat(0.0f), splat(0.0f)};
    if (ray >= args.rays.count)
        return none;
    const Hit hit = load_hit(args.hits, ray);
    if (hit.triangle == Hit::NONE)
        return none;
    Material own;
    const Material *material = material_at(args.scene, args.rays, ray, hit, own);
    const Vec3 weight = in_front(args.scene, args.rays, args.hits, ray, 1.0f).left * weight_of(args.rays, ray);
    const Vec3 through = weight * material->transmittance, mirrored = weight * material->mirrored;
    const unsigned throughs = throughs_of(args.rays, ray);
    const float least = args.thin != nullptr ? LEAST_THIN : LEAST_ONWARD;
    const bool goes = max_element(through) >= least && throughs < MOST_THROUGHS;
    const bool returns = max_element(mirrored) >= least && mirrors(args.rays, ray);
    return Shares{goes ? through : none.through, returns ? mirrored : none.mirrored};
}

// T: rays of a larger share always go on.
DEVICE float least_thick(const Rays &rays) { return rays.depth < DEEP ? LEAST_THICK : LEAST_THICK_DEEP; }

// The share of a thin ray of this weight, in units of T 2^-16; 0 of others.
DEVICE unsigned part_of(Vec3 weight, float least) {
    const float share = max_element(weight);
    return share >= least ? 0 : (unsigned)(share * ((float)(1u << THIN_BITS) / least));
}

// The offset of a pixel: twin of thinning.rs.
DEVICE unsigned offset_of(const Rays &rays, unsigned pixel) {
    unsigned across = THIN_ACROSS, down = THIN_DOWN;
    for (unsigned depth = 0; depth < rays.depth; ++depth) {
        across *= THIN_ACROSS;
        down *= THIN_DOWN;
    }
    const unsigned x = place_in_image(rays.view, pixel, 0) * across, y = place_in_image(rays.view, pixel, 1) * down;
    return (x + y + (rays.depth + 1) * THIN_DEEPER) >> (32 - THIN_BITS);
}

// The weight with which the next ray of a pixel goes on, or zero; `sum` are the offset and the parts of those before.
DEVICE Vec3 thinned(Vec3 weight, float least, unsigned &sum) {
    const unsigned part = part_of(weight, least), before = sum;
    if (part == 0)
        return weight;
    sum += part;
    return sum >> THIN_BITS != before >> THIN_BITS ? ((float)(1u << THIN_BITS) / (float)part) * weight : splat(0.0f);
}

// What is left of these shares.
DEVICE Shares shares_of(const MirrorRays &args, unsigned ray) {
    const Shares all = all_shares_of(args, ray);
    if (args.thin == nullptr || ray >= args.rays.count || args.thin[ray] == 0)
        return all;
    const unsigned pixel = pixel_of(args.rays, ray);
    unsigned sum = offset_of(args.rays, pixel);
    for (unsigned before = ray; before-- > 0 && pixel_of(args.rays, before) == pixel;)
        sum += args.thin[before];
    const float least = least_thick(args.rays);
    const Vec3 through = thinned(all.through, least, sum);
    return Shares{through, thinned(all.mirrored, least, sum)};
}

// The cone that the mirror at a surface point reflects.
DEVICE Cone reflected_cone(const MirrorRays &args, unsigned ray, const Surface &surface) {
    const Hit hit = load_hit(args.hits, ray);
    const Corners corners = corners_at(args.scene.triangles, hit.triangle);
    const Cone seen = cone_after(cone_of(args.rays, ray), hit.t);
    const Cone cone = cone_reflected(seen, curvature(args.scene, hit, corners, surface.point.normal));
    return surface.material->facets ? facets_blurred(cone, surface.material->roughness) : cone;
}

// How many of the threads of the block before this one have the first flag set and how many the second, together, and how many in all.
DEVICE unsigned flags_before(bool first, bool second, unsigned &all) {
    SHARED(unsigned, warps, [BLOCK / WARP]);
    const unsigned lane = lane_of_thread(), warp = threadIdx.x / WARP;
    const unsigned firsts = __ballot_sync(ALL_LANES, first), seconds = __ballot_sync(ALL_LANES, second);
    if (lane == 0)
        warps[warp] = __popc(firsts) + __popc(seconds);
    __syncthreads();
    unsigned before = __popc(firsts & lanes_below(lane)) + __popc(seconds & lanes_below(lane));
    all = 0;
    for (unsigned other = 0; other < BLOCK / WARP; ++other) {
        before += other < warp ? warps[other] : 0;
        all += warps[other];
    }
    return before;
}

KERNEL(mirror_rays_thin, MirrorRays, BLOCK, 4) {
    const unsigned ray = blockIdx.x * BLOCK + threadIdx.x;
    if (ray >= args.rays.count)
        return;
    const Shares shares = all_shares_of(args, ray);
    const float least = least_thick(args.rays);
    args.thin[ray] = part_of(shares.through, least) + part_of(shares.mirrored, least);
}

KERNEL(mirror_rays_count, MirrorRays, BLOCK, 4) {
    const Shares shares = shares_of(args, blockIdx.x * BLOCK + threadIdx.x);
    unsigned all;
    flags_before(shares.through != splat(0.0f), shares.mirrored != splat(0.0f), all);
    if (threadIdx.x == 0)
        args.counts[blockIdx.x] = all;
}

KERNEL(mirror_rays_emit, MirrorRays, BLOCK, 4) {
    const unsigned ray = blockIdx.x * BLOCK + threadIdx.x;
    const Shares shares = shares_of(args, ray);
    const bool goes = shares.through != splat(0.0f), returns = shares.mirrored != splat(0.0f);
    unsigned all;
    unsigned place = args.counts[blockIdx.x] + flags_before(goes, returns, all);
    if (!goes && !returns)
        return;
    Material own;
    const Surface surface = surface_at(args.scene, args.rays, args.hits, ray, own);
    const unsigned pixel = pixel_of(args.rays, ray), sample = sample_of(args.rays, ray);

    // 1. Through the surface.
    if (goes) {
        if (args.cones != nullptr)
            args.cones[place] = cone_after(cone_of(args.rays, ray), load_hit(args.hits, ray).t);
        const unsigned through = sample + (1u << THROUGHS_SHIFT);
        const Ray beyond = onward(surface);
        args.onward[place++] = ListedRay{beyond.origin, pixel, beyond.direction, through, shares.through, 0};
    }

    // 2. Mirrored.
    if (returns) {
        if (args.cones != nullptr)
            args.cones[place] = reflected_cone(args, ray, surface);
        args.onward[place] = ListedRay{surface.point.origin, pixel, normalize(mirrored(surface)), sample, shares.mirrored, 0};
    }
}
