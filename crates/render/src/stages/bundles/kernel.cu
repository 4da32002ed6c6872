// Bundles on a CUDA device: twin of cpu.rs, a block for each tile.
//
// 1. to 3. `group_bundles`: the bundles of each tile.
// 4. `gather_bundles`: those of all tiles in one list.
#include "cuda/prelude.cuh"

#include "data/rays.cuh"
#include "cuda/tile.cuh"
#include "shadow/terminator.cuh"

// One coordinate in cells: which, and in which quarter of it.
DEVICE unsigned cell_coordinate(float coordinate, unsigned &quarter) {
    const float cell = floorf(coordinate);
    quarter = (unsigned)__float2int_rd(4.0f * (coordinate - cell)) & 3;
    return (unsigned)__float2int_rd(cell);
}

DEVICE unsigned long long joined(unsigned long long key, unsigned part) {
    key = (key ^ part) * GOLDEN_RATIO;
    return key << 29 | key >> 35;
}

// The digits of a quarter, two places apart.
DEVICE unsigned spread(unsigned quarter) { return (quarter & 1) | (quarter & 2) << 2; }

// 16 bits of a hash of a surface point's cell, 6 bits of its place in the cell, 10 bits of its thread.
DEVICE unsigned sort_word(const GroupBundles &args, const SurfacePoint &point, unsigned thread) {
    const float width = CELL_PIXELS * (args.spacing[0] + args.spacing[1] * length(point.position - args.rays.view.origin));
    // A power of two, so that neighbours at different distances have the same cells.
    const float step = __uint_as_float((__float_as_uint(width) & F32_INFINITY_BITS) + F32_EXPONENT_STEP);
    if (!(width >= F32_MIN_POSITIVE && is_finite(step)))
        return thread;
    const Vec3 position = point.position / step;
    unsigned x, y, z;
    unsigned long long key = joined(0, cell_coordinate(position.x, x));
    key = joined(key, cell_coordinate(position.y, y));
    key = joined(key, cell_coordinate(position.z, z));
    key = joined(key, __float_as_uint(step));
    // All ones is reserved for threads without a surface point.
    const unsigned hash = min((unsigned)(key >> 32) & 0xffff, LAST_HASH);
    return hash << 16 | (spread(x) << 2 | spread(y) << 1 | spread(z)) << 10 | thread;
}

// The lowest corner of each warp's points, and the highest, negated.
struct Corner {
    float coordinates[6][TILE / WARP];
};

static_assert(TILE / WARP == WARP, "a lane for each warp of a block");

// Writes the box around the origins of the threads that have one: shadow rays start between `origin` and `lifted`.
DEVICE void box_tile(bool has, const Vec3 &origin, const Vec3 &lifted, Corner &corner, TileBox &tile) {
    const unsigned lane = lane_of_thread(), warp = threadIdx.x / WARP;
    for (unsigned k = 0; k < 6; ++k) {
        const float a = component(k % 3, origin), b = component(k % 3, lifted);
        const float lowest = warp_min(!has ? F32_MAX : k < 3 ? fminf(a, b) : -fmaxf(a, b));
        if (lane == 0)
            corner.coordinates[k][warp] = lowest;
    }
    __syncthreads();
    if (warp < 6) {
        const float lowest = warp_min(corner.coordinates[warp][lane]);
        if (lane == 0)
            (warp < 3 ? &tile.low.x : &tile.high.x)[warp % 3] = warp < 3 ? lowest : -lowest;
    }
}

KERNEL(group_bundles, GroupBundles, TILE, 2) {
    SHARED(unsigned, rays, [TILE]);
    SHARED(unsigned, words, [TILE]);
    SHARED(unsigned, warps, [TILE / WARP]);
    SHARED(Corner, corner, );
    const unsigned thread = threadIdx.x;
    const unsigned long long tile = args.first_block + blockIdx.x;

    // 1. The cell of each surface point, and its place there.
    unsigned ray = 0, word = NO_POINT;
    const bool has = tile_ray_of_thread(args.rays, (unsigned)tile, thread, ray) && args.hits[ray].triangle != Hit::NONE;
    SurfacePoint point = {};
    Vec3 lifted = {};
    if (has) {
        point = surface_point_of(args.scene, args.rays, args.hits, ray);
        rays[thread] = ray;
        word = sort_word(args, point, thread);
        lifted = point.origin + largest_lift(args.scene, args.hits, ray, point);
    }
    box_tile(has, point.origin, lifted, corner, args.tiles[tile]);
    __syncthreads();

    // 2. Sort by cell, within a cell along the curve.
    word = sorted(word, words);
    const bool is_point = word != NO_POINT;
    __syncthreads();
    words[thread] = word;
    __syncthreads();
    const bool first_of_cell = is_point && (thread == 0 || words[thread - 1] >> 16 != word >> 16);

    // 3. Every cell begins a bundle, and so does every 32nd point after its first.
    const TileBundle bundle = bundle_of_thread(is_point, first_of_cell, words, warps);
    const unsigned long long place = tile * TILE;
    if (is_point)
        args.members[place + thread] = rays[word & (TILE - 1)];
    if (bundle.begins)
        args.ends[place + bundle.number] = (unsigned short)bundle.end;
    if (thread == 0)
        args.counts[tile] = bundle.count;
}

KERNEL(gather_bundles, GroupBundles, TILE, 1) {
    const unsigned first = args.counts[blockIdx.x], count = args.counts[blockIdx.x + 1] - first;
    if (threadIdx.x >= count)
        return;
    const unsigned long long place = (unsigned long long)blockIdx.x * TILE;
    const unsigned start = threadIdx.x == 0 ? 0 : args.ends[place + threadIdx.x - 1], end = args.ends[place + threadIdx.x];
    args.bundles[first + threadIdx.x] = (place + start) << 6 | (end - start);
}
