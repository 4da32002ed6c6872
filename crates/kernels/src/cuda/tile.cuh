// Cooperative operations of the threads of a block that takes a tile, one surface point each.
#pragma once

#include "cuda/warp.cuh"

// Sorts one word per thread, ascending (bitonic sort: Batcher 1968). Partners within a warp exchange through registers.
DEVICE unsigned sorted(unsigned word, unsigned *shared) {
    const unsigned thread = threadIdx.x;
    for (unsigned length = 2; length <= TILE; length *= 2) {
        for (unsigned distance = length / 2; distance > 0; distance /= 2) {
            unsigned other;
            if (distance < WARP) {
                other = __shfl_xor_sync(ALL_LANES, word, distance);
            } else {
                __syncthreads();
                shared[thread] = word;
                __syncthreads();
                other = shared[thread ^ distance];
            }
            const bool ascending = (thread & length) == 0;
            const bool lower = (thread & distance) == 0;
            word = ascending == lower ? min(word, other) : max(word, other);
        }
    }
    return word;
}

// The largest value of this thread and all before it. `shared` has an entry for each warp.
DEVICE unsigned largest_before(unsigned value, unsigned *shared) {
    const unsigned lane = lane_of_thread(), warp = threadIdx.x / WARP;
    for (unsigned step = 1; step < WARP; step *= 2) {
        const unsigned other = __shfl_up_sync(ALL_LANES, value, step);
        if (lane >= step)
            value = max(value, other);
    }
    __syncthreads();
    if (lane == WARP - 1)
        shared[warp] = value;
    __syncthreads();
    for (unsigned before = 0; before < warp; before++)
        value = max(value, shared[before]);
    return value;
}

// How many threads before this one have the flag set, and how many there are in all. `shared` has an entry for each warp.
DEVICE unsigned flags_before(bool flag, unsigned *shared, unsigned &all) {
    const unsigned lane = lane_of_thread(), warp = threadIdx.x / WARP;
    const unsigned flags = __ballot_sync(ALL_LANES, flag);
    __syncthreads();
    if (lane == 0)
        shared[warp] = __popc(flags);
    __syncthreads();
    unsigned before = __popc(flags & lanes_below(lane));
    all = 0;
    for (unsigned other = 0; other < TILE / WARP; other++) {
        before += other < warp ? shared[other] : 0;
        all += shared[other];
    }
    return before;
}

// The word of a thread without a surface point; behind all others.
#define NO_POINT 0xffffffffu

// The bundle of a tile that a thread begins, if any.
struct TileBundle {
    bool begins;
    // Its number, its end among the tile's points, and the number of bundles in the tile.
    unsigned number, end, count;
};

// Every cell begins a bundle, and so does every 32nd point after its first. `words` has an entry for each thread, `warps` for each warp.
DEVICE TileBundle bundle_of_thread(bool is_point, bool first_of_cell, unsigned *words, unsigned *warps) {
    const unsigned thread = threadIdx.x;
    const unsigned start = largest_before(first_of_cell ? thread : 0, warps);
    TileBundle bundle;
    bundle.begins = is_point && (thread - start) % WARP == 0;
    unsigned points;
    bundle.number = flags_before(bundle.begins, warps, bundle.count);
    flags_before(is_point, warps, points);
    __syncthreads();
    if (bundle.begins)
        words[bundle.number] = thread;
    __syncthreads();
    bundle.end = bundle.number + 1 < bundle.count ? words[bundle.number + 1] : points;
    return bundle;
}
