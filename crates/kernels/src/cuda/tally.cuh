// Counting: sums over a warp, then one atomic addition to the block's shard.
#pragma once

#include "cuda/warp.cuh"

DEVICE Counters &tally_shard(const Tally &tally) {
    return tally.shards[blockIdx.x % Tally::SHARDS];
}

// Adds the amounts of all lanes. All lanes of the warp take part.
DEVICE void count(unsigned long long &counter, unsigned amount) {
    const unsigned sum = warp_sum(amount);
    if (lane_of_thread() == 0 && sum > 0)
        atomicAdd(&counter, (unsigned long long)sum);
}
