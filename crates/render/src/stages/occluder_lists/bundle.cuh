// The shadows of a bundle, one surface point per lane: twin of cpu.rs, with the same steps.
#pragma once

#include "accel/search.cuh"
#include "data/rays.cuh"
#include "cuda/tally.cuh"
#include "shadow/sample_ray.cuh"
#include "shadow/terminator.cuh"
#include "shadow/weights.cuh"
#include "stages/occluder_lists/candidates.cuh"

// What steps cost, in 64ths of that of a ray at a node; as on the CPU, see cpu.rs.

// A round of a search.
#define ROUND_COST 64
// To choose among up to 32 triangles.
#define CHOICE_COST 96
// To test a candidate, and the same for each row of samples.
#define CANDIDATE_COST 48
#define ROW_COST 4
// A ray.
#define RAY_COST (300 * 64)
// What is spent when lists are compared with rays for the first time.
#define FIRST_CHECK (4 * RAY_COST)
// Rays are considered when this many times what was spent exceeds their price.
#define MIN_COST_RATIO 2.0f

// What is known of the surface points that see anything of a light. Often it is the same for the next one.
struct Around {
    Bounds origins;
    // Number of tangent planes.
    unsigned planes;
    // The points.
    unsigned lanes;
};

// The shared memory of a warp.
struct ListMemory {
    float4 *candidates;
    // What is searched: the same for all lanes, and too much for their registers.
    ShaftFaces *faces;
    Shaft *shaft;
    Around *around;
    PlanesMemory *planes;
    unsigned *found, *starts, *search;
    // The rows of discs and rectangles.
    unsigned *tables;
    // The place of x = 0 in each row of the lane's samples, WARP apart.
    float *offsets;
};

static_assert(sizeof(ShaftFaces) + sizeof(Shaft) + sizeof(Around) <= 4 * SEARCHED_WORDS, "words of what is searched");

DEVICE ListMemory list_memory(unsigned *shared, unsigned search_words) {
    ListMemory memory;
    memory.candidates = reinterpret_cast<float4 *>(shared);
    shared += 4 * OCCLUDER_PARTS * WARP;
    memory.faces = reinterpret_cast<ShaftFaces *>(shared);
    memory.shaft = reinterpret_cast<Shaft *>(shared + sizeof(ShaftFaces) / 4);
    memory.around = reinterpret_cast<Around *>(shared + (sizeof(ShaftFaces) + sizeof(Shaft)) / 4);
    shared += SEARCHED_WORDS;
    memory.planes = reinterpret_cast<PlanesMemory *>(shared);
    shared += PLANE_WORDS;
    memory.found = shared;
    shared += FOUND_TRIANGLES;
    memory.starts = shared;
    shared += MAX_SEARCH_ROOTS;
    memory.search = shared;
    shared += search_words;
    memory.tables = shared;
    shared += 2 * ROW_TABLE_WORDS;
    memory.offsets = reinterpret_cast<float *>(shared) + lane_of_thread();
    return memory;
}

// A warp's surface points and their view of a light.
struct BundleProjection {
    SurfacePoint point;
    Sight projected;
    Shape shape;
    // Whether the lane has a surface point.
    bool has;
    // How far the lane's surface is bent; whether any lane's is; whether the points are placed for a light.
    float bend;
    bool curved, placed;
    // Whether the view is computed.
    bool looked;
    unsigned long long key;
    unsigned ray;
    // The samples of all lights in front of the lane's surface.
    unsigned asked;
};

// The view of a light is computed when it is needed: most bundles find nothing between them and a light. This and what follows are calls,
// so that the instructions that all bundles need fit into the cache.
COLD Sight view_of(const Shadows &args, unsigned light, Shape shape, unsigned lines, SurfacePoint point, unsigned long long key) {
    return projected_light_of(args.scene, args.sampling, light, shape, lines, point, key);
}

DEVICE void look(const Shadows &args, BundleProjection &bundle, unsigned light, const SampleRows &set) {
    bundle.projected = view_of(args, light, bundle.shape, set.lines, bundle.point, bundle.key);
    bundle.looked = true;
}

