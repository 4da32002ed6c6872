// Bricks of 4 x 4 x 4 lattice points: twin of bricks.rs, and the table to look them up on a device.
#pragma once

#include "light_mesh/lattice.cuh"

// The bits of a lattice point's index that give its position in its brick.
#define WITHIN_BRICK ((1 << BRICK_BITS) - 1)

// One axis of a brick's key.
DEVICE unsigned long long brick_coordinate(int index) { return (unsigned)(index + INDEX_BIAS) >> BRICK_BITS; }

// The brick that holds a lattice point.
DEVICE unsigned long long brick_of(IVec3 index) {
    return brick_coordinate(index.z) << 2 * AXIS_BITS | brick_coordinate(index.y) << AXIS_BITS | brick_coordinate(index.x);
}

// The bit of a lattice point within its brick: x in the lowest two bits.
DEVICE unsigned point_bit(IVec3 index) {
    return (index.z & WITHIN_BRICK) << (2 * BRICK_BITS) | (index.y & WITHIN_BRICK) << BRICK_BITS | (index.x & WITHIN_BRICK);
}

// Brick and bit of a lattice point in one number.
DEVICE unsigned long long point_key(IVec3 index) { return brick_of(index) << POINT_BITS | point_bit(index); }

// The lattice point of a key: the inverse of point_key.
DEVICE IVec3 point_of(unsigned long long key) {
    const unsigned mask = (1u << AXIS_BITS) - 1;
    const unsigned bit = key & ((1u << POINT_BITS) - 1);
    const unsigned long long brick = key >> POINT_BITS;
    return IVec3{(int)(((unsigned)brick & mask) << BRICK_BITS | (bit & WITHIN_BRICK)) - INDEX_BIAS,
                 (int)(((unsigned)(brick >> AXIS_BITS) & mask) << BRICK_BITS | (bit >> BRICK_BITS & WITHIN_BRICK)) - INDEX_BIAS,
                 (int)(((unsigned)(brick >> 2 * AXIS_BITS) & mask) << BRICK_BITS | bit >> 2 * BRICK_BITS) - INDEX_BIAS};
}

// Fibonacci hashing: the golden ratio spreads neighbouring keys.
DEVICE unsigned brick_hash(unsigned long long key) { return (unsigned)(key * GOLDEN_RATIO >> 32); }

// The slot of a brick, by linear probing. From where their probing began, the keys of a run of slots never ascend, so a smaller one
// ends the search, as an empty slot does.
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
