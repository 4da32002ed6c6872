// The search for all triangles that meet a region through compressed wide nodes: twin of search.rs, where the margin is explained.
#pragma once

#include "accel/sieve.cuh"

// A search in progress: the nodes still to be entered.
struct BvhSearch {
    unsigned *stack;
    unsigned height;
};

// If the stack might grow beyond STACK_OF_ROUNDS, a round takes a single node. From then on it grows by at most seven entries per
// level, for which there is room.
DEVICE unsigned search_words(const Bvh &bvh) { return (STACK_OF_ROUNDS + STACK_PER_LEVEL * bvh.depth + 3) / 4 * 4; }

template <class Form>
DEVICE BvhSearch begin_search(const Bvh &bvh, const Region<Form> &, unsigned *memory) {
    if (lane_of_thread() == 0)
        memory[0] = 0;
    __syncwarp();
    return BvhSearch{memory, bvh.node_count != 0 ? 1u : 0u};
}

DEVICE bool goes_on(const Bvh &, const BvhSearch &search) { return search.height != 0; }

// Whether the region may meet the box of a slot.
template <class Form>
DEVICE bool meets_child(const Region<Form> &region, const BvhNode &node, unsigned slot) {
    const Vec3 extent = {__uint_as_float((unsigned)node.e[0] << 23), __uint_as_float((unsigned)node.e[1] << 23),
                         __uint_as_float((unsigned)node.e[2] << 23)};
    const Vec3 margin = BVH_MARGIN * (abs(node.p) + 256.0f * extent);
    const Vec3 low = node.p + extent * Vec3{(float)node.min_x[slot], (float)node.min_y[slot], (float)node.min_z[slot]} - margin;
    const Vec3 high = node.p + extent * Vec3{(float)node.max_x[slot], (float)node.max_y[slot], (float)node.max_z[slot]} + margin;
    return meets(region, low, high, 0.0f);
}

// One round: takes up to four nodes off the stack; each gets eight lanes, one per child.
template <bool SIEVED, class Form>
DEVICE void next_triangles(const Bvh &bvh, const Region<Form> &region, BvhSearch &search, unsigned *found, unsigned &count) {
    const unsigned lane = lane_of_thread(), slot = lane % 8;
    const unsigned taken = search.height + 4 * STACK_PER_LEVEL <= STACK_OF_ROUNDS ? min(search.height, 4u) : 1;
    search.height -= taken;
    bool inner = false;
    unsigned child = 0, first = 0, triangles = 0;
    if (lane / 8 < taken) {
        const BvhNode &node = bvh.nodes[search.stack[search.height + lane / 8]];
        const unsigned meta = node.meta[slot];
        if (meta != 0 && meets_child(region, node, slot)) {
            inner = node.imask >> slot & 1;
            child = node.child_base + __popc(node.imask & ((1u << slot) - 1));
            first = node.triangle_base + (meta & 31);
            triangles = inner ? 0 : __popc(meta >> 5);
        }
    }
    __syncwarp();
    warp_append(inner, child, search.stack, search.height);
    for (unsigned i = 0; i < 3; i++)
        sieve<SIEVED>(region, bvh.triangles, triangles > i, first + i, found, count);
    __syncwarp();
}
