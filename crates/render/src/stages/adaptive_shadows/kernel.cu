// Adaptive shadow rays on a CUDA device: twin of cpu.rs.
//
// 1. `first_rays_*`: one ray from each surface point to each light, one thread per ray.
// 2. `find_open`: where neighbours agree, the share is theirs; elsewhere it is negative for now. `list_open`: where that is.
// 3. `open_rays_*`: a ray to each sample from there, one thread per surface point and light.
#define ALPHA_TEST 1
#ifndef INSTANCES
// Scenes with instances use the module with INSTANCES.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "data/rays.cuh"
#include "shadow/terminator.cuh"
#include "stages/adaptive_shadows/first.cuh"
#include "stages/shadow_rays/samples.cuh"

// Edge of the answers that a block reads.
#define EDGE (BLOCK_SIDE + 2 * AROUND)

// The share of a light for a ray.
DEVICE float &share_of(const Shadows &args, unsigned light, unsigned ray) {
    return args.share[(unsigned long long)light * args.rays.count + ray];
}

// Where the first ray from a surface point to a light ends. `known` is the answer but for the ray. False if there is nothing to ask.
DEVICE bool first_ray(const AdaptiveShadows &args, const Light &light, Shape shape, unsigned ray, const SurfacePoint &point,
                      Vec3 &target, unsigned &known) {
    const Shadows &shadows = args.shadows;
    known = 0;
    if (shape == SHAPE_POINT) {
        target = light_center(light, point.origin, scene_reach(shadows.scene, point.origin));
        return shadows.share != nullptr;
    }
    const Extent extent = extent_of(shadows.scene, light, shape, point);
    const unsigned place = place_of(shadows.rays.view, pixel_of(shadows.rays, ray));
    target = first_target(extent, point.origin, args.places, place);
    return at_horizon(extent, point.normal, known);
}

// Casts the rays of a surface point to all lights of this launch. Returns how many were cast. Without a surface point there are no answers.
template <class Structure>
DEVICE unsigned ask_lights(const AdaptiveShadows &args, const Structure &structure, unsigned ray, bool has, const SurfacePoint &flat) {
    const Shadows &shadows = args.shadows;
    unsigned cast = 0;
    unsigned char *answer = args.answers + args.first_answer + ray;
    for (unsigned index = shadows.first_light; index < shadows.end_light; ++index, answer += args.answer_count) {
        const Light &light = shadows.scene.lights[index];
        const Shape shape = shape_of(shadows.sampling, light);
        Vec3 target = {};
        unsigned known = 0;
        SurfacePoint point = flat;
        if (has)
            point = shadow_point_of(shadows.scene, shadows.rays, shadows.hits, ray, light, flat);
        const bool asks = has && first_ray(args, light, shape, ray, point, target, known);
        const bool casts = asks && dot(point.normal, target - point.origin) > 0.0f;
        cast += casts;
        const bool lit = casts && !hidden(structure, shadows.tally, light, point.origin, target);
        if (shape != SHAPE_POINT)
            *answer = (unsigned char)(!asks ? 0 : !casts ? ANSWER_STRADDLES : known | (lit ? ANSWER_LIT : ANSWER_DARK));
        else if (asks)
            share_of(shadows, index, ray) = lit ? 1.0f : 0.0f;
    }
    return cast;
}

template <class Structure>
DEVICE void first_rays(const AdaptiveShadows &args, const Structure &structure) {
    const Shadows &shadows = args.shadows;
    unsigned ray, cast = 0;
    if (ray_of_thread(shadows.rays, shadows.first + blockIdx.x, threadIdx.x, ray)) {
        const bool has = load_hit(shadows.hits, ray).triangle != Hit::NONE;
        SurfacePoint point = {};
        if (has)
            point = surface_point_of(shadows.scene, shadows.rays, shadows.hits, ray);
        cast = ask_lights(args, structure, ray, has, point);
    }
    count(tally_shard(shadows.tally).shadow_rays, cast);
}

// Reads the answers of a block's pixels and of those around them, from row `top` and column `left` on.
DEVICE void load_answers(const AdaptiveShadows &args, unsigned light, int left, int top, unsigned *near) {
    const int width = (int)args.shadows.rays.view.size[0], rows = (int)(args.answer_count / (unsigned)width);
    const unsigned char *answers = args.answers + (unsigned long long)light * args.answer_count;
    for (unsigned place = threadIdx.x; place < EDGE * EDGE; place += BLOCK) {
        const int x = left + (int)(place % EDGE), y = top + (int)(place / EDGE);
        const bool has = x >= 0 && x < width && y >= 0 && y < rows;
        near[place] = has ? answers[(unsigned long long)y * (unsigned)width + (unsigned)x] : 0;
    }
}

