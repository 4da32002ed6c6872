// Rays that go on, on a CUDA device: twin of cpu.rs, one thread per ray.
//
// 1. `mirror_rays_thin`: the shares of thin rays, if some are thinned.
// 2. `mirror_rays_count`: how many rays go on from each block of 256; then a scan.
// 3. `mirror_rays_emit`: these rays, in the order of the rays.
#include "cuda/prelude.cuh"

#include "cuda/warp.cuh"
#include "sampling.cuh"
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
    const float least = args.thin != nullptr ? MIN_THIN : MIN_ONWARD;
    const bool goes = max_element(through) >= least && throughs < MAX_THROUGHS;
    const bool returns = max_element(mirrored) >= least && mirrors(args.rays, ray);
    return Shares{goes ? through : none.through, returns ? mirrored : none.mirrored};
}

// T: rays of a larger share always go on.
DEVICE float least_thick(const Rays &rays) { return rays.depth < DEEP ? MIN_THICK : MIN_THICK_DEEP; }

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
    const unsigned x = (unsigned)place_in_image(rays.view, pixel, 0) * across, y = (unsigned)place_in_image(rays.view, pixel, 1) * down;
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

// Eight bits with a zero above each.
DEVICE unsigned spaced(unsigned bits) {
    bits = (bits | bits << 4) & ~UPPER_NIBBLES;
    bits = (bits | bits << 2) & ~UPPER_PAIRS;
    return (bits | bits << 1) & ~UPPER_BITS;
}

// The number of a pixel of a tile along the curve that visits the squares of 2, 4, 8 ... pixels one after the other: the bits of both coordinates
// in turn.
DEVICE unsigned along_curve(unsigned x, unsigned y) { return spaced(x) | spaced(y) << 1; }

// The points that select the directions of the mirror rays of a ray.
struct Points {
    Pattern pattern;
    unsigned first;
};

DEVICE Points points_of(const MirrorRays &args, unsigned ray, unsigned count) {
    // 1. Those of a tile of pixels are one pattern at each depth, in the order of a curve.
    const unsigned pixel = pixel_of(args.rays, ray);
    const int x = place_in_image(args.rays.view, pixel, 0), y = place_in_image(args.rays.view, pixel, 1);
    const unsigned column = place_in_step(x, LOBE_TILE), row = place_in_step(y, LOBE_TILE);
    // Tiles to the left of the image, and above, have negative numbers.
    const int across = (x - (int)column) / (int)LOBE_TILE, down = (y - (int)row) / (int)LOBE_TILE;
    const unsigned tile = ((unsigned)down << 16) + (unsigned)across, place = along_curve(column, row);

    // 2. Those of a pixel follow each other: of its first sample, or of the only one, and so on.
    const unsigned samples = sample_of(args.rays, ray) == 0 ? 1 : (unsigned)args.pixel_samples;
    const unsigned directions = is_mirrored(args.rays, ray) ? MAX_DIRECTIONS : count;
    return Points{pattern_of(args.seed, (unsigned long long)args.rays.depth << 32 | tile, LOBE_PATTERN),
                  place * samples * directions + number_in_pixel(args.rays, ray) * count};
}

// The mirror at a surface point, and where it reflects a ray.
struct Mirror {
    Surface surface;
    Points points;
    // In how many directions; 0 if none.
    unsigned count;
    // The share of all that the ray sees that reaches the pixel, and of what a smooth mirror shows.
    Vec3 reaches, mirrored;
};

// 2. The mirror that a ray sees. `mirrored` is the share of what is in it, `own` provides memory for its material.
DEVICE Mirror mirror_at(const MirrorRays &args, unsigned ray, Vec3 mirrored, Material &own) {
    Mirror mirror = {};
    if (mirrored == splat(0.0f))
        return mirror;
    mirror.surface = surface_at(args.scene, args.rays, args.hits, ray, own);
    mirror.mirrored = mirrored;
    mirror.count = 1;
    if (!mirror.surface.material->facets)
        return mirror;

    // 3. In some directions, if it is rough.
    mirror.reaches = in_front(args.scene, args.rays, args.hits, ray, 1.0f).left * weight_of(args.rays, ray);
    if (!is_mirrored(args.rays, ray))
        mirror.count = facets_directions(max_element(mirrored), mirror.surface.material->roughness);
    mirror.points = points_of(args, ray, mirror.count);
    return mirror;
}

// Its ray number `number`; a share of zero if too little of it reaches the pixel.
DEVICE Drawn mirror_ray(const MirrorRays &args, const Mirror &mirror, unsigned number) {
    if (!mirror.surface.material->facets)
        return Drawn{normalize(mirrored(mirror.surface)), mirror.mirrored};
    const Vec3 point = pattern_point(mirror.points.pattern, mirror.points.first + number);
    Drawn one = drawn(mirror.surface, point.x, point.y);
    one.share = mirror.reaches * one.share / (float)mirror.count;
    if (max_element(one.share) < (args.thin != nullptr ? MIN_THIN : MIN_ONWARD))
        one.share = splat(0.0f);
    return one;
}

