// Copies within a device's memory.
#include "cuda/prelude.cuh"

KERNEL(copy_words, Copy, BLOCK, 4) {
    const unsigned long long word = (unsigned long long)blockIdx.x * BLOCK + threadIdx.x;
    if (word < args.count)
        args.to[word] = args.from[word];
}
