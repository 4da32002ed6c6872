// The shadows of an item, one surface point per lane: twin of cpu.rs, with the same steps.
#pragma once

#include "accel/search.cuh"
#include "cuda/rays.cuh"
#include "cuda/tally.cuh"
#include "shadow/seen.cuh"
#include "stages/occluder_lists/candidates.cuh"

// The shared memory of a warp.
struct ListMemory {
    float4 *candidates;
    PlanesMemory *planes;
    unsigned *found, *search;
    // The place of x = 0 in each row of the lane's samples, WARP apart.
    float *offsets;
};

DEVICE ListMemory list_memory(unsigned *shared, unsigned search_words) {
    ListMemory memory;
    memory.candidates = reinterpret_cast<float4 *>(shared);
    shared += OCCLUDER_WORDS * WARP;
    memory.planes = reinterpret_cast<PlanesMemory *>(shared);
    shared += PLANE_WORDS;
    memory.found = shared;
    shared += FOUND_TRIANGLES;
    memory.search = shared;
    shared += search_words;
    memory.offsets = reinterpret_cast<float *>(shared) + lane_of_thread();
    return memory;
}

// A warp's surface points and their view of a light.
struct ItemSight {
    SurfacePoint point;
    Sight sight;
    Shape shape;
    // Whether the lane has a surface point.
    bool has;
};

DEVICE void store_candidate(float4 *candidate, const Occluding &triangle) {
    const Vec3 &a = triangle.a, &b = triangle.b, &c = triangle.c, &d = triangle.edge_a, &e = triangle.edge_b, &f = triangle.edge_c,
               &n = triangle.plane;
    candidate[0] = float4{a.x, a.y, a.z, b.x};
    candidate[1] = float4{b.y, b.z, c.x, c.y};
    candidate[2] = float4{c.z, d.x, d.y, d.z};
    candidate[3] = float4{e.x, e.y, e.z, f.x};
    candidate[4] = float4{f.y, f.z, n.x, n.y};
    candidate[5] = float4{n.z, 0.0f, 0.0f, 0.0f};
}

DEVICE Occluding load_candidate(const float4 *candidate) {
    const float4 p = candidate[0], q = candidate[1], r = candidate[2], s = candidate[3], t = candidate[4], u = candidate[5];
    return Occluding{Vec3{p.x, p.y, p.z}, Vec3{p.w, q.x, q.y}, Vec3{q.z, q.w, r.x}, Vec3{r.y, r.z, r.w},
                     Vec3{s.x, s.y, s.z}, Vec3{s.w, t.x, t.y}, Vec3{t.z, t.w, u.x}};
}

// 4. What candidates hide, until nothing is left. Returns whether anything is.
template <unsigned WORDS>
DEVICE bool test_candidates(const ItemSight &item, const SampleRows &set, const ListMemory &memory, unsigned count,
                            Seen<WORDS> &seen) {
    for (unsigned k = 0; k < count; ++k) {
        const Occluding triangle = load_candidate(memory.candidates + OCCLUDER_WORDS / 4 * k);
        if (item.shape == SHAPE_POINT)
            seen.bits[0] &= hides_center(item.point, item.sight, triangle) ? 0 : 1;
        else
            hide<WORDS, WARP>(item.point, item.sight, triangle, set, memory.offsets, any(seen), seen.bits);
        if (!__any_sync(ALL_LANES, any(seen)))
            return false;
    }
    return true;
}

// 3. Chooses among up to 32 of the triangles found, one per lane, and tests them. Returns whether anything is still seen.
template <unsigned WORDS>
DEVICE bool test_found(const ItemSight &item, const SampleRows &set, const Shaft &shaft, const Triangle *triangles,
                       const ListMemory &memory, unsigned first, unsigned count, Seen<WORDS> &seen) {
    const unsigned lane = lane_of_thread();
    Occluding own;
    Choice choice = DROPPED;
    if (lane < count) {
        own = occluding(load_corners(triangles + memory.found[first + lane]));
        choice = choose(shaft, own);
    }
    // A triangle that hides everything comes first; then there is nothing left to ask.
    UNROLL
    for (int least = DARK; least >= KEPT; --least) {
        const unsigned lanes = __ballot_sync(ALL_LANES, choice == least);
        if (lanes == 0)
            continue;
        __syncwarp();
        if (choice == least)
            store_candidate(memory.candidates + OCCLUDER_WORDS / 4 * __popc(lanes & lanes_below(lane)), own);
        __syncwarp();
        if (!test_candidates(item, set, memory, __popc(lanes), seen))
            return false;
    }
    return true;
}