// The offset of a ray's pixel, and the parts of the rays of this pixel before.
DEVICE unsigned parts_before(const MirrorRays &args, unsigned ray) {
    const unsigned pixel = pixel_of(args.rays, ray);
    unsigned sum = offset_of(args.rays, pixel);
    for (unsigned before = ray; before-- > 0 && pixel_of(args.rays, before) == pixel;)
        sum += args.thin[before];
    return sum;
}

// The cone that the mirror at a surface point reflects.
DEVICE Cone reflected_cone(const MirrorRays &args, unsigned ray, const Mirror &mirror) {
    const Hit hit = load_hit(args.hits, ray);
    const Corners corners = corners_at(args.scene.triangles, hit.triangle);
    const Cone seen = cone_after(cone_of(args.rays, ray), hit.t);
    const Cone cone = cone_reflected(seen, curvature(args.scene, hit, corners, mirror.surface.point.normal));
    const Material &material = *mirror.surface.material;
    return material.facets ? facets_blurred(cone, material.roughness, mirror.count, max_element(weight_of(args.rays, ray))) : cone;
}

// How many rays the threads of the block before this one have, and how many all.
DEVICE unsigned rays_before(unsigned count, unsigned &all) {
    SHARED(unsigned, warps, [BLOCK / WARP]);
    const unsigned warp = threadIdx.x / WARP, upto = warp_running_sum(count);
    if (lane_of_thread() == WARP - 1)
        warps[warp] = upto;
    __syncthreads();
    unsigned before = upto - count;
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
    unsigned parts = part_of(shares.through, least);
    Material own;
    const Mirror mirror = mirror_at(args, ray, shares.mirrored, own);
    for (unsigned number = 0; number < mirror.count; ++number)
        parts += part_of(mirror_ray(args, mirror, number).share, least);
    args.thin[ray] = parts;
}

KERNEL(mirror_rays_count, MirrorRays, BLOCK, 4) {
    const unsigned ray = blockIdx.x * BLOCK + threadIdx.x;
    const Shares shares = all_shares_of(args, ray);
    const bool thins = args.thin != nullptr && ray < args.rays.count && args.thin[ray] != 0;
    unsigned sum = thins ? parts_before(args, ray) : 0;
    const float least = least_thick(args.rays);
    const auto goes_on = [&](Vec3 share) { return (thins ? thinned(share, least, sum) : share) != splat(0.0f) ? 1u : 0u; };
    unsigned count = goes_on(shares.through);
    Material own;
    const Mirror mirror = mirror_at(args, ray, shares.mirrored, own);
    for (unsigned number = 0; number < mirror.count; ++number)
        count += goes_on(mirror_ray(args, mirror, number).share);
    unsigned all;
    rays_before(count, all);
    if (threadIdx.x == 0)
        args.counts[blockIdx.x] = all;
    if (args.per_ray != nullptr && ray < args.rays.count)
        args.per_ray[ray] = count;
}

KERNEL(mirror_rays_emit, MirrorRays, BLOCK, 4) {
    const unsigned ray = blockIdx.x * BLOCK + threadIdx.x;
    const bool valid = ray < args.rays.count;
    const unsigned count = valid ? args.per_ray[ray] : 0;
    unsigned all;
    unsigned place = args.counts[blockIdx.x] + rays_before(count, all);
    if (count == 0)
        return;
    const Shares shares = all_shares_of(args, ray);
    const bool thins = args.thin != nullptr && args.thin[ray] != 0;
    unsigned sum = thins ? parts_before(args, ray) : 0;
    const float least = least_thick(args.rays);
    const auto left_of = [&](Vec3 share) { return thins ? thinned(share, least, sum) : share; };
    const unsigned pixel = pixel_of(args.rays, ray), sample = sample_of(args.rays, ray);
    Material own;

    // 1. Through the surface.
    const Vec3 through = left_of(shares.through);
    if (through != splat(0.0f)) {
        const Surface surface = surface_at(args.scene, args.rays, args.hits, ray, own);
        if (args.cones != nullptr)
            args.cones[place] = cone_after(cone_of(args.rays, ray), load_hit(args.hits, ray).t);
        const Ray beyond = onward(surface);
        args.onward[place++] = ListedRay{beyond.origin, pixel, beyond.direction, sample + (1u << THROUGHS_SHIFT), through, 0};
    }

    // 2. Mirrored.
    const Mirror mirror = mirror_at(args, ray, shares.mirrored, own);
    if (mirror.count == 0)
        return;
    const Material &material = *mirror.surface.material;
    const unsigned faded = material.facets ? facets_faded(material.roughness) << FADE_SHIFT : 0;
    const unsigned marked = (sample & ((1u << FADE_SHIFT) - 1)) | faded;
    for (unsigned number = 0; number < mirror.count; ++number) {
        const Drawn one = mirror_ray(args, mirror, number);
        const Vec3 share = left_of(one.share);
        if (share == splat(0.0f))
            continue;
        if (args.cones != nullptr)
            args.cones[place] = reflected_cone(args, ray, mirror);
        args.onward[place++] = ListedRay{mirror.surface.point.origin, pixel, one.direction, marked | number << DIRECTION_SHIFT, share, 0};
    }
}
