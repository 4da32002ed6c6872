// Step 3 on a CUDA device: each light point that some surface point uses, once. Formula (7).
//
// 1. `mark_bundles`: the used points of each brick around each bundle's cell.
// 2. `insert_bricks`: the bricks that hold a used point, in a table.
// 3. `mark_points`: the used points in each, and for each bundle the slots of its bricks.
// 4. `count_points`, then a scan: ranks.
// 5. `list_points`: all of them.
//
// The table is ordered: whatever the order of insertion, a key ends up in the same slot (Shun, Blelloch: Phase-Concurrent Hash
// Tables for Determinism, SPAA 2014). A larger key has priority: it pushes smaller ones on.
#include "cuda/prelude.cuh"

#include "cuda/warp.cuh"
#include "light_mesh/window.cuh"

// Shared memory of a warp: two words per brick, since there is no 64-bit "or" in shared memory.
KERNEL(mark_bundles, LightPoints, WARP * BUNDLE_WARPS, 8) {
    DYNAMIC_SHARED(unsigned, shared);
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const unsigned long long number = (unsigned long long)blockIdx.x * BUNDLE_WARPS + threadIdx.x / WARP;
    if (number >= args.bundle_count)
        return;
    const unsigned long long index = args.first_bundle + number;
    const IVec3 cell = point_of(args.bundles[index].cell);
    const Window window = window_around(mesh, cell);
    const unsigned bricks = window_size(window);
    unsigned *marks = shared + threadIdx.x / WARP * 2 * bricks;
    for (unsigned word = lane; word < 2 * bricks; word += WARP)
        marks[word] = 0;
    __syncwarp();
    const unsigned *seen = args.masks + index * WARP * mesh.words;
    for (unsigned k = lane; k < mesh.points; k += WARP) {
        if (seen[k] == 0)
            continue;
        const IVec3 point = cell + template_offset(mesh, k);
        const unsigned bit = point_bit(point);
        atomicOr(&marks[2 * window_place(window, point) + bit / 32], 1u << bit % 32);
    }
    __syncwarp();
    for (unsigned place = lane; place < bricks; place += WARP)
        args.marks[index * bricks + place] = (unsigned long long)marks[2 * place + 1] << 32 | marks[2 * place];
}

// Inserts a brick, and counts it if it is new. If the table is full, the count exceeds its capacity.
DEVICE void insert(const LightPoints &args, unsigned long long key) {
    const unsigned mask = args.table.capacity - 1;
    unsigned long long value = key + 1;
    unsigned slot = brick_hash(key) & mask;
    for (unsigned probes = 0; probes <= mask;) {
        const unsigned long long current = atomicAdd(&args.table.keys[slot], 0ull);
        if (current == value)
            return;
        if (current < value) {
            // Another thread may have been faster: then look again.
            if (atomicCAS(&args.table.keys[slot], current, value) != current)
                continue;
            if (current == 0) {
                atomicAdd(args.bricks, 1u);
                return;
            }
            value = current;
        }
        slot = (slot + 1) & mask;
        probes++;
    }
    atomicOr(args.bricks, 0x80000000u);
}

// A brick of the window around a bundle's cell.
struct WindowBrick {
    unsigned long long key;
    // Its points that the bundle's surface points use.
    unsigned long long points;
    // Its index among all of the launch's windows.
    unsigned long long index;
};

// The brick of a thread; `false` if there is none.
DEVICE bool brick_of_thread(const LightPoints &args, WindowBrick &brick) {
    const int side = window_side(args.mesh);
    const unsigned bricks = side * side * side;
    const unsigned number = blockIdx.x * blockDim.x + threadIdx.x;
    if (number >= args.bundle_count * bricks)
        return false;
    brick.index = args.first_bundle * bricks + number;
    brick.points = args.marks[brick.index];
    const IVec3 cell = point_of(args.bundles[args.first_bundle + number / bricks].cell);
    brick.key = window_key(window_around(args.mesh, cell), number % bricks);
    return true;
}

KERNEL(insert_bricks, LightPoints, BLOCK, 4) {
    // A table that is more than half full is abandoned: the host allocates a larger one.
    WindowBrick brick;
    if (*(volatile unsigned *)args.bricks <= args.table.capacity / 2 && brick_of_thread(args, brick) &&
        brick.points != 0)
        insert(args, brick.key);
}

KERNEL(mark_points, LightPoints, BLOCK, 4) {
    WindowBrick brick;
    if (!brick_of_thread(args, brick))
        return;
    const unsigned slot = brick.points != 0 ? find_slot(args.table, brick.key) : NO_SLOT;
    if (brick.points != 0)
        atomicOr(&args.used[slot], brick.points);
    args.slots[brick.index] = slot;
}

KERNEL(count_points, LightPoints, BLOCK, 4) {
    const unsigned slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot < args.table.capacity)
        args.rank[slot] = __popcll(args.used[slot]);
}

KERNEL(list_points, LightPoints, BLOCK, 4) {
    const unsigned slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot >= args.table.capacity)
        return;
    unsigned rank = args.rank[slot];
    for (unsigned long long rest = args.used[slot]; rest != 0; rest &= rest - 1)
        args.points[rank++] = (unsigned long long)slot << POINT_BITS | (__ffsll(rest) - 1);
}
