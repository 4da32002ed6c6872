// Which sites a place takes light from, and how much from each: twin of lookup.rs.
#pragma once

#include "accel/walk.cuh"
#include "gathered/cells.cuh"
#include "gathered/directions.cuh"
#include "gathered/names.cuh"

// A cell near another: in those, sites may be near enough.
DEVICE IVec3 cell_around(IVec3 middle, unsigned index) {
    return middle + IVec3{(int)(index % 5) - 2, (int)(index / 5 % 5) - 2, (int)(index / 25) - 2};
}

// Whether sites of a cell may count for a place: if it is near, and near the tangent plane.
DEVICE bool may_use(const LightPlace &place, float size, IVec3 cell) {
    const Vec3 way = corner_of_cell(place.level, cell) + splat(0.5f * size) - place.position;
    const float half = SITE_MARGIN * size;
    const Vec3 outside = max(abs(way) - splat(half), splat(0.0f));
    const float slab = SITE_THICKNESS * size + half * element_sum(abs(place.normal));
    return length_squared(outside) < SITE_RADIUS * SITE_RADIUS * size * size && fabsf(dot(place.normal, way)) < slab;
}

// The weight of a site: it falls with the distance, with the angle between normals, and with the distance from tangent planes.
DEVICE float site_weight(const LightPlace &place, float size, Vec3 position, Vec3 normal) {
    const Vec3 way = position - place.position;
    const float near = 1.0f - length_squared(way) / (SITE_RADIUS * SITE_RADIUS * size * size);
    const float cosine = (dot(place.normal, normal) - SITE_COSINE) / (1.0f - SITE_COSINE);
    if (near <= 0.0f || cosine <= 0.0f)
        return 0.0f;
    const float height = larger(fabsf(dot(place.normal, way)), fabsf(dot(normal, way))) / (SITE_THICKNESS * size);
    const float flat = larger(1.0f - height * height, 0.0f);
    return near * near * cosine * cosine * flat * flat;
}

// Whether something may be in the way to a site, if nothing is nearer than this to one of both ends.
DEVICE bool may_be_hidden(const LightPlace &place, Vec3 position, float nearest) {
    return 4.0f * length_squared(position - place.position) > nearest * nearest;
}

// The segment to a site.
DEVICE Ray site_segment(const LightPlace &place, const Site &site) {
    const float raised = SITE_RAISED * length(site.position - place.position);
    return long_segment(place.position + raised * place.normal, site.origin + raised * site.normal);
}

// The moments of sites around a place, from which their weights are balanced.
struct Balance {
    Vec3 tangent, other;
    float first_x, first_y, xx, xy, yy;
};

DEVICE Balance begin_balance(const LightPlace &place) {
    Balance balance = {};
    basis(place.normal, balance.tangent, balance.other);
    return balance;
}

DEVICE void weigh_site(Balance &balance, Vec3 way, float weight) {
    const float x = dot(balance.tangent, way), y = dot(balance.other, way);
    balance.first_x += weight * x;
    balance.first_y += weight * y;
    balance.xx += weight * x * x;
    balance.xy += weight * x * y;
    balance.yy += weight * y * y;
}

// The slope of the factors of weights; false if the sites are nearly in line, and weights stay.
DEVICE bool balance_slope(const Balance &balance, float &x, float &y) {
    const float determinant = balance.xx * balance.yy - balance.xy * balance.xy, trace = balance.xx + balance.yy;
    if (determinant <= LEAST_SPREAD * trace * trace)
        return false;
    x = (balance.yy * balance.first_x - balance.xy * balance.first_y) / determinant;
    y = (balance.xx * balance.first_y - balance.xy * balance.first_x) / determinant;
    return true;
}

// Whether sites of each of the cells around `middle` may count for any of the lanes that `ask`, of the same level: a bit for each.
DEVICE void cells_for_any(bool ask, const LightPlace &place, IVec3 middle, unsigned *wanted) {
    const float size = size_of_level(place.level);
    for (unsigned index = 0; index < CELLS_AROUND; ++index) {
        const bool any = __ballot_sync(ALL_LANES, ask && may_use(place, size, cell_around(middle, index))) != 0;
        wanted[index / WARP] = (index % WARP == 0 ? 0 : wanted[index / WARP]) | (unsigned)any << index % WARP;
    }
}

// Asks for the cells in which sites may count for a place.
DEVICE void ask_cells_of(const Lookup &args, const LightPlace &place, IVec3 middle) {
    const float size = size_of_level(place.level);
    for (unsigned index = 0; index < CELLS_AROUND; ++index)
        if (may_use(place, size, cell_around(middle, index)))
            add_name(args.table.cells, name_of_cell(place.level, cell_around(middle, index)));
}

// In how many cells the lanes' places are.
DEVICE unsigned cells_of_warp(bool has, const LightPlace &place, IVec3 own) {
    const unsigned same = __match_any_sync(ALL_LANES, has ? cell_key(place.level, own) : 0ull);
    return __popc(__ballot_sync(ALL_LANES, has && (same & lanes_below(lane_of_thread())) == 0));
}

