// The results of short tests.
#pragma once

#include "cuda/tally.cuh"
#include "light_mesh/template.cuh"

// 4. Writes the masks of a bundle's surface points. Returns how many bits the lane wrote.
DEVICE unsigned write_masks(const ShortTests &args, unsigned long long index, const unsigned *seen) {
    const unsigned points = 32 * args.mesh.words;
    unsigned used = 0;
    for (unsigned k = lane_of_thread(); k < points; k += WARP) {
        const unsigned lanes = seen[k];
        args.masks[index * points + k] = lanes;
        used += __popc(lanes);
    }
    return used;
}

// Adds what a warp counted. `used` may count any part of the warp's masks, the others count the lane's.
DEVICE void count_short_tests(const Tally &tally, unsigned half_ball, unsigned used, unsigned tested) {
    Counters &shard = tally_shard(tally);
    count(shard.half_ball, half_ball);
    count(shard.used, used);
    count(shard.short_tests, tested);
}
