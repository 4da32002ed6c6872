// Visibility of light points, cached on a CUDA device from image to image: twin of host.rs.
//
// 1. `admit_bricks`: finds the image's bricks in the cached table, inserts new ones, and makes them the youngest.
// 2. `find_unknown`: the points whose value for one light is unknown; they are listed and tested as all points are without a cache.
// 3. `learn`: stores the results for these points.
// 4. `recall`: what all points of the image see.
//
// A brick stays in its slot as long as the table is large enough, so values never move; which of two bricks gets a slot first may
// differ from run to run, but the values do not. `move_bricks` and `move_answers` copy a table into a larger one.
#include "cuda/prelude.cuh"

#include "light_mesh/bricks.cuh"

// The slot of a brick, which is inserted if it is new. If the table is full, the count exceeds its capacity.
DEVICE unsigned slot_for(const Cache &args, unsigned long long value) {
    const unsigned mask = args.table.capacity - 1;
    unsigned slot = brick_hash(value - 1) & mask;
    for (unsigned probes = 0; probes <= mask; probes++) {
        const unsigned long long found = atomicCAS(&args.table.keys[slot], 0ull, value);
        if (found == 0)
            atomicAdd(args.bricks, 1u);
        if (found == 0 || found == value)
            return slot;
        slot = (slot + 1) & mask;
    }
    atomicOr(args.bricks, 0x80000000u);
    return NO_SLOT;
}

// The slot of a thread in the image's table; `false` if there is none, or none of its points is used.
DEVICE bool slot_of_thread(const Cache &args, unsigned &slot) {
    slot = blockIdx.x * blockDim.x + threadIdx.x;
    return slot < args.points.table.capacity && args.points.used[slot] != 0;
}

KERNEL(admit_bricks, Cache, BLOCK, 4) {
    unsigned slot;
    // A table that is more than half full is abandoned: the host allocates a larger one.
    if (!slot_of_thread(args, slot) || *(volatile unsigned *)args.bricks > args.table.capacity / 2)
        return;
    const unsigned row = slot_for(args, args.points.table.keys[slot]);
    args.rows[slot] = row;
    if (row != NO_SLOT)
        args.ages[row] = args.image;
}

KERNEL(find_unknown, Cache, BLOCK, 4) {
    unsigned slot;
    if (slot_of_thread(args, slot))
        args.unknown[slot] = args.points.used[slot] & ~args.kept.known[args.rows[slot]];
}

// Here the points are those that were unknown.
KERNEL(learn, Cache, BLOCK, 4) {
    unsigned slot;
    if (!slot_of_thread(args, slot))
        return;
    const unsigned long long row = args.rows[slot], found = args.points.used[slot];
    if (args.lit.bits != nullptr) {
        args.kept.bits[row] |= args.lit.bits[slot];
    } else {
        unsigned rank = args.points.rank[slot];
        for (unsigned long long rest = found; rest != 0; rest &= rest - 1)
            args.kept.seen[row << POINT_BITS | (__ffsll(rest) - 1)] = args.lit.seen[rank++];
    }
    args.kept.known[row] |= found;
}

KERNEL(recall, Cache, BLOCK, 4) {
    unsigned slot;
    if (!slot_of_thread(args, slot))
        return;
    const unsigned long long row = args.rows[slot], used = args.points.used[slot];
    if (args.lit.bits != nullptr) {
        args.lit.bits[slot] = args.kept.bits[row] & used;
        return;
    }
    unsigned rank = args.points.rank[slot];
    for (unsigned long long rest = used; rest != 0; rest &= rest - 1)
        args.lit.seen[rank++] = args.kept.seen[row << POINT_BITS | (__ffsll(rest) - 1)];
}

KERNEL(move_bricks, Cache, BLOCK, 4) {
    const unsigned slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot >= args.from_table.capacity || args.from_table.keys[slot] == 0)
        return;
    const unsigned row = slot_for(args, args.from_table.keys[slot]);
    args.rows[slot] = row;
    args.ages[row] = args.from_ages[slot];
}

KERNEL(move_answers, Cache, BLOCK, 4) {
    const unsigned slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot >= args.from_table.capacity || args.from_table.keys[slot] == 0)
        return;
    const unsigned long long row = args.rows[slot], known = args.from.known[slot];
    args.kept.known[row] = known;
    if (args.from.bits != nullptr) {
        args.kept.bits[row] = args.from.bits[slot];
        return;
    }
    for (unsigned long long rest = known; rest != 0; rest &= rest - 1) {
        const unsigned bit = __ffsll(rest) - 1;
        args.kept.seen[row << POINT_BITS | bit] = args.from.seen[(unsigned long long)slot << POINT_BITS | bit];
    }
}
