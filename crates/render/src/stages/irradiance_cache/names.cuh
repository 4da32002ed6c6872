// Tables of names on a device: the number of a name is where all about it is found. Names are numbered in the order of insertion, which may
// differ from run to run; no result depends on it.
#pragma once

#include "sampling.cuh"

DEVICE unsigned slot_of_name(const Names &names, unsigned long long key) { return (unsigned)mix(key) & (names.capacity - 1); }

// The number of a name that is there; NO_NUMBER of others.
DEVICE unsigned number_of(const Names &names, unsigned long long key) {
    unsigned slot = slot_of_name(names, key);
    for (unsigned probes = 0; probes < NAME_PROBES; ++probes) {
        const unsigned long long found = __ldg(names.keys + slot);
        if (found == key)
            return __ldg(names.numbers + slot);
        if (found == 0)
            break;
        slot = (slot + 1) & (names.capacity - 1);
    }
    return NO_NUMBER;
}

// Whether a table is known to be too small. A full table is abandoned: the host allocates a larger one.
DEVICE bool is_abandoned(const Names &names) { return *(volatile unsigned *)names.count >= FULL_TABLE; }

DEVICE void abandon(const Names &names) {
    // Once is enough: threads would wait for each other.
    if (!is_abandoned(names))
        atomicOr(names.count, FULL_TABLE);
}

// Adds a name, unless it is there. Without room for it, the table's count exceeds its room.
DEVICE void add_name(const Names &names, const Name &name) {
    unsigned slot = slot_of_name(names, name.key);
    for (unsigned probes = 0; probes < NAME_PROBES; ++probes) {
        unsigned long long found = *(volatile unsigned long long *)(names.keys + slot);
        if (found == name.key)
            return;
        if (found == 0) {
            if (*(volatile unsigned *)names.count >= names.room)
                return abandon(names);
            found = atomicCAS(names.keys + slot, 0ull, name.key);
            if (found == name.key)
                return;
            if (found == 0) {
                // Also in a table that others abandoned meanwhile: what is counted moves to the larger one.
                const unsigned number = atomicAdd(names.count, 1u) & ~FULL_TABLE;
                names.numbers[slot] = number;
                if (number < names.room)
                    names.names[number] = name;
                return;
            }
        }
        slot = (slot + 1) & (names.capacity - 1);
    }
    abandon(names);
}

// Adds a name with the number that it had in a smaller table.
DEVICE void add_again(const Names &names, unsigned number) {
    const unsigned long long key = names.names[number].key;
    unsigned slot = slot_of_name(names, key);
    while (atomicCAS(names.keys + slot, 0ull, key) != 0)
        slot = (slot + 1) & (names.capacity - 1);
    names.numbers[slot] = number;
}
