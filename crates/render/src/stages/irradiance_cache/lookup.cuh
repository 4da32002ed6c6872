// Which records a place takes light from, and how much from each: twin of lookup.rs.
#pragma once

#include "accel/walk.cuh"
#include "stages/irradiance_cache/cells.cuh"
#include "stages/irradiance_cache/directions.cuh"
#include "stages/irradiance_cache/names.cuh"

// A cell near another: in those, records may be near enough.
DEVICE IVec3 cell_around(IVec3 middle, unsigned index) {
    return middle + IVec3{(int)(index % 5) - 2, (int)(index / 5 % 5) - 2, (int)(index / 25) - 2};
}

// The weight of a record: it falls with the distance, with the angle between normals, and with the distance from tangent planes.
DEVICE float record_weight(const LightPlace &place, float size, Vec3 position, Vec3 normal) {
    const Vec3 way = position - place.position;
    const float near = 1.0f - length_squared(way) / (RECORD_RADIUS * RECORD_RADIUS * size * size);
    const float cosine = (dot(place.normal, normal) - RECORD_COSINE) / (1.0f - RECORD_COSINE);
    if (near <= 0.0f || cosine <= 0.0f)
        return 0.0f;
    const float height = larger(fabsf(dot(place.normal, way)), fabsf(dot(normal, way))) / (RECORD_THICKNESS * size);
    const float flat = larger(1.0f - height * height, 0.0f);
    return near * near * cosine * cosine * flat * flat;
}

// How ways to records leave a place: nothing is in the way in a direction, up to some reach.
struct Open {
    Vec3 from, direction;
    float reach;
};

// The segment to a record. Both ends are raised, as far as nothing is in the way: not through a thin board.
DEVICE Ray record_segment(Vec3 position, Vec3 normal, const Open &open, const Record &record, bool covered) {
    const float raised = RECORD_RAISED * length(record.position - position);
    const float step = fminf(raised / larger(dot(open.direction, normal), MIN_RISE), RECORD_STEP * open.reach);
    const Vec3 end = covered ? record.origin : record.origin + raised * record.normal;
    return long_segment(open.from + step * open.direction, end);
}

// How far it is to whatever is above a place, as high as ways to records may begin.
template <class Structure>
DEVICE float reach_above(const Lookup &args, const Structure &structure, const LightPlace &place) {
    const float t_max = RECORD_RAISED * RECORD_RADIUS * size_of_level(place.level) / RECORD_STEP;
    return closest_hit(structure, args.tally, Ray{place.origin, place.normal, t_max}).t;
}

// The moments of records around a place, from which their weights are balanced.
struct Balance {
    Vec3 tangent, other;
    float first_x, first_y, xx, xy, yy;
};

DEVICE Balance begin_balance(const LightPlace &place) {
    Balance balance = {};
    basis(place.normal, balance.tangent, balance.other);
    return balance;
}

DEVICE void weigh_record(Balance &balance, Vec3 way, float weight) {
    const float x = dot(balance.tangent, way), y = dot(balance.other, way);
    balance.first_x += weight * x;
    balance.first_y += weight * y;
    balance.xx += weight * x * x;
    balance.xy += weight * x * y;
    balance.yy += weight * y * y;
}

// The slope of the factors of weights; false if the records are nearly in line, and weights stay.
DEVICE bool balance_slope(const Balance &balance, float &x, float &y) {
    const float determinant = balance.xx * balance.yy - balance.xy * balance.xy, trace = balance.xx + balance.yy;
    if (determinant <= MIN_SPREAD * trace * trace)
        return false;
    x = (balance.yy * balance.first_x - balance.xy * balance.first_y) / determinant;
    y = (balance.xx * balance.first_y - balance.xy * balance.first_x) / determinant;
    return true;
}

// Those of a warp's places that lie in one cell.
struct Around {
    int level;
    IVec3 cell;
    Bounds bounds;
    // Their normal, and the least and the greatest height along it, if they share one.
    bool is_flat;
    Vec3 normal;
    float least, most;
};

