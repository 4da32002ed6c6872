// Searches by region, one warp each: tests accel/search.cuh and accel/region.cuh, with all structures.
#define ALPHA_TEST 1
#define WALKS_grid 1
#include "cuda/prelude.cuh"

#include "accel/search.cuh"

// What a region is built from.
struct Asked {
    unsigned shape;
    // Points with normals, at most 32; none if nothing is cut off.
    unsigned point_count;
    float slack, reach;
    Vec3 low, high, emitter_low, emitter_high;
    Vec3 points[WARP], normals[WARP];
};

// The numbers of the forms.
enum RegionShape { BOX, NEAR, SHAFT };

struct Search {
    Scene scene;
    const Asked *regions;
    // The positions found per region, with room for `room` each, and their number.
    unsigned *found, *counts;
    unsigned room, spare;
};

// Finds the triangles of a region and writes their indices.
template <class RegionShape, class Structure>
DEVICE void search_region(const Search &args, const Structure &structure, const Region<RegionShape> &region, unsigned *list,
                          unsigned *memory) {
    const unsigned lane = lane_of_thread();
    auto search = begin_search(structure, region, memory);
    unsigned total = 0;
    while (goes_on(structure, search)) {
        unsigned count = WARP - 1;
        next_triangles<true>(structure, region, search, list, count);
        // More would not fit.
        if (count > FOUND_TRIANGLES) __trap();
        for (unsigned i = WARP - 1 + lane; i < count; i += WARP) {
            const unsigned place = total + i - (WARP - 1);
            if (place < args.room)
                args.found[blockIdx.x * args.room + place] = triangle_index(triangle_at(structure, list[i]));
        }
        total += count - (WARP - 1);
        __syncwarp();
    }
    if (lane == 0)
        args.counts[blockIdx.x] = total;
}

template <class Structure>
DEVICE void search_regions(const Search &args, const Structure &structure) {
    DYNAMIC_SHARED(unsigned, shared);
    ShaftFaces *faces = reinterpret_cast<ShaftFaces *>(shared + PLANE_WORDS);
    unsigned *list = shared + PLANE_WORDS + SHAFT_WORDS, *memory = list + FOUND_TRIANGLES;
    const Asked &asked = args.regions[blockIdx.x];
    const unsigned lane = lane_of_thread(), known = lane < asked.point_count ? lane : 0;
    const TangentPlanes planes = tangent_planes(asked.low, lane < asked.point_count, asked.points[known], asked.normals[known],
                                                reinterpret_cast<PlanesMemory *>(shared));
    const Bounds origins = {asked.low, asked.high};
    if (asked.shape == BOX)
        search_region(args, structure, region_above(region_within(origins), planes, asked.slack), list, memory);
    else if (asked.shape == NEAR)
        search_region(args, structure, region_above(region_near(origins, asked.reach), planes, asked.slack), list, memory);
    else
        search_region(args, structure,
                      region_above(region_shaft(origins, Bounds{asked.emitter_low, asked.emitter_high}, faces), planes, asked.slack), list,
                      memory);
}

KERNEL_PER_STRUCTURE(search_regions, Search, WARP, 1)
