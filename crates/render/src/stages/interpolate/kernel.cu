// Step 5, first half, on a CUDA device: the weighted mean of what a surface point's light points see. Formula (3).
//
// `interpolate`: one warp per bundle; `fallback_*`: long tests of surface points without usable light points.
#define ALPHA_TEST 1
#ifndef INSTANCES
// Scenes with instances use the module with INSTANCES.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "accel/walk.cuh"
#include "data/rays.cuh"
#include "cuda/tally.cuh"
#include "cuda/warp.cuh"
#include "light_mesh/lattice.cuh"
#include "light_mesh/window.cuh"
#include "shadow/shadow.cuh"
#include "stages/cells/bundle.cuh"
#include "surface.cuh"

// Tells the fallback to compute a share.
#define UNKNOWN -1.0f

// Where a bundle's light points are stored.
struct BundlePoints {
    IVec3 cell;
    Window window;
    // The table's slot of each brick of the window.
    unsigned *slots;
    const unsigned *seen;
};

// The share of an area light that a light point sees.
DEVICE float light_point_share(const Interpolate &args, const VisibilityOfLight &lit, const BundlePoints &points, IVec3 point) {
    const unsigned slot = points.slots[window_place(points.window, point)];
    const unsigned bit = point_bit(point);
    const unsigned long long used = args.points.used[slot];
    const unsigned rank = args.points.rank[slot] + __popcll(used & ((1ull << bit) - 1));
    return (float)lit.seen[rank] / (float)args.sampling.samples;
}

// w of formula (3) as a function of q² = (distance / radius)².
DEVICE float falling_weight(const LightMesh &mesh, float q2) {
    const float falling = fmaxf(1.0f - q2, 0.0f);
    const bool constant = mesh.weight == LightMesh::WEIGHT_CONSTANT, quadratic = mesh.weight == LightMesh::WEIGHT_QUADRATIC;
    return constant ? 1.0f : quadratic ? falling : falling * falling;
}

// The lanes, by what their light points see of a light.
struct LitLanes {
    // Have a light point; have one that sees part of the light; have one that does not see all of it.
    unsigned any, some, not_full;
};

DEVICE LitLanes lit_lanes(const Interpolate &args, const VisibilityOfLight &lit, const BundlePoints &points) {
    LitLanes lanes = {0, 0, 0};
    for (unsigned k = lane_of_thread(); k < args.mesh.points; k += WARP) {
        const unsigned seen = points.seen[k];
        if (seen == 0)
            continue;
        const IVec3 offset = template_offset(args.mesh, k);
        const IVec3 point = points.cell + offset;
        const float share = light_point_share(args, lit, points, point);
        lanes.any |= seen;
        lanes.some |= share > 0.0f ? seen : 0;
        lanes.not_full |= share < 1.0f ? seen : 0;
    }
    lanes.any = warp_or(lanes.any);
    lanes.some = warp_or(lanes.some);
    lanes.not_full = warp_or(lanes.not_full);
    return lanes;
}

// Formula (3) without χ for the lanes in `mixed`; negative if all weights vanish.
DEVICE float weighted_mean(const Interpolate &args, const VisibilityOfLight &lit, const BundlePoints &points, const Vec3 &position,
                           unsigned mixed) {
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const float scale = 1.0f / (mesh.radius * mesh.radius);
    float weights = 0.0f, products = 0.0f;
    for (unsigned row = 0; row < mesh.lines; row++) {
        const TemplateRow line = template_rows[row];
        const int y = points.cell.y + line.y, z = points.cell.z + line.z;
        const float dy = lattice_coordinate(mesh.anchor.y, mesh.step, y) - position.y;
        const float dz = lattice_coordinate(mesh.anchor.z, mesh.step, z) - position.z;
        for (int i = 0; i < line.count; i++) {
            const unsigned seen = points.seen[line.bit + i] & mixed;
            if (seen == 0)
                continue;
            const int x = points.cell.x + line.x + i;
            const float share = light_point_share(args, lit, points, IVec3{x, y, z});
            const float dx = lattice_coordinate(mesh.anchor.x, mesh.step, x) - position.x;
            const float weight = seen >> lane & 1 ? falling_weight(mesh, (dx * dx + dy * dy + dz * dz) * scale) : 0.0f;
            weights += weight;
            products += weight * share;
        }
    }
    return weights > 0.0f ? fminf(products / weights, 1.0f) : UNKNOWN;
}

