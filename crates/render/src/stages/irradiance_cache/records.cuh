// The records of a cell, found by a warp: twin of `records_of` and `nearest_of_kind` in cells.rs.
#pragma once

#include "accel/search.cuh"
#include "accel/walk.cuh"
#include "stages/irradiance_cache/cells.cuh"

// The point of a triangle that is nearest to a cell's middle.
struct Near : WeighedPoint {
    // The square of its distance.
    float square;
};

DEVICE Near near_of(Vec3 middle, const Corners &corners) {
    const WeighedPoint closest = closest_point(middle, corners);
    return Near{closest, length_squared(closest.point - middle)};
}

// The surface point on a triangle's side. From edges it moves inwards.
DEVICE SurfacePoint near_surface_point(const Near &near, const Corners &corners, unsigned kind, float size) {
    const Vec3 inwards = (corners.a + corners.b + corners.c) / 3.0f - near.point;
    const float share = fminf(RECORD_INWARDS * size / length(inwards), 0.5f);
    const Vec3 outward = outward_of(corners);
    // As seen by a ray that comes from that side.
    const Ray ray = {splat(0.0f), kind % 2 == 0 ? -outward : outward, INFINITE};
    const Hit hit = {0.0f, near.u + share * (1.0f / 3.0f - near.u), near.v + share * (1.0f / 3.0f - near.v), 0};
    return surface_point(ray, hit, corners);
}

// The kinds of surface that the front and the back of a triangle are; false for needles.
DEVICE bool kinds_of(const Corners &corners, unsigned &front, unsigned &back) {
    const Vec3 outward = outward_of(corners);
    front = surface_kind(outward, true);
    back = surface_kind(-outward, false);
    return length_squared(outward) > MIN_SQUARE;
}

// Points of one kind of surface: squares of distances, as bits, times 2^32, plus indices of triangles, the nearest first; all ones in places
// that are empty.
struct Candidates {
    unsigned long long nearest[RECORD_CANDIDATES];
};

#define NO_CANDIDATE ~0ull

// Adds a point, unless it is there: a grid may find a triangle twice.
DEVICE void add_candidate(Candidates &candidates, unsigned long long next) {
    for (unsigned place = 0; place < RECORD_CANDIDATES; ++place)
        if (candidates.nearest[place] == next)
            return;
    for (unsigned place = 0; place < RECORD_CANDIDATES; ++place) {
        const unsigned long long here = candidates.nearest[place];
        candidates.nearest[place] = here < next ? here : next;
        next = here < next ? next : here;
    }
}

// Adds the points of the lanes that have one; those that are there already stay. The lanes share the candidates.
DEVICE void add_candidates(Candidates &candidates, bool has, float square, unsigned triangle) {
    unsigned long long own = has ? (unsigned long long)__float_as_uint(square) << 32 | triangle : NO_CANDIDATE;
    for (unsigned taken = 0; taken < RECORD_CANDIDATES; ++taken) {
        unsigned long long least = own;
        for (int step = WARP / 2; step > 0; step /= 2) {
            const unsigned long long other = __shfl_xor_sync(ALL_LANES, least, step);
            least = other < least ? other : least;
        }
        if (least >= candidates.nearest[RECORD_CANDIDATES - 1])
            return;
        __syncwarp();
        if (lane_of_thread() == 0)
            add_candidate(candidates, least);
        __syncwarp();
        if (own == least)
            own = NO_CANDIDATE;
    }
}

// What a search hands to the lanes: up to 32 triangles at once.
struct FoundTriangle {
    bool has;
    unsigned index;
    Corners corners;
};

template <class Structure>
DEVICE FoundTriangle found_triangle(const Structure &structure, const unsigned *list, unsigned place, unsigned count) {
    FoundTriangle found = {};
    found.has = place < count;
    if (found.has) {
        found.index = triangle_index(triangle_at(structure, list[place]));
        found.corners = load_corners(triangle_at(structure, list[place]));
    }
    return found;
}

DEVICE void clear_candidates(Candidates *candidates, unsigned kinds) {
    for (unsigned place = lane_of_thread(); place < kinds * RECORD_CANDIDATES; place += WARP)
        candidates[place / RECORD_CANDIDATES].nearest[place % RECORD_CANDIDATES] = NO_CANDIDATE;
    __syncwarp();
}

// Adds the lanes' points, each to the candidates of its kind.
DEVICE void add_by_kind(Candidates *candidates, bool has, unsigned kind, float square, unsigned triangle) {
    unsigned rest = __ballot_sync(ALL_LANES, has);
    while (rest != 0) {
        const unsigned next = __shfl_sync(ALL_LANES, kind, __ffs(rest) - 1);
        const bool is_next = has && kind == next;
        add_candidates(candidates[next], is_next, square, triangle);
        rest &= ~__ballot_sync(ALL_LANES, is_next);
    }
}

// Whether nothing is above a record within this distance.
template <class Structure>
DEVICE bool is_free(const Tally &tally, const Structure &structure, Vec3 origin, Vec3 normal, float distance) {
    return !occluded(structure, tally, Ray{origin, normal, distance});
}

