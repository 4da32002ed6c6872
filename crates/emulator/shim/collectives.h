// Collective operations of the threads of a warp or a block.
//
// Stricter than CUDA: every lane of a mask, and every thread of a block at a barrier, must take part; none may have exited.
#pragma once

#include <cstring>

#include "block.h"

namespace emulator {

// The bits of a value passed between lanes.
template <class T>
static inline Bits bits_of(T value) {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8, "lanes exchange values of 4 or 8 bytes");
    Bits bits = 0;
    std::memcpy(&bits, &value, sizeof value);
    return bits;
}

template <class T>
static inline T value_of(Bits bits) {
    T value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

static inline unsigned lane() {
    return threadIdx.x % warpSize;
}

template <class T>
static inline T shuffle(unsigned mask, T value, unsigned source) {
    return value_of<T>(meet(Meeting::Shuffle, mask, bits_of(value), source));
}

} // namespace emulator

#define EMULATED [[maybe_unused]] static inline

EMULATED void __syncthreads() {
    emulator::meet_block(false);
}

EMULATED int __syncthreads_count(int predicate) {
    return static_cast<int>(emulator::meet_block(predicate != 0));
}

EMULATED int __syncthreads_or(int predicate) {
    return emulator::meet_block(predicate != 0) != 0;
}

EMULATED int __syncthreads_and(int predicate) {
    return emulator::meet_block(predicate == 0) == 0;
}

EMULATED void __syncwarp(unsigned mask = 0xffffffffu) {
    emulator::meet(emulator::Meeting::SyncWarp, mask, 0, 0);
}

EMULATED unsigned __ballot_sync(unsigned mask, int predicate) {
    return static_cast<unsigned>(emulator::meet(emulator::Meeting::Ballot, mask, predicate != 0, 0));
}

EMULATED int __any_sync(unsigned mask, int predicate) {
    return __ballot_sync(mask, predicate) != 0;
}

EMULATED int __all_sync(unsigned mask, int predicate) {
    return __ballot_sync(mask, predicate) == mask;
}

template <class T>
EMULATED unsigned __match_any_sync(unsigned mask, T value) {
    return static_cast<unsigned>(emulator::meet(emulator::Meeting::MatchAny, mask, emulator::bits_of(value), 0));
}

// Segments of `width` lanes, a power of two, exchange values among themselves; instead of a value from outside, a lane gets its
// own.
template <class T>
EMULATED T __shfl_sync(unsigned mask, T value, int source, int width = warpSize) {
    const unsigned segment = emulator::lane() & ~static_cast<unsigned>(width - 1);
    return emulator::shuffle(mask, value, segment | (static_cast<unsigned>(source) & static_cast<unsigned>(width - 1)));
}

template <class T>
EMULATED T __shfl_up_sync(unsigned mask, T value, unsigned distance, int width = warpSize) {
    const unsigned lane = emulator::lane(), place = lane & static_cast<unsigned>(width - 1);
    return emulator::shuffle(mask, value, distance <= place ? lane - distance : lane);
}

template <class T>
EMULATED T __shfl_down_sync(unsigned mask, T value, unsigned distance, int width = warpSize) {
    const unsigned lane = emulator::lane(), place = lane & static_cast<unsigned>(width - 1);
    return emulator::shuffle(mask, value, distance < static_cast<unsigned>(width) - place ? lane + distance : lane);
}

template <class T>
EMULATED T __shfl_xor_sync(unsigned mask, T value, int lanes, int width = warpSize) {
    const unsigned lane = emulator::lane(), source = lane ^ static_cast<unsigned>(lanes);
    // As documented by CUDA, lanes of preceding segments may be read, those of later segments may not.
    const unsigned end = (lane & ~static_cast<unsigned>(width - 1)) + static_cast<unsigned>(width);
    return emulator::shuffle(mask, value, source < end ? source : lane);
}
