// Kernels that test the emulator itself: each uses one feature that it must support, or commits one error that it must detect.
#include "shim.h"

struct Own {
    unsigned *out;
    unsigned *total;
    unsigned count;
    unsigned choice;
};

CONSTANT(unsigned, table, [4]);

DEVICE unsigned number() {
    return blockIdx.x * blockDim.x + threadIdx.x;
}

KERNEL(write_numbers, Own, 1024, 1) {
    if (number() < args.count) args.out[number()] = number();
}

KERNEL(warp_words, Own, 1024, 1) {
    const unsigned lane = threadIdx.x % 32, all = 0xffffffffu;
    unsigned *const out = args.out + 12 * number();
    out[0] = __ballot_sync(all, lane % 3 == 0);
    out[1] = __shfl_sync(all, lane * lane, 5);
    out[2] = __shfl_sync(all, lane, 3, 8);
    out[3] = __shfl_up_sync(all, lane, 2);
    out[4] = __shfl_down_sync(all, lane, 2);
    out[5] = __shfl_xor_sync(all, lane, 1);
    out[6] = __match_any_sync(all, lane / 5);
    out[7] = __any_sync(all, lane == 31) + 2 * __all_sync(all, lane < 31);
    const unsigned long long wide = __shfl_sync(all, 0x100000001ull * lane, 7);
    out[8] = static_cast<unsigned>(wide >> 32) + static_cast<unsigned>(wide);
    out[9] = __float_as_uint(__shfl_sync(all, 0.5f * lane, 9));
    // Halves of the warp may diverge, each with its own mask.
    if (lane < 16) {
        out[10] = __ballot_sync(0x0000ffffu, lane % 2);
    } else {
        out[10] = __ballot_sync(0xffff0000u, lane % 2) + __shfl_sync(0xffff0000u, lane, 20);
    }
    __syncwarp();
    out[11] = __popc(__ballot_sync(all, 1));
}

// The sum over a block, by a tree in shared memory.
KERNEL(block_sum, Own, 1024, 1) {
    SHARED(unsigned, sums, [1024]);
    sums[threadIdx.x] = number();
    __syncthreads();
    for (unsigned half = blockDim.x / 2; half > 0; half /= 2) {
        if (threadIdx.x < half) sums[threadIdx.x] += sums[threadIdx.x + half];
        __syncthreads();
    }
    const unsigned odd = __syncthreads_count(threadIdx.x % 2);
    if (threadIdx.x == 0) {
        args.out[blockIdx.x] = sums[0] + odd;
        atomicAdd(args.total, sums[0]);
    }
}

KERNEL(dynamic_shared, Own, 1024, 1) {
    DYNAMIC_SHARED(unsigned, list);
    list[threadIdx.x] = threadIdx.x;
    __syncthreads();
    args.out[number()] = list[blockDim.x - 1 - threadIdx.x];
}

KERNEL(atomics, Own, 1024, 1) {
    atomicAdd(&args.out[0], 1u);
    atomicOr(&args.out[1], 1u << number() % 32);
    atomicMax(&args.out[2], number());
    atomicMin(&args.out[3], number());
    atomicXor(&args.out[4], number());
    if (atomicCAS(&args.out[5], 0u, 7u) == 0) atomicAdd(&args.out[6], 1u);
}

KERNEL(read_constant, Own, 1024, 1) {
    args.out[number()] = table[threadIdx.x % 4];
}

KERNEL(read_unset, Own, 1024, 1) {
    SHARED(unsigned, unset, [32]);
    SHARED(float, unset_float, );
    args.out[number()] = unset[threadIdx.x] ^ (unset_float == unset_float);
    unset[threadIdx.x] = 0;
}

// ---- Errors to be detected ----

KERNEL(wait_for_ended, Own, 1024, 1) {
    if (threadIdx.x == 37) return;
    __ballot_sync(0xffffffffu, 1);
    args.out[number()] = 1;
}

KERNEL(wait_at_two_places, Own, 1024, 1) {
    if (threadIdx.x % 32 == 3) {
        __syncthreads();
    } else {
        __syncwarp();
    }
    args.out[number()] = 1;
}

KERNEL(barrier_for_some, Own, 1024, 1) {
    if (threadIdx.x < args.choice) __syncthreads();
    args.out[number()] = 1;
}

KERNEL(not_in_mask, Own, 1024, 1) {
    args.out[number()] = __ballot_sync(0x0000ffffu, 1);
}

KERNEL(shuffle_from_outside, Own, 1024, 1) {
    if (threadIdx.x < 16) args.out[number()] = __shfl_sync(0x0000ffffu, threadIdx.x, 16);
}

KERNEL(write_outside, Own, 1024, 1) {
    if (number() == 0) args.out[static_cast<int>(args.choice)] = 1;
}

KERNEL(write_outside_shared, Own, 1024, 1) {
    SHARED(unsigned, small, [3]);
    small[args.choice] = 1;
    args.out[number()] = small[0];
}

KERNEL(much_shared, Own, 1024, 1) {
    SHARED(unsigned, big, [10000]);
    SHARED(unsigned, bigger, [3000]);
    big[threadIdx.x] = bigger[threadIdx.x] = 1;
    args.out[number()] = big[0] + bigger[0];
}

KERNEL(trap, Own, 1024, 1) {
    if (number() == args.choice) __trap();
}

KERNEL(wild_address, Own, 1024, 1) {
    SHARED(unsigned long long, unset, [1]);
    // A value that was never set is not a valid address.
    const unsigned *wild = reinterpret_cast<const unsigned *>(threadIdx.x == args.choice ? unset[0] : 0ull);
    if (threadIdx.x == args.choice) args.out[0] = *wild;
}