// The view and the rows of its samples, unless they are known.
DEVICE void look_at_rows(const Shadows &args, BundleProjection &bundle, unsigned light, const SampleRows &set, const RowTable &table) {
    if (bundle.looked)
        return;
    look(args, bundle, light, set);
    fill_row_offsets(bundle.projected, set, table);
}

// The samples in front of a surface that the emitter may reach below.
template <unsigned WORDS>
COLD Seen<WORDS> partly_unhidden(bool has, SurfacePoint point, Sight projected, Shape shape, const SampleRows &set,
                                 RowTable table) {
    return seen_unhidden<WORDS>(has, point, projected, shape, set, table);
}

// 1. The samples in front of the surface. Where all or none of the emitter is in front of all surfaces, that needs no view of it.
template <unsigned WORDS>
DEVICE Seen<WORDS> unhidden(const Shadows &args, BundleProjection &bundle, unsigned light, const SampleRows &set,
                            const RowTable &table) {
    const Light &emitter = args.scene.lights[light];
    float radius;
    const Vec3 way = way_to(args.scene, emitter, bundle.point.origin, radius);
    const float height = dot(bundle.point.normal, way);
    const float room = ENLARGEMENT * radius + (ENLARGEMENT - 1.0f) * element_sum(abs(way));
    const bool above = height > room, below = height < -room;
    Seen<WORDS> seen = {};
    if (!__any_sync(ALL_LANES, bundle.has && !below))
        return seen;
    if (bundle.shape != SHAPE_DISC || __any_sync(ALL_LANES, bundle.has && !above && !below)) {
        look(args, bundle, light, set);
        return partly_unhidden<WORDS>(bundle.has, bundle.point, bundle.projected, bundle.shape, set, table);
    }
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word)
        seen.bits[word] = bundle.has && above ? set.full[word] : 0;
    return seen;
}

// 4. What candidates hide, until nothing is left. Returns whether anything is. `cuts` are the numbers of their opacities, 0 for those that are
// opaque, with an alpha mask.
template <unsigned WORDS>
DEVICE bool test_candidates(const BundleProjection &bundle, const RowTable &table, const float4 *candidates, const AlphaMask *alpha_mask,
                            const unsigned *cuts, unsigned count, Seen<WORDS> &seen) {
    ROLLED
    for (unsigned k = 0; k < count; ++k) {
        const Hiding triangle = {candidates + OCCLUDER_PARTS * k, alpha_mask, cuts + k};
        if (bundle.shape == SHAPE_POINT)
            seen.bits[0] &= hides_center(bundle.point, bundle.projected, triangle) ? 0 : 1;
        else
            hide<WORDS>(bundle.point, bundle.projected, triangle, table, any(seen), seen.bits);
        if (!__any_sync(ALL_LANES, any(seen)))
            return false;
    }
    return true;
}

// 3. Chooses among up to 32 of the triangles found, one per lane, and tests them. Returns whether anything is still seen. `tested` is the number of
// candidates.
template <unsigned WORDS, class Structure>
DEVICE bool test_found(const Shadows &args, BundleProjection &bundle, unsigned light, const SampleRows &set, const RowTable &table,
                       const Region<ShaftShape> &region, const Structure &structure, const ListMemory &memory, unsigned first,
                       unsigned count, unsigned &tested, Seen<WORDS> &seen) {
    const unsigned lane = lane_of_thread();
    Occluding own;
    Choice choice = DROPPED;
    if (lane < count) {
        const Corners corners = load_corners(triangle_at(structure, memory.found[first + lane]));
        if (in_shaft(region.shape, corners) && above_planes(region.planes, 2.0f * memory.shaft->half, corners)) {
            own = occluding(corners);
            choice = choose(*memory.shaft, own);
        }
    }
    // A triangle that hides everything comes first; then there is nothing left to ask, unless it is cut out.
    const unsigned dark = __ballot_sync(ALL_LANES, choice == DARK), kept = __ballot_sync(ALL_LANES, choice == KEPT);
    tested = __popc(dark | kept);
    if (tested == 0)
        return true;
    look_at_rows(args, bundle, light, set, table);
    __syncwarp();
    // The numbers of opacities take the places of the triangles, which have been read.
    const AlphaMask *alpha_mask = alpha_mask_of(structure);
    unsigned cut = 0;
    if (alpha_mask != nullptr) {
        if (choice != DROPPED)
            cut = triangle_cut(triangle_at(structure, memory.found[first + lane]));
        __syncwarp();
    }
    if (choice != DROPPED) {
        const unsigned place = __popc((choice == DARK ? dark : kept) & lanes_below(lane)) + (choice == DARK ? 0 : __popc(dark));
        UNROLL
        for (unsigned part = 0; part < OCCLUDER_PARTS; ++part)
            memory.candidates[OCCLUDER_PARTS * place + part] = own.parts[part];
        if (alpha_mask != nullptr)
            memory.found[first + place] = cut;
    }
    __syncwarp();
    return test_candidates(bundle, table, memory.candidates, alpha_mask, memory.found + first, tested, seen);
}