// LIGHTS lights without an area, starting at `first`: which light points see them is one bit each.
//
// 2. A lane's light points that see a light are the common bits of its mask and a word that is the same for the warp. Returns the
// number of the lane's light points.
template <unsigned LIGHTS>
DEVICE unsigned count_lit(const Interpolate &args, const BundlePoints &points, unsigned first, unsigned *lit_words,
                          unsigned (&lit)[LIGHTS]) {
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    unsigned used = 0, next_seen = points.seen[lane];
    for (unsigned word = 0; word < mesh.words; word++) {
        const unsigned k = WARP * word + lane;
        const unsigned seen = next_seen;
        // Prefetched one iteration before it is needed: masks have a long latency.
        if (word + 1 < mesh.words)
            next_seen = points.seen[k + WARP];
        // Half of the points lie below the tangent plane.
        if (!__any_sync(ALL_LANES, seen != 0)) {
            if (lane < LIGHTS)
                lit_words[lane * mesh.words + word] = 0;
            continue;
        }
        unsigned slot = 0, bit = 0;
        if (seen != 0) {
            const IVec3 offset = template_offset(mesh, k);
            const IVec3 point = points.cell + offset;
            slot = points.slots[window_place(points.window, point)];
            bit = point_bit(point);
        }
        unsigned long long lit_by[LIGHTS];
        for (unsigned i = 0; i < LIGHTS; i++) {
            const unsigned long long *bits = first + i < args.scene.light_count ? args.lit[first + i].bits : nullptr;
            lit_by[i] = bits != nullptr && seen != 0 ? bits[slot] : 0;
        }
        const unsigned mine = warp_transposed(seen);
        used += __popc(mine);
        for (unsigned i = 0; i < LIGHTS; i++) {
            const unsigned word_of_light = __ballot_sync(ALL_LANES, lit_by[i] >> bit & 1);
            lit[i] += __popc(mine & word_of_light);
            if (lane == 0)
                lit_words[i * mesh.words + word] = word_of_light;
        }
    }
    __syncwarp();
    return used;
}

// 3. The weighted means for the lanes in `mixed`, whose light points do not all see the same.
template <unsigned LIGHTS>
DEVICE void weighted_means(const Interpolate &args, const BundlePoints &points, const Vec3 &position, unsigned mixed,
                           const unsigned *lit_words, float (&means)[LIGHTS]) {
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const float scale = 1.0f / (mesh.radius * mesh.radius);
    float weights = 0.0f, products[LIGHTS] = {};
    for (unsigned row = 0; row < mesh.lines; row++) {
        const TemplateRow line = template_rows[row];
        const float dy = lattice_coordinate(mesh.anchor.y, mesh.step, points.cell.y + line.y) - position.y;
        const float dz = lattice_coordinate(mesh.anchor.z, mesh.step, points.cell.z + line.z) - position.z;
        for (int i = 0; i < line.count; i++) {
            const unsigned k = line.bit + i;
            const unsigned seen = points.seen[k] & mixed;
            if (seen == 0)
                continue;
            const float dx = lattice_coordinate(mesh.anchor.x, mesh.step, points.cell.x + line.x + i) - position.x;
            const float weight = seen >> lane & 1 ? falling_weight(mesh, (dx * dx + dy * dy + dz * dz) * scale) : 0.0f;
            weights += weight;
            for (unsigned light = 0; light < LIGHTS; light++)
                products[light] += lit_words[light * mesh.words + k / 32] >> k % 32 & 1 ? weight : 0.0f;
        }
    }
    // Weights that vanish at the rim may all vanish.
    for (unsigned light = 0; light < LIGHTS; light++)
        means[light] = weights > 0.0f ? fminf(products[light] / weights, 1.0f) : UNKNOWN;
}

// 4. χ; and whether a share remains to be computed. Returns whether that is so.
DEVICE bool write_share(const Interpolate &args, const BundleLane &lane, unsigned light, float most, float share) {
    share = most == 0.0f ? 0.0f : fminf(share, most);
    if (lane.alive)
        args.share[(unsigned long long)light * args.rays.count + lane.ray] = share;
    return share < 0.0f;
}

// The shares of LIGHTS lights without an area. Returns whether the lane falls back.
template <unsigned LIGHTS>
DEVICE bool lights_without_size(const Interpolate &args, const BundlePoints &points, const BundleLane &lane, unsigned first,
                                unsigned *lit_words, unsigned &used) {
    const float reach = scene_reach(args.scene, lane.point.origin);
    unsigned lit[LIGHTS] = {};
    used = count_lit(args, points, first, lit_words, lit);
    float most[LIGHTS], means[LIGHTS];
    bool mixed = false;
    for (unsigned i = 0; i < LIGHTS; i++) {
        const bool is_here = first + i < args.scene.light_count && args.lit[first + i].bits != nullptr;
        most[i] = is_here && lane.alive ? above_horizon(lane.point, args.scene.lights[first + i], reach) : 0.0f;
        // If all weights are 1, or all light points see the same, counts give the mean.
        means[i] = used > 0 ? (float)lit[i] / (float)used : UNKNOWN;
        mixed |= args.mesh.weight != LightMesh::WEIGHT_CONSTANT && most[i] > 0.0f && lit[i] > 0 && lit[i] < used;
    }
    const unsigned lanes = __ballot_sync(ALL_LANES, mixed);
    if (lanes != 0) {
        float weighted[LIGHTS];
        weighted_means(args, points, lane.point.position, lanes, lit_words, weighted);
        for (unsigned i = 0; i < LIGHTS; i++)
            means[i] = lit[i] > 0 && lit[i] < used ? weighted[i] : means[i];
    }
    bool fell_back = false;
    for (unsigned i = 0; i < LIGHTS; i++)
        if (first + i < args.scene.light_count && args.lit[first + i].bits != nullptr)
            fell_back |= write_share(args, lane, first + i, most[i], means[i]);
    __syncwarp();
    return fell_back;
}

