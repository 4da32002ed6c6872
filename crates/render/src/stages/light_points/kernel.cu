// Step 3 on a CUDA device: each light point that some object point uses, once. Formula (7).
//
// 1. `insert_bricks`: the bricks that hold a used point, in a table.
// 2. `mark_points`: the used points in each.
// 3. `count_points`, then a scan: ranks.
// 4. `list_points`: all of them.
//
// The table is an ordered one: whatever the order of insertion, a key lies at the same place (Shun, Blelloch: Phase-Concurrent Hash
// Tables for Determinism, SPAA 2014). A larger key has priority: it pushes smaller ones on.
#include "cuda/prelude.cuh"

#include "cuda/warp.cuh"
#include "light_mesh/window.cuh"

// Inserts a brick. Counts it if it is new; counts more than there can be where the table is full.
DEVICE void insert(const LightPoints &args, unsigned long long key) {
    const unsigned mask = args.table.capacity - 1;
    unsigned long long value = key + 1;
    unsigned slot = brick_hash(key) & mask;
    for (unsigned probes = 0; probes <= mask;) {
        const unsigned long long current = atomicAdd(&args.table.keys[slot], 0ull);
        if (current == value)
            return;
        if (current < value) {
            // Another thread may have been here first: then look again.
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

// Calls `mark` for each brick that a cell's object points use points of, with these points.
template <typename Mark>
DEVICE void each_brick(const LightPoints &args, const Mark &mark) {
    DYNAMIC_SHARED(unsigned, shared);
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const unsigned long long number = (unsigned long long)blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
    if (number >= args.item_count)
        return;
    const unsigned long long index = args.first_item + number;
    const IVec3 cell = point_of(args.items[index].cell);
    const Window window = window_around(mesh, cell);
    // Two words a brick: shared memory has no 64-bit "or" of its own.
    unsigned *marks = shared + threadIdx.x / 32 * 2 * window_size(window);
    for (int word = lane; word < 2 * window_size(window); word += 32)
        marks[word] = 0;
    __syncwarp();
    const unsigned *seen = args.masks + index * 32 * mesh.words;
    for (unsigned k = lane; k < mesh.points; k += 32) {
        if (seen[k] == 0)
            continue;
        const IVec3 offset = template_offset(mesh, k);
        const IVec3 point = {cell.x + offset.x, cell.y + offset.y, cell.z + offset.z};
        const unsigned bit = point_bit(point);
        atomicOr(&marks[2 * window_place(window, point) + bit / 32], 1u << bit % 32);
    }
    __syncwarp();
    for (int place = lane; place < window_size(window); place += 32) {
        const unsigned long long points = (unsigned long long)marks[2 * place + 1] << 32 | marks[2 * place];
        if (points != 0)
            mark(window_key(window, place), points);
    }
}

KERNEL(insert_bricks, LightPoints, 256, 4) {
    // A table that is more than half full is given up: the host makes a larger one. One lane asks for all, so that a warp goes on
    // together or not at all.
    const unsigned bricks = lane_of_thread() == 0 ? atomicAdd(args.bricks, 0u) : 0;
    if (__shfl_sync(ALL_LANES, bricks, 0) > args.table.capacity / 2)
        return;
    each_brick(args, [&](unsigned long long key, unsigned long long) { insert(args, key); });
}

KERNEL(mark_points, LightPoints, 256, 4) {
    each_brick(args, [&](unsigned long long key, unsigned long long points) {
        atomicOr(&args.used[find_slot(args.table, key)], points);
    });
}

KERNEL(count_points, LightPoints, 256, 4) {
    const unsigned slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot < args.table.capacity)
        args.rank[slot] = __popcll(args.used[slot]);
}

KERNEL(list_points, LightPoints, 256, 4) {
    const unsigned slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot >= args.table.capacity)
        return;
    unsigned rank = args.rank[slot];
    for (unsigned long long rest = args.used[slot]; rest != 0; rest &= rest - 1)
        args.points[rank++] = (unsigned long long)slot << 6 | (__ffsll(rest) - 1);
}
