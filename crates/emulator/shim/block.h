// A thread block in the emulator: the functions behind the names that kernels use.
//
// The threads of a block are fibres of one host thread. A fibre runs until it must wait for others, at a collective of its warp
// or a barrier of its block; then the next one runs. The last to arrive releases all of them.
#pragma once

// As in CUDA; defined here because threadIdx has this type. `__thread` needs no check at each use, unlike `thread_local`.
struct uint2 {
    unsigned x, y;
} __attribute__((aligned(8)));
struct uint3 {
    unsigned x, y, z;
};
struct uint4 {
    unsigned x, y, z, w;
} __attribute__((aligned(16)));

extern __thread uint3 threadIdx, blockIdx, blockDim, gridDim;
static constexpr int warpSize = 32;

namespace emulator {

typedef unsigned long long Bits;

// A compiled kernel. Kernels form a linked list.
struct Kernel {
    const char *module, *name;
    // Size of its only parameter in bytes.
    unsigned arguments;
    // Maximum number of threads per block.
    unsigned threads;
    void (*run)(const void *arguments);
    const Kernel *next;

    static const Kernel *first;
    Kernel(const char *module, const char *name, unsigned arguments, unsigned threads, void (*run)(const void *))
        : module(module), name(name), arguments(arguments), threads(threads), run(run), next(first) {
        first = this;
    }
};

// A variable set by the host.
struct Constant {
    const char *module, *name;
    unsigned long bytes;
    // Its address in the calling host thread.
    void *(*place)();
    const Constant *next;

    static const Constant *first;
    Constant(const char *module, const char *name, unsigned long bytes, void *(*place)())
        : module(module), name(name), bytes(bytes), place(place), next(first) {
        first = this;
    }
};

// The points where threads wait for others.
enum class Meeting : unsigned char { SyncWarp, Ballot, Shuffle, MatchAny, SyncThreads };

// Waits until all lanes of `mask` have arrived here with the same mask. `value` is this lane's contribution, `source` the lane
// whose value a shuffle returns.
Bits meet(Meeting what, unsigned mask, Bits value, unsigned source);

// Waits until all threads of the block have arrived; returns how many passed true.
unsigned meet_block(bool value);

// The block's variable that belongs to a declaration.
void *shared(const void *declaration, const char *name, unsigned long bytes);
void *dynamic_shared();

// Ends the launch with a message.
[[noreturn]] void fault(const char *reason);

} // namespace emulator
