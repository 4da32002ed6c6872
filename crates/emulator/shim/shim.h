// CUDA's names in plain C++: with this header, a kernel file compiles for the host and runs in the emulator.
//
// Included by cuda/prelude.cuh, which explains how kernels use the keywords defined here. Names that are missing here are not
// used by any kernel or have no meaning on a host; add new ones to the appropriate header.
#pragma once

#include "block.h"

#define DEVICE [[maybe_unused]] static inline
#define COLD [[maybe_unused]] static __attribute__((noinline))

// The generated file that includes a kernel file defines the module's name.
#define KERNEL(name, Record, threads, blocks)                                                                                    \
    static void name(const Record &args);                                                                                        \
    static ::emulator::Kernel kernel_##name{EMULATED_MODULE, #name, sizeof(Record), threads,                                     \
                                            [](const void *args) { name(*static_cast<const Record *>(args)); }};                 \
    static void name([[maybe_unused]] const Record &args)

// One variable for all threads of a block. The lambda's static variable distinguishes declarations, including those of template
// instances.
#define SHARED(type, name, dims)                                                                                                 \
    auto &name = *static_cast<type(*) dims>(::emulator::shared(                                                            \
        [] {                                                                                                                     \
            static char place;                                                                                       \
            return &place;                                                                                                       \
        }(),                                                                                                                     \
        #name, sizeof(type dims)))
#define DYNAMIC_SHARED(type, name) type *const name = static_cast<type *>(::emulator::dynamic_shared())

// One copy per host thread, so that launches do not interfere.
#define CONSTANT(type, name, dims)                                                                                               \
    static thread_local type name dims;                                                                                          \
    static ::emulator::Constant constant_##name{EMULATED_MODULE, #name, sizeof(name), []() -> void * { return &name; }};

#include "vectors.h"

#include "atomics.h"
#include "collectives.h"
#include "numbers.h"
