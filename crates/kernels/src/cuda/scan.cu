// Exclusive prefix sums of unsigned numbers, in place: a block of 256 threads scans 1024 values; the sums of the blocks are
// scanned in turn, then added.
#include "cuda/prelude.cuh"

#include "cuda/warp.cuh"

KERNEL(scan_blocks, Scan, BLOCK, 4) {
    SHARED(unsigned, warps, [BLOCK / WARP]);
    const unsigned lane = lane_of_thread(), warp = threadIdx.x / WARP;
    const unsigned long long first = ((unsigned long long)blockIdx.x * BLOCK + threadIdx.x) * VALUES_OF_THREAD;

    // 1. The values of this thread and their sum.
    unsigned values[VALUES_OF_THREAD], sum = 0;
    for (unsigned i = 0; i < VALUES_OF_THREAD; i++) {
        values[i] = first + i < args.count ? args.values[first + i] : 0;
        sum += values[i];
    }
    // 2. The sums of the preceding threads: in the warp, then of the preceding warps.
    unsigned until = sum;
    for (unsigned step = 1; step < WARP; step *= 2) {
        const unsigned other = __shfl_up_sync(ALL_LANES, until, step);
        until += lane >= step ? other : 0;
    }
    if (lane == WARP - 1)
        warps[warp] = until;
    __syncthreads();
    unsigned before = until - sum;
    for (unsigned other = 0; other < warp; other++)
        before += warps[other];
    if (threadIdx.x == BLOCK - 1)
        args.sums[blockIdx.x] = before + sum;
    // 3. The sums before each value.
    for (unsigned i = 0; i < VALUES_OF_THREAD; i++) {
        if (first + i < args.count)
            args.values[first + i] = before;
        before += values[i];
    }
}

KERNEL(add_offsets, Scan, BLOCK, 4) {
    const unsigned long long first = ((unsigned long long)blockIdx.x * BLOCK + threadIdx.x) * VALUES_OF_THREAD;
    const unsigned before = args.sums[blockIdx.x];
    for (unsigned i = 0; i < VALUES_OF_THREAD; i++)
        if (first + i < args.count)
            args.values[first + i] += before;
}