// 5. Whether rays to the samples still seen cost less than going on, if candidates go on hiding samples as those have that `spent` so much. The
// lanes' rays are cast side by side. `before` is the number of samples that the lane saw before the search.
template <unsigned WORDS>
DEVICE bool rays_are_cheaper(unsigned spent, unsigned before, const Seen<WORDS> &seen) {
    const unsigned own = number(seen);
    const float left = (float)warp_sum(own), hidden = (float)warp_sum(before - own), walks = warp_max((float)own);
    const float going_on = (float)spent * left / (hidden + 1.0f);
    return fminf(going_on, MIN_COST_RATIO * (float)spent) > (float)RAY_COST * walks;
}

// Rays in place of the rest of a search. This is a call, so that few registers are needed where there are none.
template <unsigned WORDS, class Structure>
COLD Seen<WORDS> rays_instead(const Structure &structure, float scale, SurfacePoint point, Sight projected, RowTable table,
                              Seen<WORDS> seen) {
    cast_to_samples<WORDS>(structure, scale, point, projected, table, seen);
    return seen;
}

// Scenes of shapes in many places have them: in others, the registers cost more than rays gain.
template <class Structure>
constexpr bool HAS_RAYS = false;
template <>
constexpr bool HAS_RAYS<InstancedBvh> = true;

// 2. The box around the surface points that are `alive`, and their tangent planes.
DEVICE void look_around(const BundleProjection &bundle, bool alive, const ListMemory &memory) {
    const unsigned lanes = __ballot_sync(ALL_LANES, alive);
    if (memory.around->lanes == lanes)
        return;
    const Vec3 &origin = bundle.point.origin;
    const Bounds origins = {
        Vec3{warp_min(alive ? origin.x : F32_MAX), warp_min(alive ? origin.y : F32_MAX), warp_min(alive ? origin.z : F32_MAX)},
        Vec3{warp_max(alive ? origin.x : -F32_MAX), warp_max(alive ? origin.y : -F32_MAX), warp_max(alive ? origin.z : -F32_MAX)}};
    const TangentPlanes planes = tangent_planes(origins.low, alive, origin, bundle.point.normal, memory.planes);
    if (lane_of_thread() == 0)
        *memory.around = Around{origins, planes.count, lanes};
    __syncwarp();
}

// Where the searches of a tile's bundles for what hides a light start: their number, then these.
DEVICE unsigned *starts_of(const Shadows &args, unsigned long long tile, unsigned light) {
    return args.starts + (tile * (args.end_light - args.first_light) + light - args.first_light) * (MAX_SEARCH_ROOTS + 1);
}