// Asks for the cells in which sites may count for the places of a warp. Places in one cell mostly want the same ones, so that these are asked for
// once: a thousand threads that insert one name would wait for each other. Where rays scattered the places, each asks for itself.
DEVICE void ask_cells(const Lookup &args, bool has, const LightPlace &place) {
    const unsigned lane = lane_of_thread();
    const IVec3 own = has ? cell_at(place.level, place.position) : IVec3{0, 0, 0};
    if (cells_of_warp(has, place, own) > MOST_CELLS_TOGETHER) {
        if (has && !is_abandoned(args.table.cells))
            ask_cells_of(args, place, own);
        return;
    }
    unsigned rest = __ballot_sync(ALL_LANES, has && !is_abandoned(args.table.cells));
    while (rest != 0) {
        const unsigned first = __ffs(rest) - 1;
        const int level = __shfl_sync(ALL_LANES, place.level, first);
        const IVec3 middle = {__shfl_sync(ALL_LANES, own.x, first), __shfl_sync(ALL_LANES, own.y, first), __shfl_sync(ALL_LANES, own.z, first)};
        const bool same = has && place.level == level && own.x == middle.x && own.y == middle.y && own.z == middle.z;
        unsigned wanted[(CELLS_AROUND + WARP - 1) / WARP];
        cells_for_any(same, place, middle, wanted);
        for (unsigned index = lane; index < CELLS_AROUND; index += WARP)
            if (wanted[index / WARP] >> lane & 1)
                add_name(args.table.cells, name_of_cell(level, cell_around(middle, index)));
        __syncwarp();
        rest &= ~__ballot_sync(ALL_LANES, same);
    }
}

// Counts the sites of a place, and writes them with their weights to `links`, unless that is null.
DEVICE unsigned find_links(const Lookup &args, const LightPlace &place, Link *links) {
    const float size = size_of_level(place.level);
    const IVec3 middle = cell_at(place.level, place.position);
    unsigned count = 0;
    for (unsigned index = 0; index < CELLS_AROUND; ++index) {
        const IVec3 cell = cell_around(middle, index);
        if (!may_use(place, size, cell))
            continue;
        const unsigned long long range = args.table.ranges[number_of(args.table.cells, cell_key(place.level, cell))];
        const unsigned first = (unsigned)range, sites = (unsigned)(range >> 32);
        for (unsigned site = first; site < first + sites; ++site) {
            const float weight = site_weight(place, size, args.table.sites[site].position, args.table.sites[site].normal);
            if (weight <= 0.0f)
                continue;
            if (links != nullptr)
                links[count] = Link{site, weight};
            ++count;
        }
    }
    return count;
}

// Changes weights so that the weighted mean of the positions of sites is the place itself, as far as that is possible.
DEVICE void balance(const Lookup &args, const LightPlace &place, Link *links, unsigned count) {
    Balance balance = begin_balance(place);
    for (unsigned link = 0; link < count; ++link)
        weigh_site(balance, args.table.sites[links[link].site].position - place.position, links[link].weight);
    float x, y;
    if (!balance_slope(balance, x, y))
        return;
    for (unsigned link = 0; link < count; ++link) {
        const Vec3 way = args.table.sites[links[link].site].position - place.position;
        links[link].weight *= larger(1.0f - (x * dot(balance.tangent, way) + y * dot(balance.other, way)), 0.0f);
    }
}

// Takes their weight from sites that a place does not see, and balances the others.
template <class Structure>
DEVICE void settle_links(const Lookup &args, const Structure &structure) {
    const unsigned index = blockIdx.x * BLOCK + threadIdx.x;
    if (index >= args.count)
        return;
    const LightPlace place = args.places[index];
    Link *links = args.links + args.offsets[index];
    const unsigned count = args.offsets[index + 1] - args.offsets[index];
    for (unsigned link = 0; link < count; ++link) {
        const Site &site = args.table.sites[links[link].site];
        const float nearest = args.nearest != nullptr ? args.nearest[index] : args.fine[args.table.values[links[link].site] - 1].nearest;
        if (may_be_hidden(place, site.position, nearest) && occluded(structure, args.tally, site_segment(place, site)))
            links[link].weight = 0.0f;
    }
    balance(args, place, links, count);
}

// Numbers the sites with a weight that have no value yet.
DEVICE void ask_values(const Lookup &args, unsigned index) {
    const SurfaceCells &table = args.table;
    for (unsigned link = args.offsets[index]; link < args.offsets[index + 1]; ++link) {
        const unsigned site = args.links[link].site;
        if (args.links[link].weight <= 0.0f || table.values[site] != 0 || atomicCAS(table.values + site, 0u, NO_NUMBER) != 0)
            continue;
        const unsigned value = atomicAdd(table.value_count, 1u);
        table.owners[value] = site;
        table.values[site] = value + 1;
    }
}