// Takes the places in the cell of the lowest lane of `rest` out of it. `is_there`: the lane's own place is one of them.
DEVICE Around take_around(unsigned &rest, const LightPlace &place, IVec3 own, bool &is_there) {
    const unsigned first = __ffs(rest) - 1;
    Around around;
    around.level = __shfl_sync(ALL_LANES, place.level, first);
    around.cell = IVec3{__shfl_sync(ALL_LANES, own.x, first), __shfl_sync(ALL_LANES, own.y, first), __shfl_sync(ALL_LANES, own.z, first)};
    is_there = (rest >> lane_of_thread() & 1) && place.level == around.level && own.x == around.cell.x && own.y == around.cell.y &&
               own.z == around.cell.z;
    rest &= ~__ballot_sync(ALL_LANES, is_there);
    const Vec3 low = is_there ? place.position : splat(INFINITE), high = is_there ? place.position : splat(-INFINITE);
    around.bounds = Bounds{{warp_min(low.x), warp_min(low.y), warp_min(low.z)}, {warp_max(high.x), warp_max(high.y), warp_max(high.z)}};
    around.normal = warp_broadcast(place.normal, first);
    around.is_flat = __ballot_sync(ALL_LANES, is_there && !(place.normal == around.normal)) == 0;
    const float height = dot(around.normal, place.position);
    around.least = warp_min(is_there ? height : INFINITE);
    around.most = warp_max(is_there ? height : -INFINITE);
    return around;
}

// Whether records of a cell may count: only if it is near some place and its tangent plane.
DEVICE bool may_use(const Around &around, IVec3 cell) {
    const float size = size_of_level(around.level);
    const Vec3 middle = corner_of_cell(around.level, cell) + splat(0.5f * size);
    const float half = RECORD_MARGIN * size;
    const Vec3 outside = max(max(around.bounds.low - middle, middle - around.bounds.high) - splat(half), splat(0.0f));
    if (length_squared(outside) >= RECORD_RADIUS * RECORD_RADIUS * size * size)
        return false;
    const float height = dot(around.normal, middle), slab = RECORD_THICKNESS * size + half * element_sum(abs(around.normal));
    return !around.is_flat || (around.least - slab < height && height < around.most + slab);
}

// Asks for the cells in which records may count for the places of a warp.
DEVICE void ask_cells(const Lookup &args, bool has, const LightPlace &place) {
    const IVec3 own = has ? cell_at(place.level, place.position) : IVec3{0, 0, 0};
    unsigned rest = __ballot_sync(ALL_LANES, has && !is_abandoned(args.table.cells));
    while (rest != 0) {
        bool is_there;
        const Around around = take_around(rest, place, own, is_there);
        for (unsigned index = lane_of_thread(); index < CELLS_AROUND; index += WARP) {
            const IVec3 cell = cell_around(around.cell, index);
            if (may_use(around, cell))
                add_name(args.table.cells, name_of_cell(around.level, cell));
        }
        __syncwarp();
    }
}

// Lists the records of the cells around.
DEVICE unsigned list_records(const Lookup &args, const Around &around, unsigned *records) {
    unsigned count = 0;
    for (unsigned from = 0; from < CELLS_AROUND; from += WARP) {
        const unsigned index = from + lane_of_thread();
        const IVec3 cell = cell_around(around.cell, index);
        unsigned long long range = 0;
        if (index < CELLS_AROUND && may_use(around, cell))
            range = args.table.ranges[number_of(args.table.cells, cell_key(around.level, cell))];
        const unsigned first = (unsigned)range, own = (unsigned)(range >> 32), end = count + warp_running_sum(own);
        for (unsigned record = 0; record < own; ++record)
            records[end - own + record] = first + record;
        count = __shfl_sync(ALL_LANES, end, WARP - 1);
    }
    __syncwarp();
    return count;
}

