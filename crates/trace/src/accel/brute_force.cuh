// Tests every triangle: twin of brute_force.rs.
#pragma once

#include "accel/region_filter.cuh"
#include "accel/visit.cuh"

template <class Visitor>
DEVICE void walk(const BruteForce &all, const Tally &, const Ray &, Visitor &visitor) {
    ask(visitor, all, Run{0, all.count});
}

DEVICE void walk_short(const BruteForce &all, Short &segment, float) {
    ask(segment, all, Run{0, all.count});
}

// A search in progress: the first triangle that has not been looked at.
struct ListSearch {
    unsigned next;
};

DEVICE unsigned search_words(const BruteForce &) { return 0; }

template <class RegionShape>
DEVICE ListSearch begin_search(const BruteForce &, const Region<RegionShape> &, unsigned *) { return ListSearch{0}; }

template <class RegionShape>
DEVICE unsigned find_starts(const BruteForce &, const Region<RegionShape> &, unsigned *) { return FROM_ROOT; }

template <class RegionShape>
DEVICE ListSearch begin_search_at(const BruteForce &all, const Region<RegionShape> &region, unsigned *memory, const unsigned *,
                                  unsigned) {
    return begin_search(all, region, memory);
}

DEVICE bool goes_on(const BruteForce &all, const ListSearch &search) { return search.next < all.count; }

// One round: each lane takes three triangles.
template <bool FILTERED, class RegionShape>
DEVICE void next_triangles(const BruteForce &all, const Region<RegionShape> &region, ListSearch &search, unsigned *found,
                           unsigned &count) {
    for (unsigned i = 0; i < 3 && search.next < all.count; i++) {
        const unsigned place = search.next + lane_of_thread();
        filter_by_region<FILTERED>(region, all.triangles + place, place < all.count, place, found, count);
        search.next += WARP;
    }
    __syncwarp();
}