// The number of samples of a light that each lane sees.
template <unsigned WORDS, class Structure>
DEVICE unsigned seen_of_light(const Shadows &args, const Structure &structure, const ItemSight &item, unsigned light,
                              const SampleRows &set, const ListMemory &memory) {
    // 1. The samples in front of the surface.
    Seen<WORDS> seen = seen_unhidden<WORDS>(item.has, item.point, item.sight, item.shape, set, memory.offsets);
    count(tally_shard(args.tally).shadow_rays, number(seen));
    const bool alive = any(seen);
    if (!__any_sync(ALL_LANES, alive))
        return 0;

    // 2. Search.
    const Light &emitter = args.scene.lights[light];
    const Vec3 &origin = item.point.origin;
    const Bounds origins = {
        Vec3{warp_min(alive ? origin.x : F32_MAX), warp_min(alive ? origin.y : F32_MAX), warp_min(alive ? origin.z : F32_MAX)},
        Vec3{warp_max(alive ? origin.x : -F32_MAX), warp_max(alive ? origin.y : -F32_MAX), warp_max(alive ? origin.z : -F32_MAX)}};
    const Bounds bounds = emitter_bounds(args.scene, emitter, item.shape, origins);
    const TangentPlanes planes = tangent_planes(origins.low, alive, origin, item.point.normal, memory.planes);
    const auto region = region_above(shadow_region(origins, bounds), planes, 0.0f);
    const bool ball = emitter.kind == Light::POINT || emitter.kind == Light::SPHERE;
    const Shaft shaft = shaft_of(origins, bounds, ball ? emitter.radius : INFINITE);
    auto search = begin_search(structure, region, memory.search);
    unsigned found = 0;
    while (goes_on(structure, search) || found != 0) {
        while (goes_on(structure, search) && found < WARP)
            next_triangles<true>(structure, region, search, memory.found, found);
        const unsigned count = min(found, WARP);
        found -= count;
        // 3, 4. Candidates, and what they hide.
        if (!test_found(item, set, shaft, structure.triangles, memory, found, count, seen))
            return 0;
        __syncwarp();
    }
    return number(seen);
}

template <unsigned WORDS, class Structure>
DEVICE void shadows_of_item(const Shadows &args, const Structure &structure) {
    DYNAMIC_SHARED(unsigned, shared);
    const ListMemory memory = list_memory(shared, search_words(structure));
    const unsigned long long entry = args.items[args.first + (args.count - 1 - blockIdx.x)];
    const unsigned lane = lane_of_thread(), count = (unsigned)entry & 63;
    ItemSight item;
    item.has = lane < count;
    const unsigned ray = args.members[(entry >> 6) + (item.has ? lane : 0)];
    item.point = surface_point_of(args.scene, args.rays, args.hits, ray);
    const unsigned long long key = ray_key(args.rays, ray);
    for (unsigned light = args.first_light; light < args.end_light; ++light) {
        item.shape = shape_of(args.sampling, args.scene.lights[light]);
        const SampleRows &set = args.sets[item.shape == SHAPE_RECTANGLE ? SHAPE_RECTANGLE : SHAPE_DISC];
        if (item.shape == SHAPE_POINT && args.set != 0)
            continue;
        item.sight = sight_of(args.scene, args.sampling, light, item.shape, set.lines, item.point, key);
        const unsigned seen = seen_of_light<WORDS>(args, structure, item, light, set, memory);
        if (item.has)
            add_seen(args, item.shape, light, ray, seen);
        __syncwarp();
    }
}
