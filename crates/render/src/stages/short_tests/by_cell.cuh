// The short tests by cell, one warp for up to 32 surface points: twin of cells.rs (which triangles can matter, each with the box of
// light points that its shadow can reach) and batch.rs (lanes are surface points; triangle and light point are the same for all).
//
// 1, 2. The half-balls: half_balls.cuh.
// 3. Occluders: triangles are found (accel/search.cuh), those that can matter are chosen (candidates.cuh), and the light points that
//    they may hide are tested (targets.cuh), round by round.
// 4. The masks: masks.cuh.
#pragma once

#include "cuda/tally.cuh"
#include "light_mesh/bricks.cuh"
#include "stages/short_tests/candidates.cuh"
#include "stages/short_tests/half_balls.cuh"
#include "stages/short_tests/masks.cuh"
#include "stages/short_tests/targets.cuh"

// 3. Occluders. Returns whether the lane tested any triangle.
template <class Structure>
DEVICE bool test_occluders(const ShortTests &args, const Structure &structure, const CellBundle &bundle, const BundleLane &lane,
                           const CellMemory &memory) {
    const LightMesh &mesh = args.mesh;
    const auto near = region_near(Bounds{bundle.low, bundle.high}, mesh.radius + mesh.slack);
    const auto region = region_above(near, bundle.planes, mesh.slack);
    // Unfiltered: choosing candidates tests triangles more strictly than a filter would.
    auto search = begin_search(structure, region, memory.search);
    bool asked = false;
    unsigned found = 0;
    while (goes_on(structure, search) || found != 0) {
        while (goes_on(structure, search) && found < WARP)
            next_triangles<false>(structure, region, search, memory.found, found);
        unsigned count = min(found, WARP);
        found -= count;
        const unsigned rows = choose_candidates(mesh, bundle, structure, memory, found, count);
        asked |= test_candidates(args, alpha_mask_of(structure), bundle, lane, memory, rows);
        __syncwarp();
    }
    return asked;
}

template <bool SHARED_MASKS, class Structure>
DEVICE void short_tests_of_bundle(const ShortTests &args, const Structure &structure) {
    DYNAMIC_SHARED(unsigned, shared);
    // The last come first: slow bundles are more often in the lower part of an image (in Childpark this saves a tenth), and if one
    // begins late, the device waits for it alone.
    const unsigned long long index = args.first_bundle + (args.bundle_count - 1 - blockIdx.x);
    const CellMemory memory = cell_memory<SHARED_MASKS>(args, structure, shared, index);
    const Bundle bundle = args.bundles[index];
    const BundleLane own = lane_of_bundle(args.scene, args.rays, args.hits, args.members, bundle);
    const CellBundle shape = cell_bundle(args.mesh, bundle, own, memory.planes);

    // 1, 2. The half-balls.
    const unsigned size = half_balls(args.mesh, shape, own, memory.seen);
    __syncwarp();
    // 3. Occluders.
    const bool asked = test_occluders(args, structure, shape, own, memory);

    // 4. The masks, and what was counted.
    const unsigned used = write_masks(args, index, memory.seen);
    count_short_tests(args.tally, size, used, asked ? size : 0);
}

template <class Structure>
DEVICE void short_tests_by_cell(const ShortTests &args, const Structure &structure) {
    short_tests_of_bundle<true>(args, structure);
}

// For templates whose masks do not fit into shared memory.
template <class Structure>
DEVICE void short_tests_by_cell_large(const ShortTests &args, const Structure &structure) {
    short_tests_of_bundle<false>(args, structure);
}