KERNEL(find_open, AdaptiveShadows, BLOCK, 4) {
    SHARED(unsigned, near, [EDGE * EDGE]);
    SHARED(unsigned, warps, [BLOCK / WARP]);
    const Shadows &shadows = args.shadows;
    const unsigned slice = blockIdx.x / args.tiles, tile = blockIdx.x % args.tiles, light = shadows.first_light + slice;
    const unsigned width = shadows.rays.view.size[0], across = (width + BLOCK_SIDE - 1) / BLOCK_SIDE;
    const bool has_answers = shape_of(shadows.sampling, shadows.scene.lights[light]) != SHAPE_POINT;
    const unsigned left = tile % across * BLOCK_SIDE, top = tile / across * BLOCK_SIDE;
    if (has_answers)
        load_answers(args, slice, (int)left - (int)AROUND, (int)(top + args.first_answer / width) - (int)AROUND, near);
    __syncthreads();

    const View &view = shadows.rays.view;
    const bool leaves = leaves_image(view);
    unsigned ray;
    bool open = false;
    if (has_answers && ray_of_thread(shadows.rays, tile, threadIdx.x, ray)) {
        const unsigned *corner = near + (ray / width - top) * EDGE + (ray % width - left);
        const unsigned own = corner[AROUND * EDGE + AROUND];
        unsigned all = 0;
        for (unsigned place = 0; place < FIRST_TARGETS; ++place) {
            const unsigned row = place / NEIGHBORHOOD, column = place % NEIGHBORHOOD;
            if (!leaves || !is_beyond(view, pixel_of(shadows.rays, ray), (int)column - (int)AROUND, (int)row - (int)AROUND))
                all |= corner[row * EDGE + column];
        }
        open = (own & ANSWER_STRADDLES) != 0 || (own != 0 && (all & ANSWER_BOTH) == ANSWER_BOTH);
        share_of(shadows, light, ray) = open ? -1.0f : (float)(own & ANSWER_LIT);
    }
    const unsigned lanes = __ballot_sync(ALL_LANES, open);
    if (lane_of_thread() == 0)
        warps[threadIdx.x / WARP] = __popc(lanes);
    __syncthreads();
    if (threadIdx.x != 0)
        return;
    unsigned sum = 0;
    for (unsigned warp = 0; warp < BLOCK / WARP; ++warp)
        sum += warps[warp];
    args.counts[blockIdx.x] = sum;
}

#if !INSTANCES
KERNEL(list_open, AdaptiveShadows, BLOCK, 4) {
    SHARED(unsigned, warps, [BLOCK / WARP]);
    const Shadows &shadows = args.shadows;
    unsigned place = args.counts[blockIdx.x], ray;
    if (args.counts[blockIdx.x + 1] == place)
        return;
    const unsigned tile = blockIdx.x % args.tiles, light = shadows.first_light + blockIdx.x / args.tiles;
    const bool open = ray_of_thread(shadows.rays, tile, threadIdx.x, ray) && share_of(shadows, light, ray) < 0.0f;
    const unsigned lanes = __ballot_sync(ALL_LANES, open), lane = lane_of_thread();
    if (lane == 0)
        warps[threadIdx.x / WARP] = __popc(lanes);
    __syncthreads();
    for (unsigned warp = 0; warp < threadIdx.x / WARP; ++warp)
        place += warps[warp];
    if (open)
        args.entries[place + __popc(lanes & lanes_below(lane))] = (unsigned long long)light << 32 | ray;
}
#endif

template <class Structure>
DEVICE void open_rays(const AdaptiveShadows &args, const Structure &structure) {
    const Shadows &shadows = args.shadows;
    const unsigned long long place = (shadows.first + blockIdx.x) * BLOCK + threadIdx.x;
    unsigned cast = 0;
    if (place < args.entry_count) {
        const unsigned light = (unsigned)(args.entries[place] >> 32), ray = (unsigned)args.entries[place];
        const Shape shape = shape_of(shadows.sampling, shadows.scene.lights[light]);
        const SurfacePoint point =
            shadow_point_of(shadows.scene, shadows.rays, shadows.hits, ray, shadows.scene.lights[light]);
        add_seen(shadows, shape, light, ray, trace_samples(shadows, structure, point, light, ray, shape, cast));
    }
    count(tally_shard(shadows.tally).shadow_rays, cast);
}

KERNEL_PER_STRUCTURE(first_rays, AdaptiveShadows, BLOCK, 4)

KERNEL_PER_STRUCTURE(open_rays, AdaptiveShadows, BLOCK, 3)
