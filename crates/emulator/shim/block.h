// A thread block as the emulator runs it: the functions behind the names that kernels use.
//
// The threads of a block are fibres of one thread of the host. A fibre runs until it must wait for others, at a collective of its
// warp or a barrier of its block; then the next one runs. The last to arrive sets all of them free.
#pragma once

// CUDA's own; here, because threadIdx has this type. `__thread` needs no check at each use, as `thread_local` may.
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

// A kernel that was compiled in. They form a list.
struct Kernel {
    const char *module, *name;
    // Bytes of its one parameter.
    unsigned arguments;
    // Most threads of a block.
    unsigned threads;
    void (*run)(const void *arguments);
    const Kernel *next;

    static const Kernel *first;
    Kernel(const char *module, const char *name, unsigned arguments, unsigned threads, void (*run)(const void *))
        : module(module), name(name), arguments(arguments), threads(threads), run(run), next(first) {
        first = this;
    }
};

// A variable that the host sets.
struct Constant {
    const char *module, *name;
    unsigned long bytes;
    // Where the calling thread of the host has it.
    void *(*place)();
    const Constant *next;

    static const Constant *first;
    Constant(const char *module, const char *name, unsigned long bytes, void *(*place)())
        : module(module), name(name), bytes(bytes), place(place), next(first) {
        first = this;
    }
};

// Where threads wait for others.
enum class Meeting : unsigned char { SyncWarp, Ballot, Shuffle, MatchAny, SyncThreads };

// Waits until all lanes of `mask` have come here with the same mask. `value` is what this lane brings, `source` the lane whose
// value a shuffle gives back.
Bits meet(Meeting what, unsigned mask, Bits value, unsigned source);

// Waits until all threads of the block have come; gives back how many brought true.
unsigned meet_block(bool value);

// The variable of the block that belongs to a declaration.
void *shared(const void *declaration, const char *name, unsigned long bytes);
void *dynamic_shared();

// Ends the launch with a message.
[[noreturn]] void fault(const char *reason);

} // namespace emulator
