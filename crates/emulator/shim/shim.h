// CUDA's names for plain C++: with this, a kernel file compiles for the host and runs in the emulator.
//
// Included by cuda/prelude.cuh, which says how kernels use the words defined here. What is not here either is not used by any
// kernel or means nothing on a host; add it to the header that it belongs to.
#pragma once

#include "block.h"

#define DEVICE [[maybe_unused]] static inline
#define COLD [[maybe_unused]] static __attribute__((noinline))

// The generated file that includes a kernel file names the module.
#define KERNEL(name, Record, threads, blocks)                                                                                    \
    static void name(const Record &args);                                                                                        \
    static ::emulator::Kernel kernel_##name{EMULATED_MODULE, #name, sizeof(Record), threads,                                     \
                                            [](const void *args) { name(*static_cast<const Record *>(args)); }};                 \
    static void name([[maybe_unused]] const Record &args)

// One variable for all threads of a block. The lambda's variable tells declarations apart, also those of a template's instances.
#define SHARED(type, name, dims)                                                                                                 \
    auto &name = *static_cast<type(*) dims>(::emulator::shared(                                                            \
        [] {                                                                                                                     \
            static char place;                                                                                       \
            return &place;                                                                                                       \
        }(),                                                                                                                     \
        #name, sizeof(type dims)))
#define DYNAMIC_SHARED(type, name) type *const name = static_cast<type *>(::emulator::dynamic_shared())

// A copy for each thread of the host, so that launches do not disturb each other.
#define CONSTANT(type, name, dims)                                                                                               \
    static thread_local type name dims;                                                                                          \
    static ::emulator::Constant constant_##name{EMULATED_MODULE, #name, sizeof(name), []() -> void * { return &name; }};

#include "vectors.h"

#include "atomics.h"
#include "collectives.h"
#include "numbers.h"
