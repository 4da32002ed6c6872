// Atomic operations on memory that blocks share: blocks run on several threads of the host.
//
// Relaxed, as in CUDA; fences order the operations around them.
#pragma once

#include "collectives.h"

#define EMULATOR_ATOMICS(T)                                                                                                      \
    EMULATED T atomicAdd(T *address, T value) {                                                                                  \
        return __atomic_fetch_add(address, value, __ATOMIC_RELAXED);                                                             \
    }                                                                                                                            \
    EMULATED T atomicAnd(T *address, T value) {                                                                                  \
        return __atomic_fetch_and(address, value, __ATOMIC_RELAXED);                                                             \
    }                                                                                                                            \
    EMULATED T atomicOr(T *address, T value) {                                                                                   \
        return __atomic_fetch_or(address, value, __ATOMIC_RELAXED);                                                              \
    }                                                                                                                            \
    EMULATED T atomicXor(T *address, T value) {                                                                                  \
        return __atomic_fetch_xor(address, value, __ATOMIC_RELAXED);                                                             \
    }                                                                                                                            \
    EMULATED T atomicExch(T *address, T value) {                                                                                 \
        return __atomic_exchange_n(address, value, __ATOMIC_RELAXED);                                                            \
    }                                                                                                                            \
    EMULATED T atomicCAS(T *address, T expected, T value) {                                                                      \
        __atomic_compare_exchange_n(address, &expected, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);                       \
        return expected;                                                                                                         \
    }                                                                                                                            \
    EMULATED T atomicMin(T *address, T value) {                                                                                  \
        T old = __atomic_load_n(address, __ATOMIC_RELAXED);                                                                      \
        while (value < old &&                                                                                                    \
               !__atomic_compare_exchange_n(address, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {                   \
        }                                                                                                                        \
        return old;                                                                                                              \
    }                                                                                                                            \
    EMULATED T atomicMax(T *address, T value) {                                                                                  \
        T old = __atomic_load_n(address, __ATOMIC_RELAXED);                                                                      \
        while (value > old &&                                                                                                    \
               !__atomic_compare_exchange_n(address, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {                   \
        }                                                                                                                        \
        return old;                                                                                                              \
    }

EMULATOR_ATOMICS(int)
EMULATOR_ATOMICS(unsigned)
EMULATOR_ATOMICS(unsigned long long)

#undef EMULATOR_ATOMICS

EMULATED void __threadfence() {
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
}

EMULATED void __threadfence_block() {
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
}