// Which of the candidates becomes the record: the first one above which nothing is within this distance, in cells, or the nearest if all are covered;
// `open` tells which. A single one may be taken for open. Each lane has its own.
template <class Structure>
DEVICE bool record_of_candidates(const Scene &scene, const Tally &tally, const Structure &structure, const Candidates &candidates,
                               const Name &name, unsigned kind, float distance, bool trust_single, Record &record, bool &open) {
    if (candidates.nearest[0] == NO_CANDIDATE)
        return false;
    const float size = size_of_level(name.level);
    const Vec3 middle = middle_of(bounds_of_name(name));
    open = trust_single && candidates.nearest[1] == NO_CANDIDATE;
    SurfacePoint chosen = {};
    for (unsigned place = 0; place < RECORD_CANDIDATES && candidates.nearest[place] != NO_CANDIDATE; ++place) {
        const Corners corners = corners_at(scene.triangles, (unsigned)candidates.nearest[place]);
        const SurfacePoint point = near_surface_point(near_of(middle, corners), corners, kind, size);
        open = open || is_free(tally, structure, point.origin, point.normal, distance * size);
        if (place == 0 || open)
            chosen = point;
        if (open)
            break;
    }
    const unsigned long long key = cell_key(name.level, cell_of_name(name));
    record = Record{chosen.position, name.level, chosen.origin, chosen.normal, key << 4 | kind};
    return true;
}

DEVICE bool is_inside(const Bounds &bounds, const Vec3 &point) {
    return point.x >= bounds.low.x && point.y >= bounds.low.y && point.z >= bounds.low.z && point.x <= bounds.high.x &&
           point.y <= bounds.high.y && point.z <= bounds.high.z;
}

// The records of a cell: of each kind of surface the point nearest to its middle that lies in the cell. One warp.
template <class Structure>
DEVICE void place_records(const Lookup &args, const Structure &structure) {
    DYNAMIC_SHARED(unsigned, shared);
    SHARED(Candidates, candidates, [SURFACE_KINDS]);
    unsigned *list = shared, *memory = shared + FOUND_TRIANGLES;
    const unsigned cell = args.first + blockIdx.x, lane = lane_of_thread();
    const Name name = args.table.cells.names[cell];
    const Bounds bounds = bounds_of_name(name);
    const Vec3 middle = middle_of(bounds);
    clear_candidates(candidates, SURFACE_KINDS);

    // 1. The points of each kind.
    const Region<BoxShape> region = region_within(bounds);
    auto search = begin_search(structure, region, memory);
    while (goes_on(structure, search)) {
        unsigned count = 0;
        next_triangles<true>(structure, region, search, list, count);
        for (unsigned first = 0; first < count; first += WARP) {
            const FoundTriangle found = found_triangle(structure, list, first + lane, count);
            const Near near = near_of(middle, found.corners);
            unsigned front, back;
            const bool has = kinds_of(found.corners, front, back) && found.has && is_inside(bounds, near.point);
            add_by_kind(candidates, has, front, near.square, found.index);
            add_by_kind(candidates, has, back, near.square, found.index);
        }
        __syncwarp();
    }

    // 2. A record of each, a lane for each kind. Ways to a record end above it: in what is thinner, such as a rug, they would lead past the cover.
    Record record = {};
    bool open;
    const float raised = RECORD_RAISED * RECORD_RADIUS * size_of_level(name.level);
    const bool has = lane < SURFACE_KINDS && record_of_candidates(args.scene, args.tally, structure, candidates[lane], name, lane, RECORD_OPEN, true, record, open) &&
                     is_free(args.tally, structure, record.origin, record.normal, raised);
    const unsigned lanes = __ballot_sync(ALL_LANES, has);
    unsigned first = 0;
    if (lane == 0) {
        first = atomicAdd(args.table.record_count, __popc(lanes));
        args.table.ranges[cell] = (unsigned long long)__popc(lanes) << 32 | first;
    }
    first = __shfl_sync(ALL_LANES, first, 0);
    if (has)
        args.table.records[first + __popc(lanes & lanes_below(lane))] = record;
}

// The record of a kind of surface that is nearest to a cell's middle, wherever it lies. One warp.
template <class Structure>
DEVICE void place_nodes(const Bounce &args, const Structure &structure) {
    DYNAMIC_SHARED(unsigned, shared);
    SHARED(Candidates, candidates, );
    unsigned *list = shared, *memory = shared + FOUND_TRIANGLES;
    const unsigned node = args.first + blockIdx.x, lane = lane_of_thread();
    const Name name = args.names.names[node];
    const float size = size_of_level(name.level);
    const Vec3 middle = middle_of(bounds_of_name(name));
    clear_candidates(&candidates, 1);

    // Cells may have many triangles: those in the middle come first.
    for (float share = NODE_REACH; share <= 1.0f && candidates.nearest[0] == NO_CANDIDATE; share *= 2.0f) {
        const float reach = share * size;
        const Region<NearShape> region = region_near(Bounds{middle, middle}, reach);
        auto search = begin_search(structure, region, memory);
        while (goes_on(structure, search)) {
            unsigned count = 0;
            next_triangles<true>(structure, region, search, list, count);
            for (unsigned first = 0; first < count; first += WARP) {
                const FoundTriangle found = found_triangle(structure, list, first + lane, count);
                const Near near = near_of(middle, found.corners);
                unsigned front, back;
                const bool has = kinds_of(found.corners, front, back) && found.has && (front == name.kind || back == name.kind);
                add_candidates(candidates, has && near.square <= reach * reach, near.square, found.index);
            }
            __syncwarp();
        }
        __syncwarp();
    }
    if (lane != 0)
        return;
    Record record = {};
    bool open = false;
    const bool has = record_of_candidates(args.scene, args.hemispheres.tally, structure, candidates, name, name.kind, NODE_OPEN, false, record, open);
    // The smallest cells that its rays ask are those that were asked at first.
    record.level = name.level + (int)name.finer;
    args.records[node] = record;
    // Nothing arrives where no surface was found; all is known of that.
    Node placed = {};
    placed.known = placed.wanted = has ? 0u : ORDERS;
    placed.covered = !open;
    args.nodes[node] = placed;
}