// The share of one area light. Returns whether the lane falls back.
DEVICE bool light_with_size(const Interpolate &args, const BundlePoints &points, const BundleLane &lane, unsigned light) {
    const VisibilityOfLight lit = args.lit[light];
    const unsigned index = lane_of_thread();
    const float reach = scene_reach(args.scene, lane.point.origin);
    const float most = lane.alive ? above_horizon(lane.point, args.scene.lights[light], reach) : 0.0f;
    // 2. All the same: the mean is known without weights.
    const LitLanes lanes = lit_lanes(args, lit, points);
    float share = lanes.some >> index & 1 ? 1.0f : 0.0f;
    // 3. The weighted mean.
    const unsigned mixed = lanes.some & lanes.not_full & __ballot_sync(ALL_LANES, most > 0.0f);
    if (mixed != 0) {
        const float mean = weighted_mean(args, lit, points, lane.point.position, mixed);
        share = mixed >> index & 1 ? mean : share;
    }
    if (!(lanes.any >> index & 1))
        share = UNKNOWN;
    return write_share(args, lane, light, most, share);
}

// Lists the rays of lanes that fall back. Their order varies from run to run; their results do not depend on it.
DEVICE void list_fallbacks(const Interpolate &args, unsigned ray, bool falls_back) {
    const unsigned lanes = __ballot_sync(ALL_LANES, falls_back), lane = lane_of_thread();
    if (lanes == 0)
        return;
    const unsigned first = lane == 0 ? atomicAdd(args.fallback_count, __popc(lanes)) : 0;
    const unsigned place = __shfl_sync(ALL_LANES, first, 0) + __popc(lanes & lanes_below(lane));
    if (falls_back)
        args.fallback_rays[place] = ray;
}

KERNEL(interpolate, Interpolate, BUNDLE_WARPS * WARP, 8) {
    DYNAMIC_SHARED(unsigned, shared);
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const unsigned long long number = (unsigned long long)blockIdx.x * BUNDLE_WARPS + threadIdx.x / WARP;
    if (number >= args.count)
        return;
    const unsigned long long index = args.first + number;
    const Bundle bundle = args.bundles[index];
    const BundleLane own = lane_of_bundle(args.scene, args.rays, args.hits, args.members, bundle);

    // 1. The bricks around the cell.
    BundlePoints points;
    points.cell = point_of(bundle.cell);
    points.window = window_around(mesh, points.cell);
    const int bricks = window_size(points.window);
    points.slots = shared + threadIdx.x / WARP * (bricks + MAX_LIGHTS * mesh.words);
    unsigned *lit_words = points.slots + bricks;
    points.seen = args.masks + index * 32 * mesh.words;
    for (int place = lane; place < bricks; place += (int)WARP)
        points.slots[place] = args.slots[index * bricks + place];
    __syncwarp();

    bool fell_back = false;
    unsigned used = 0, first = 0;
    do {
        // Most scenes have one light.
        fell_back |= args.scene.light_count == 1
                         ? lights_without_size<1>(args, points, own, first, lit_words, used)
                         : lights_without_size<MAX_LIGHTS>(args, points, own, first, lit_words, used);
        first += MAX_LIGHTS;
    } while (first < args.scene.light_count);
    for (unsigned light = 0; light < args.scene.light_count; light++)
        if (args.lit[light].seen != nullptr)
            fell_back |= light_with_size(args, points, own, light);
    if (own.alive)
        args.used[own.ray] = used;
    count(tally_shard(args.tally).fallbacks, fell_back);
    list_fallbacks(args, own.ray, fell_back);
}

// The visible share of each light that is still unknown, from the surface point's own rays.
template <typename Structure>
DEVICE void fallback(const Interpolate &args, const Structure &structure) {
    const unsigned long long number = (args.first + blockIdx.x) * blockDim.x + threadIdx.x;
    if (number >= *args.fallback_count)
        return;
    const unsigned ray = args.fallback_rays[number];
    for (unsigned light = 0; light < args.scene.light_count; light++) {
        float &share = args.share[(unsigned long long)light * args.rays.count + ray];
        if (share < 0.0f) {
            const SurfacePoint point = surface_point_of(args.scene, args.rays, args.hits, ray);
            share = fallback_share(structure, args.scene, args.sampling, args.tally, point, ray_key(args.rays, ray), light);
        }
    }
}

KERNEL_PER_STRUCTURE(fallback, Interpolate, BLOCK, 2)
