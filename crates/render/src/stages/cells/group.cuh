// Surface points by cell, tile by tile: a block of 1024 threads takes a tile of 32 x 32 pixels, or 1024 rays of a list.
#pragma once

#include "data/rays.cuh"
#include "cuda/tile.cuh"
#include "light_mesh/bricks.cuh"
#include "light_mesh/lattice.cuh"
#include "surface.cuh"

// The sort key of a surface point: 16 bits of its cell's hash, 6 bits of its triangle's, 10 bits of its thread. Points of one
// triangle are adjacent, so that bundles have few normals and small boxes. Cells with equal hashes may be interleaved; then they are
// split into more bundles, and nothing else changes.
DEVICE unsigned sort_word(unsigned long long cell, unsigned triangle, unsigned thread) {
    const unsigned hash = (unsigned)((cell * GOLDEN_RATIO) >> 48);
    // All ones is reserved for threads without a surface point.
    return min(hash, LAST_HASH) << 16 | triangle * (unsigned)(GOLDEN_RATIO >> 32) >> 26 << 10 | thread;
}

DEVICE void group_points_of_tile(const GroupCells &args) {
    SHARED(unsigned long long, cells, [TILE]);
    SHARED(unsigned, rays, [TILE]);
    SHARED(unsigned, words, [TILE]);
    SHARED(unsigned, warps, [TILE / WARP]);
    const unsigned thread = threadIdx.x;
    const unsigned long long tile = args.first_block + blockIdx.x;

    // 1. The cell of each surface point.
    unsigned ray = 0;
    const bool in_picture = tile_ray_of_thread(args.rays, (unsigned)tile, thread, ray);
    unsigned word = NO_POINT;
    if (in_picture && args.hits[ray].triangle != Hit::NONE) {
        const SurfacePoint point = surface_point_of(args.scene, args.rays, args.hits, ray);
        const unsigned long long cell = point_key(lattice_cell(args.mesh, point.position));
        cells[thread] = cell;
        rays[thread] = ray;
        word = sort_word(cell, args.hits[ray].triangle, thread);
    }
    __syncthreads();

    // 2. Sort by cell; within a cell by triangle, then by thread, so that neighbours stay neighbours.
    word = sorted(word, words);
    const bool is_point = word != NO_POINT;
    const unsigned source = word & (TILE - 1);
    const unsigned long long cell = is_point ? cells[source] : 0;
    __syncthreads();
    words[thread] = word;
    __syncthreads();
    const bool first_of_cell =
        is_point && (thread == 0 || cells[words[thread - 1] & (TILE - 1)] != cell);

    // 3. Every cell begins a bundle, and so does every 32nd point after its first.
    const TileBundle bundle = bundle_of_thread(is_point, first_of_cell, words, warps);
    const unsigned long long place = tile * TILE;
    if (is_point)
        args.members[place + thread] = rays[source];
    if (bundle.begins)
        args.tile_bundles[place + bundle.number] = Bundle{cell, (unsigned)(place + thread), bundle.end - thread};
    if (thread == 0)
        args.counts[tile] = bundle.count;
}

// 4. Copies the bundles of a tile to their place in the list.
DEVICE void gather_bundles_of_tile(const GroupCells &args) {
    const unsigned first = args.counts[blockIdx.x], count = args.counts[blockIdx.x + 1] - first;
    if (threadIdx.x < count)
        args.bundles[first + threadIdx.x] = args.tile_bundles[(unsigned long long)blockIdx.x * TILE + threadIdx.x];
}