// Counts the records of a warp's places, and writes them with their weights to `links`, unless that is null; those of the lane's own begin at
// `begin`. For one place after the other, each lane weighs a record.
DEVICE unsigned find_links(const Lookup &args, bool has, const LightPlace &place, unsigned begin, Link *links) {
    SHARED(unsigned, lists, [BLOCK / WARP][CELLS_AROUND * SURFACE_KINDS]);
    unsigned *records = lists[threadIdx.x / WARP];
    const unsigned lane = lane_of_thread();
    const IVec3 own = has ? cell_at(place.level, place.position) : IVec3{0, 0, 0};
    unsigned rest = __ballot_sync(ALL_LANES, has), end = begin;
    while (rest != 0) {
        bool is_there;
        const Around around = take_around(rest, place, own, is_there);
        const float size = size_of_level(around.level);
        const unsigned count = list_records(args, around, records), places = __ballot_sync(ALL_LANES, is_there);
        for (unsigned from = 0; from < count; from += WARP) {
            const bool is_record = from + lane < count;
            const unsigned record = is_record ? records[from + lane] : 0;
            const Vec3 position = args.table.records[record].position, normal = args.table.records[record].normal;
            for (unsigned next = places; next != 0; next &= next - 1) {
                const unsigned asking = __ffs(next) - 1;
                const LightPlace asked = {warp_broadcast(place.position, asking), around.level, warp_broadcast(place.normal, asking), 1.0f, {}};
                const float weight = is_record ? record_weight(asked, size, position, normal) : 0.0f;
                const unsigned found = __ballot_sync(ALL_LANES, weight > 0.0f), start = __shfl_sync(ALL_LANES, end, asking);
                if (links != nullptr && weight > 0.0f)
                    links[start + __popc(found & lanes_below(lane))] = Link{record, weight};
                if (lane == asking)
                    end += __popc(found);
            }
        }
        __syncwarp();
    }
    return end - begin;
}

// Changes weights so that the weighted mean of the positions of records is the place itself, as far as that is possible.
DEVICE void balance(const Lookup &args, const LightPlace &place, Link *links, unsigned count) {
    Balance balance = begin_balance(place);
    for (unsigned link = 0; link < count; ++link)
        weigh_record(balance, args.table.records[links[link].record].position - place.position, links[link].weight);
    float x, y;
    if (!balance_slope(balance, x, y))
        return;
    for (unsigned link = 0; link < count; ++link) {
        const Vec3 way = args.table.records[links[link].record].position - place.position;
        links[link].weight *= larger(1.0f - (x * dot(balance.tangent, way) + y * dot(balance.other, way)), 0.0f);
    }
}

// Takes its weight from a link if its place does not see the record.
template <class Structure>
DEVICE void hide_link(const Lookup &args, const Structure &structure, const LightPlace &place, float reach, Link &link) {
    const Open open = {place.origin, place.normal, reach};
    if (occluded(structure, args.tally, record_segment(place.position, place.normal, open, args.table.records[link.record], false)))
        link.weight = 0.0f;
}

// Takes their weight from records that a place does not see, and balances the others. All are tested: that nothing is near in front of a record says
// nothing of what is behind its surface. The links of a warp's places follow each other: each lane takes one after the other.
template <class Structure>
DEVICE void settle_links(const Lookup &args, const Structure &structure) {
    const unsigned index = blockIdx.x * BLOCK + threadIdx.x, lane = lane_of_thread();
    const unsigned begin = args.offsets[min(index, args.count)], end = args.offsets[min(index + 1, args.count)];
    const unsigned last = __shfl_sync(ALL_LANES, end, WARP - 1);
    const float own = begin < end ? reach_above(args, structure, args.places[index]) : INFINITE;
    for (unsigned from = __shfl_sync(ALL_LANES, begin, 0); from < last; from += WARP) {
        const unsigned owner = warp_owner(end, from + lane);
        const float reach = __shfl_sync(ALL_LANES, own, owner);
        if (from + lane < last)
            hide_link(args, structure, args.places[index - lane + owner], reach, args.links[from + lane]);
    }
    __syncwarp();
    if (index < args.count)
        balance(args, args.places[index], args.links + begin, end - begin);
}

// Numbers the records with a weight that have no value yet.
DEVICE void ask_values(const Lookup &args, unsigned index) {
    const SurfaceCells &table = args.table;
    for (unsigned link = args.offsets[index]; link < args.offsets[index + 1]; ++link) {
        const unsigned record = args.links[link].record;
        if (args.links[link].weight <= 0.0f || table.values[record] != 0 || atomicCAS(table.values + record, 0u, NO_NUMBER) != 0)
            continue;
        const unsigned value = atomicAdd(table.value_count, 1u);
        table.owners[value] = record;
        table.values[record] = value + 1;
    }
}