// The samples of a light that each lane sees; `tile` is that of the bundle, and `above` becomes the number of those in front of the surface.
template <unsigned WORDS, class Structure>
DEVICE Seen<WORDS> seen_of_light(const Shadows &args, const Structure &structure, BundleProjection &bundle, unsigned tile,
                                 unsigned light,
                              const SampleRows &set, const ListMemory &memory, unsigned &above) {
    // 1. The samples in front of the surface.
    const RowTable table = row_table(memory.tables, bundle.shape, memory.offsets);
    Seen<WORDS> seen = unhidden<WORDS>(args, bundle, light, set, table);
    const bool alive = any(seen);
    above = number(seen);
    if (!__any_sync(ALL_LANES, alive))
        return seen;
    bundle.asked += above;

    // 2. Search.
    const unsigned *starts = starts_of(args, tile, light);
    const unsigned start_count = __ldg(starts);
    if (start_count == 0)
        return seen;
    if (start_count != FROM_ROOT)
        ROLLED
        for (unsigned start = lane_of_thread(); start < start_count; start += WARP)
            memory.starts[start] = __ldg(starts + 1 + start);
    const Light &emitter = args.scene.lights[light];
    look_around(bundle, alive, memory);
    const Bounds origins = memory.around->origins;
    const Bounds bounds = emitter_bounds(args.scene, emitter, bundle.shape, origins);
    const TangentPlanes planes = {memory.around->planes, origins.low, memory.planes};
    const auto region = region_above(shadow_region(origins, bounds, memory.faces), planes, 0.0f);
    const bool ball = emitter.kind == Light::POINT || emitter.kind == Light::SPHERE;
    if (lane_of_thread() == 0)
        *memory.shaft = shaft_of(origins, bounds, ball ? ball_extent(emitter) : INFINITE, emitter.body);
    __syncwarp();
    auto search = begin_search_at(structure, region, memory.search, memory.starts, start_count);
    unsigned found = 0, spent = 0, check = FIRST_CHECK;
    ROLLED
    while (goes_on(structure, search) || found != 0) {
        ROLLED
        while (goes_on(structure, search) && found < WARP) {
            next_triangles<false>(structure, region, search, memory.found, found);
            spent += ROUND_COST;
        }
        const unsigned count = min(found, WARP);
        found -= count;
        // 3, 4. Candidates, and what they hide.
        unsigned tested;
        if (!test_found(args, bundle, light, set, table, region, structure, memory, found, count, tested, seen))
            return Seen<WORDS>{};
        __syncwarp();
        if constexpr (HAS_RAYS<Structure>) {
            // 5. Rays instead of the rest.
            spent += CHOICE_COST + tested * (CANDIDATE_COST + ROW_COST * set.rows);
            if (spent < check || bundle.shape == SHAPE_POINT)
                continue;
            check = 2 * spent;
            if (!rays_are_cheaper(spent, above, seen))
                continue;
            look_at_rows(args, bundle, light, set, table);
            return rays_instead<WORDS>(structure, emitter.scale, bundle.point, bundle.projected, table, seen);
        }
    }
    return seen;
}

// 6. What samples count near a light: adds a lane's to its share.
template <unsigned WORDS>
DEVICE void add_share(const Shadows &args, BundleProjection &bundle, unsigned light, const SampleRows &set, const ListMemory &memory,
                      const Seen<WORDS> &seen, unsigned above) {
    const Light &emitter = args.scene.lights[light];
    const float near = bundle.has ? nearness_of(args, bundle.shape, emitter, bundle.point) : 0.0f;
    const unsigned left = number(seen);
    const bool weighs = near > 0.0f && !is_plain(args, above, left);
    const RowTable table = row_table(memory.tables, bundle.shape, memory.offsets);
    if (__any_sync(ALL_LANES, weighs))
        look_at_rows(args, bundle, light, set, table);
    WeightSums sums = {0.0f, 0.0f};
    if (weighs)
        sums = weights_of<WORDS>(&emitter, bundle.point.normal, bundle.projected, &set, table, seen);
    if (near > 0.0f)
        add_weighed(args, light, bundle.ray, near, Weighed{above, left, sums.all, sums.lit});
    else if (bundle.has)
        add_seen(args, bundle.shape, light, bundle.ray, left);
}

// Places the surface points where a light is looked for.
DEVICE void place(const Shadows &args, BundleProjection &bundle, unsigned light, const ListMemory &memory) {
    if (!bundle.curved)
        return;
    const bool was_placed = bundle.placed;
    if (was_placed)
        bundle.point = flat_point_of(args.scene, args.rays, args.hits, bundle.ray);
    bundle.placed = __any_sync(ALL_LANES, bundle.has && is_low(args.scene, args.scene.lights[light], bundle.point, bundle.bend));
    if (bundle.placed)
        bundle.point = curved_point_of(args.scene, args.rays, args.hits, bundle.ray, args.scene.lights[light]);
    else if (!was_placed)
        return;
    if (lane_of_thread() == 0)
        memory.around->lanes = 0;
    __syncwarp();
}

