// Bricks of 4 x 4 x 4 lattice points: twin of bricks.rs, and the table that finds them on a device.
#pragma once

#include "light_mesh/lattice.cuh"

// The brick that holds a lattice point (no component negative).
DEVICE unsigned long long brick_of(IVec3 index) {
    return (unsigned long long)(index.z >> 2) << (2 * AXIS_BITS) | (unsigned long long)(index.y >> 2) << AXIS_BITS |
           (unsigned long long)(index.x >> 2);
}

// The bit of a lattice point within its brick: x in the lowest two bits.
DEVICE unsigned point_bit(IVec3 index) { return (index.z & 3) << 4 | (index.y & 3) << 2 | (index.x & 3); }

// Brick and bit of a lattice point in one number.
DEVICE unsigned long long point_key(IVec3 index) { return brick_of(index) << 6 | point_bit(index); }

// The lattice point of a key: the inverse of point_key.
DEVICE IVec3 point_of(unsigned long long key) {
    const unsigned mask = (1u << AXIS_BITS) - 1;
    const unsigned bit = key & 63;
    return IVec3{(int)(((unsigned)(key >> 6) & mask) << 2 | (bit & 3)),
                 (int)(((unsigned)(key >> (6 + AXIS_BITS)) & mask) << 2 | (bit >> 2 & 3)),
                 (int)(((unsigned)(key >> (6 + 2 * AXIS_BITS)) & mask) << 2 | bit >> 4)};
}

// Fibonacci hashing: the golden ratio spreads neighbouring keys.
DEVICE unsigned brick_hash(unsigned long long key) { return (unsigned)(key * 0x9e3779b97f4a7c15ull >> 32); }

// A brick that is not in the table.
#define NO_SLOT 0xffffffffu

// The slot of a brick, by linear probing. Keys of a run of slots do not ascend from where their probing began, so a smaller one ends
// the search as an empty slot does.
DEVICE unsigned find_slot(const BrickTable &table, unsigned long long key) {
    const unsigned mask = table.capacity - 1;
    const unsigned long long value = key + 1;
    for (unsigned slot = brick_hash(key) & mask;; slot = (slot + 1) & mask) {
        const unsigned long long found = table.keys[slot];
        if (found == value)
            return slot;
        if (found < value)
            return NO_SLOT;
    }
}
