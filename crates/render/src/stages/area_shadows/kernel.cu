// The reference on a CUDA device: twin of cpu.rs. A warp takes 32 surface points, one after the other; lanes are triangles.
// `area_shadows_N_*`: samples in up to N words of bits.
#define ALPHA_TEST 1
#ifndef INSTANCES
// Scenes with instances use the module with INSTANCES.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "accel/search.cuh"
#include "data/rays.cuh"
#include "cuda/tally.cuh"
#include "shadow/seen.cuh"
#include "shadow/terminator.cuh"
#include "shadow/weights.cuh"

// The value of one lane.
DEVICE Sight broadcast(const Sight &projected, unsigned lane) {
    Sight result = projected;
    result.center = warp_broadcast(projected.center, lane);
    result.along = warp_broadcast(projected.along, lane);
    result.across = warp_broadcast(projected.across, lane);
    result.end = __shfl_sync(ALL_LANES, projected.end, lane);
    return result;
}

// What a lane's triangle, if it has one, leaves of the samples.
template <unsigned WORDS, class Handle>
DEVICE void test_triangle(const SurfacePoint &point, const Sight &projected, Shape shape, const RowTable &table,
                          const AlphaMask *alpha_mask, const Handle &triangle, bool has, Seen<WORDS> &seen) {
    const Occluding own = occluding(load_corners(triangle));
    const Hiding hiding = {own.parts, alpha_mask, cut_of(triangle)};
    if (shape == SHAPE_POINT)
        seen.bits[0] &= has && hides_center(point, projected, hiding) ? 0 : 1;
    else
        hide<WORDS>(point, projected, hiding, table, has, seen.bits);
}

// The samples that the surface point of lane `owner` sees: `seen` without those that any triangle hides. `table` has that lane's offsets.
template <unsigned WORDS, class Structure>
DEVICE void test_point(const Shadows &args, const Structure &structure, const Light &light, Shape shape, ShaftFaces *faces,
                       const SurfacePoint &point, const Sight &projected, const RowTable &table, PlanesMemory *planes,
                       unsigned *found, unsigned *memory, Seen<WORDS> &seen) {
    const unsigned lane = lane_of_thread();
    const Bounds origin = {point.origin, point.origin};
    const TangentPlanes plane = tangent_planes(point.origin, lane == 0, point.origin, point.normal, planes);
    const auto region = region_above(shadow_region(origin, emitter_bounds(args.scene, light, shape, origin), faces), plane, 0.0f);
    auto search = begin_search(structure, region, memory);
    unsigned count = 0;
    while (goes_on(structure, search) || count != 0) {
        while (goes_on(structure, search) && count < WARP)
            next_triangles<true>(structure, region, search, found, count);
        const unsigned taken = min(count, WARP);
        count -= taken;
        if (taken != 0) {
            const unsigned place = found[count + (lane < taken ? lane : 0)];
            test_triangle<WORDS>(point, projected, shape, table, alpha_mask_of(structure), triangle_at(structure, place),
                                 lane < taken, seen);
        }
        __syncwarp();
    }
}

// Adds what a lane sees of a light with this set of samples to its share.
template <unsigned WORDS>
DEVICE void add_share(const Shadows &args, unsigned light, unsigned ray, Shape shape, const SampleRows &set, const SurfacePoint &point,
                      const Sight &projected, const RowTable &table, const Seen<WORDS> &seen, unsigned above) {
    const Light &emitter = args.scene.lights[light];
    const float near = nearness_of(args, shape, emitter, point);
    const unsigned left = number(seen);
    if (!(near > 0.0f)) {
        add_seen(args, shape, light, ray, left);
        return;
    }
    WeightSums sums = {0.0f, 0.0f};
    if (!is_plain(args, above, left))
        sums = weights_of<WORDS>(&emitter, point.normal, projected, &set, table, seen);
    add_weighed(args, light, ray, near, Weighed{above, left, sums.all, sums.lit});
}