// The shadows of a bundle. Returns the samples of all lights in front of the lane's surface.
template <unsigned WORDS, class Structure>
DEVICE unsigned shadows_of_bundle(const Shadows &args, const Structure &structure, const ListMemory &memory, unsigned long long entry) {
    const unsigned lane = lane_of_thread(), count = (unsigned)entry & 63;
    const unsigned long long slot = entry >> 6;
    BundleProjection bundle;
    bundle.has = lane < count;
    bundle.ray = args.members[slot + (bundle.has ? lane : 0)];
    bundle.point = surface_point_of(args.scene, args.rays, args.hits, bundle.ray);
    bundle.key = ray_key(args.rays, bundle.ray);
    bundle.bend = args.scene.normals != nullptr ? bend_of(args.scene, args.rays, args.hits, bundle.ray) : FLAT;
    bundle.curved = __any_sync(ALL_LANES, bundle.bend != FLAT);
    bundle.placed = false;
    bundle.asked = 0;
    if (lane == 0)
        memory.around->lanes = 0;
    __syncwarp();
    ROLLED
    for (unsigned light = args.first_light; light < args.end_light; ++light) {
        bundle.shape = shape_of(args.sampling, args.scene.lights[light]);
        bundle.looked = false;
        const SampleRows &set = args.sets[bundle.shape == SHAPE_RECTANGLE ? SHAPE_RECTANGLE : SHAPE_DISC];
        if (bundle.shape == SHAPE_POINT && args.set != 0)
            continue;
        place(args, bundle, light, memory);
        unsigned above;
        const Seen<WORDS> seen = seen_of_light<WORDS>(args, structure, bundle, (unsigned)(slot / TILE), light, set, memory, above);
        add_share<WORDS>(args, bundle, light, set, memory, seen, above);
        __syncwarp();
    }
    return bundle.asked;
}

// Takes bundles until none is left.
template <unsigned WORDS, class Structure>
DEVICE void shadows_of_bundles(const Shadows &args, const Structure &structure) {
    DYNAMIC_SHARED(unsigned, shared);
    const ListMemory memory = list_memory(shared, search_words(structure));
    fill_row_table(args.sets[SHAPE_DISC], memory.tables);
    fill_row_table(args.sets[SHAPE_RECTANGLE], memory.tables + ROW_TABLE_WORDS);
    unsigned asked = 0;
    while (true) {
        unsigned taken = 0;
        if (lane_of_thread() == 0)
            taken = atomicAdd(args.taken, 1u);
        taken = __shfl_sync(ALL_LANES, taken, 0);
        if (taken >= args.count)
            break;
        // What is far down in an image often takes longest.
        asked += shadows_of_bundle<WORDS>(args, structure, memory, args.bundles[args.first + (args.count - 1 - taken)]);
        __syncwarp();
    }
    count(tally_shard(args.tally).shadow_rays, asked);
}

// Where the searches of the bundles of a tile start.
template <class Structure>
DEVICE void starts_of_tile(const Shadows &args, const Structure &structure) {
    SHARED(ShaftFaces, faces, );
    SHARED(unsigned, list, [2 * WARP]);
    const unsigned lights = args.end_light - args.first_light;
    const unsigned long long unit = args.first + blockIdx.x, number = unit / lights;
    const unsigned index = args.first_light + (unsigned)(unit % lights);
    const TileBox &tile = args.tiles[number];
    unsigned *starts = starts_of(args, number, index);
    unsigned count = 0;
    if (tile.low.x <= tile.high.x) {
        const Light &light = args.scene.lights[index];
        const Bounds origins = {tile.low, tile.high};
        const Bounds emitter = emitter_bounds(args.scene, light, shape_of(args.sampling, light), origins);
        count = find_starts(structure, shadow_region(origins, emitter, &faces), list);
    }
    if (lane_of_thread() == 0)
        starts[0] = count;
    for (unsigned start = lane_of_thread(); count != FROM_ROOT && start < count; start += WARP)
        starts[1 + start] = list[start];
}