template <unsigned WORDS, class Structure>
DEVICE void shadows_of_points(const Shadows &args, const Structure &structure) {
    DYNAMIC_SHARED(unsigned, shared);
    PlanesMemory *planes = reinterpret_cast<PlanesMemory *>(shared);
    ShaftFaces *faces = reinterpret_cast<ShaftFaces *>(shared + PLANE_WORDS);
    unsigned *found = shared + PLANE_WORDS + SHAFT_WORDS, *memory = found + FOUND_TRIANGLES;
    unsigned *tables = memory + search_words(structure);
    float *offsets = reinterpret_cast<float *>(tables + 2 * ROW_TABLE_WORDS);
    const unsigned lane = lane_of_thread();
    fill_row_table(args.sets[SHAPE_DISC], tables);
    fill_row_table(args.sets[SHAPE_RECTANGLE], tables + ROW_TABLE_WORDS);
    const unsigned long long warp = args.first + blockIdx.x;
    const unsigned warps = BLOCK / WARP;
    unsigned ray = 0;
    const bool has = ray_of_thread(args.rays, (unsigned)(warp / warps), (unsigned)(warp % warps) * WARP + lane, ray) &&
                     load_hit(args.hits, ray).triangle != Hit::NONE;
    SurfacePoint flat = {};
    if (has)
        flat = surface_point_of(args.scene, args.rays, args.hits, ray);
    for (unsigned light = args.first_light; light < args.end_light; ++light) {
        const Light &emitter = args.scene.lights[light];
        const Shape shape = shape_of(args.sampling, emitter);
        const SampleRows &set = args.sets[shape == SHAPE_RECTANGLE ? SHAPE_RECTANGLE : SHAPE_DISC];
        if (shape == SHAPE_POINT && args.set != 0)
            continue;
        Sight projected = {};
        SurfacePoint point = flat;
        if (has)
            point = shadow_point_of(args.scene, args.rays, args.hits, ray, emitter, flat);
        if (has)
            projected = projected_light_of(args.scene, args.sampling, light, shape, set.lines, point, ray_key(args.rays, ray));
        const RowTable own = row_table(tables, shape, offsets + lane);
        Seen<WORDS> seen = seen_unhidden<WORDS>(has, point, projected, shape, set, own);
        __syncwarp();
        const unsigned above = number(seen);
        count(tally_shard(args.tally).shadow_rays, above);
        for (unsigned rest = __ballot_sync(ALL_LANES, any(seen)); rest != 0; rest &= rest - 1) {
            const unsigned owner = __ffs(rest) - 1;
            const SurfacePoint asked = {warp_broadcast(point.position, owner), warp_broadcast(point.origin, owner),
                                        warp_broadcast(point.normal, owner)};
            Seen<WORDS> left;
            UNROLL
            for (unsigned word = 0; word < WORDS; ++word)
                left.bits[word] = __shfl_sync(ALL_LANES, seen.bits[word], owner);
            test_point<WORDS>(args, structure, emitter, shape, faces, asked, broadcast(projected, owner),
                              row_table(tables, shape, offsets + owner), planes, found, memory, left);
            UNROLL
            for (unsigned word = 0; word < WORDS; ++word) {
                const unsigned bits = ~warp_or(~left.bits[word]);
                seen.bits[word] = lane == owner ? bits : seen.bits[word];
            }
        }
        if (has)
            add_share<WORDS>(args, light, ray, shape, set, point, projected, own, seen, above);
        __syncwarp();
    }
}

template <class Structure>
DEVICE void area_shadows_1(const Shadows &args, const Structure &structure) { shadows_of_points<1>(args, structure); }

template <class Structure>
DEVICE void area_shadows_3(const Shadows &args, const Structure &structure) { shadows_of_points<3>(args, structure); }

template <class Structure>
DEVICE void area_shadows_10(const Shadows &args, const Structure &structure) { shadows_of_points<MAX_WORDS>(args, structure); }

KERNEL_PER_STRUCTURE(area_shadows_1, Shadows, WARP, 16)
KERNEL_PER_STRUCTURE(area_shadows_3, Shadows, WARP, 16)
KERNEL_PER_STRUCTURE(area_shadows_10, Shadows, WARP, 16)
