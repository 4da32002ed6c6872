// The search for all triangles that meet a region through compressed wide nodes: twin of search.rs, where the margin is explained.
#pragma once

#include "accel/region_filter.cuh"

// A search in progress: the nodes still to be entered. Those nearest to where the region begins are on top: what hides most is often near.
struct BvhSearch {
    unsigned *stack;
    unsigned height;
    // The octant that the region points into: in the order of slot xor this, near children come last.
    unsigned octant;
    // Children of nodes that were not looked at, node · 8 + slot, and their number.
    const unsigned *starts;
    unsigned start_count;
};

// If the stack might grow beyond STACK_OF_ROUNDS, a round takes a single node. From then on it grows by at most seven entries per
// level, for which there is room.
DEVICE unsigned search_words(const Bvh &bvh) { return (STACK_OF_ROUNDS + STACK_PER_LEVEL * bvh.depth + 3) / 4 * 4; }

template <class RegionShape>
DEVICE BvhSearch begin_search(const Bvh &bvh, const Region<RegionShape> &region, unsigned *memory) {
    if (lane_of_thread() == 0)
        memory[0] = 0;
    __syncwarp();
    return BvhSearch{memory, bvh.node_count != 0 ? 1u : 0u, octant_of(heading_of(region.shape)), memory, 0};
}

template <class RegionShape>
DEVICE BvhSearch begin_search_at(const Bvh &bvh, const Region<RegionShape> &region, unsigned *memory, const unsigned *starts,
                                 unsigned count) {
    return count == FROM_ROOT ? begin_search(bvh, region, memory)
                              : BvhSearch{memory, 0, octant_of(heading_of(region.shape)), starts, count};
}

DEVICE bool goes_on(const Bvh &, const BvhSearch &search) { return (search.height | search.start_count) != 0; }

// A slot of a node, loaded sixteen bytes at once.
struct Slot {
    // Content, as in the node; nothing if zero.
    unsigned meta;
    bool inner;
    // The node, or the first triangle.
    unsigned child, first;
    // The box, with its margin.
    Vec3 low, high;
};

// Byte number `slot` of two words.
DEVICE float plane_of_slot(unsigned a, unsigned b, unsigned slot) { return (float)(__byte_perm(a, b, slot) & 0xff); }

DEVICE Slot load_slot(const BvhNode *node, unsigned slot) {
    const uint4 *words = reinterpret_cast<const uint4 *>(node);
    const uint4 frame = __ldg(words), links = __ldg(words + 1), x = __ldg(words + 2), y = __ldg(words + 3), z = __ldg(words + 4);
    const Vec3 corner = {__uint_as_float(frame.x), __uint_as_float(frame.y), __uint_as_float(frame.z)};
    const Vec3 extent = {__uint_as_float(frame.w << 23 & F32_INFINITY_BITS), __uint_as_float(frame.w << 15 & F32_INFINITY_BITS),
                         __uint_as_float(frame.w << 7 & F32_INFINITY_BITS)};
    const Vec3 margin = BVH_MARGIN * (abs(corner) + 256.0f * extent);
    const unsigned nodes = frame.w >> 24;
    Slot result;
    result.meta = __byte_perm(links.z, links.w, slot) & 0xff;
    result.inner = nodes >> slot & 1;
    result.child = links.x + __popc(nodes & ((1u << slot) - 1));
    result.first = links.y + (result.meta & 31);
    const Vec3 low = corner - margin, high = corner + margin;
    result.low = Vec3{fmaf(extent.x, plane_of_slot(x.x, x.y, slot), low.x), fmaf(extent.y, plane_of_slot(y.x, y.y, slot), low.y),
                      fmaf(extent.z, plane_of_slot(z.x, z.y, slot), low.z)};
    result.high = Vec3{fmaf(extent.x, plane_of_slot(x.z, x.w, slot), high.x), fmaf(extent.y, plane_of_slot(y.z, y.w, slot), high.y),
                       fmaf(extent.z, plane_of_slot(z.z, z.w, slot), high.z)};
    return result;
}

// Whether there is something in a slot that the region may meet.
template <class RegionShape>
DEVICE bool meets_slot(const Region<RegionShape> &region, const Slot &slot) {
    return slot.meta != 0 && meets(region, slot.low, slot.high, 0.0f);
}

// What a lane does in a round: looks at a slot of a node.
struct Turn {
    bool active;
    // The slot is one of the starts; otherwise the node was at `entry` of the stack, and the slot is yet to be put in order.
    bool begins;
    unsigned number, slot, entry;
};

// Takes up to four nodes off the stack, if that leaves it so short that they may add to it what they will, otherwise one; each gets
// eight lanes, one per child. Or takes up to 32 starts, while the stack is so short that it holds them.
template <class Search>
DEVICE Turn next_turn(Search &search, unsigned tallest) {
    const unsigned lane = lane_of_thread();
    Turn turn = {false, search.start_count != 0 && search.height < 4, 0, lane % 8, 0};
    if (turn.begins) {
        const unsigned taken = min(search.start_count, WARP);
        search.start_count -= taken;
        turn.active = lane < taken;
        const unsigned start = search.starts[search.start_count + (turn.active ? lane : 0)] & ~LEAF_START;
        turn.number = start / 8;
        turn.slot = start % 8;
    } else {
        const unsigned taken = search.height <= tallest ? min(search.height, 4u) : 1;
        search.height -= taken;
        turn.active = lane / 8 < taken;
        turn.entry = search.height + lane / 8;
        if (turn.active)
            turn.number = search.stack[turn.entry];
    }
    return turn;
}

// One round of a search.
template <bool FILTERED, class RegionShape>
DEVICE void next_triangles(const Bvh &bvh, const Region<RegionShape> &region, BvhSearch &search, unsigned *found, unsigned &count) {
    const Turn turn = next_turn(search, STACK_OF_ROUNDS - 4 * STACK_PER_LEVEL);
    const unsigned slot = turn.begins ? turn.slot : turn.slot ^ search.octant;
    bool inner = false;
    unsigned child = 0, first = 0, triangles = 0;
    if (turn.active) {
        const Slot box = load_slot(bvh.nodes + turn.number, slot);
        if (meets_slot(region, box)) {
            inner = box.inner;
            child = box.child;
            first = box.first;
            triangles = inner ? 0 : __popc(box.meta >> 5);
        }
    }
    __syncwarp();
    warp_append(inner, child, search.stack, search.height);
    for (unsigned i = 0; i < 3; i++)
        filter_by_region<FILTERED>(region, bvh.triangles + (first + i), triangles > i, first + i, found, count);
    __syncwarp();
}

// A search in the scene's tree and in those of shapes: with each node, whose tree it is of.
struct InstancedSearch {
    unsigned *stack;
    // By entry of the stack: the number of an instance, from 1, or 0 for the scene's tree.
    unsigned *owners;
    unsigned height;
    const unsigned *starts;
    unsigned start_count;
};

// A node adds at most as many instances as its leaves hold. They are taken off the stack before other nodes of the scene's tree.
DEVICE unsigned entries_of_search(const InstancedBvh &bvh) {
    return STACK_OF_INSTANCES + MAX_HELD + (STACK_PER_LEVEL * bvh.depth + 3) / 4 * 4;
}

DEVICE unsigned search_words(const InstancedBvh &bvh) { return 2 * entries_of_search(bvh); }

template <class RegionShape>
DEVICE InstancedSearch begin_search(const InstancedBvh &bvh, const Region<RegionShape> &, unsigned *memory) {
    unsigned *owners = memory + entries_of_search(bvh);
    if (lane_of_thread() == 0)
        memory[0] = owners[0] = 0;
    __syncwarp();
    return InstancedSearch{memory, owners, bvh.node_count != 0 ? 1u : 0u, memory, 0};
}

template <class RegionShape>
DEVICE InstancedSearch begin_search_at(const InstancedBvh &bvh, const Region<RegionShape> &region, unsigned *memory,
                                       const unsigned *starts, unsigned count) {
    if (count == FROM_ROOT)
        return begin_search(bvh, region, memory);
    return InstancedSearch{memory, memory + entries_of_search(bvh), 0, starts, count};
}

DEVICE bool goes_on(const InstancedBvh &, const InstancedSearch &search) { return (search.height | search.start_count) != 0; }

// Takes the box of a slot to where a shape is: twin of `placed` in search.rs.
DEVICE void place_slot(const Instanced *instance, Slot &slot) {
    const Vec3 half = 0.5f * (slot.high - slot.low), middle = 0.5f * (slot.high + slot.low), far = abs(middle) + half;
    const float4 x = load_row(instance->place, 0), y = load_row(instance->place, 1), z = load_row(instance->place, 2);
    const Vec3 rows[3] = {Vec3{x.x, x.y, x.z}, Vec3{y.x, y.y, y.z}, Vec3{z.x, z.y, z.z}}, shift = {x.w, y.w, z.w};
    const Vec3 center = Vec3{dot(rows[0], middle), dot(rows[1], middle), dot(rows[2], middle)} + shift;
    const Vec3 terms = Vec3{dot(abs(rows[0]), far), dot(abs(rows[1]), far), dot(abs(rows[2]), far)} + abs(shift);
    const Vec3 reach = Vec3{dot(abs(rows[0]), half), dot(abs(rows[1]), half), dot(abs(rows[2]), half)} + INSTANCE_MARGIN * terms;
    slot.low = center - reach;
    slot.high = center + reach;
}

// The same round; what is held in the scene's leaves goes onto the stack, the nodes of shapes with the numbers of their places.
template <bool FILTERED, class RegionShape>
DEVICE void next_triangles(const InstancedBvh &bvh, const Region<RegionShape> &region, InstancedSearch &search, unsigned *found,
                           unsigned &count) {
    const Turn turn = next_turn(search, STACK_OF_INSTANCES - 4 * MAX_HELD);
    const unsigned owner = turn.active && !turn.begins ? search.owners[turn.entry] : 0;
    const Instanced *instance = owner != 0 ? bvh.instances + (owner - 1) : nullptr;
    const Vec3 heading = heading_of(region.shape);
    const unsigned octant = octant_of(instance != nullptr ? placed_vector(instance->back, heading) : heading);
    const unsigned slot = turn.begins ? turn.slot : turn.slot ^ octant;
    bool inner = false;
    unsigned child = 0, first = 0, triangles = 0;
    if (turn.active) {
        Slot box = load_slot(bvh.nodes + turn.number, slot);
        if (instance != nullptr)
            place_slot(instance, box);
        if (meets_slot(region, box)) {
            inner = box.inner;
            child = box.child;
            first = box.first;
            triangles = inner ? 0 : __popc(box.meta >> 5);
        }
    }
    __syncwarp();
    unsigned owned = search.height;
    warp_append(inner, owner, search.owners, owned);
    warp_append(inner, child, search.stack, search.height);
    for (unsigned i = 0; i < 3; i++) {
        const bool has = triangles > i;
        const Triangle *stored = bvh.triangles + (first + i);
        const unsigned held = has && instance == nullptr ? held_by(stored) : 0;
        const bool enters = held != 0 && meets_triangle(region, load_corners(stored));
        owned = search.height;
        warp_append(enters, held, search.owners, owned);
        warp_append(enters, enters ? __ldg(&bvh.instances[held - 1].root) : 0, search.stack, search.height);
        const unsigned place = has ? noted_place(Part{bvh, bvh.alpha_mask, instance}, first + i) : 0;
        filter_by_region<FILTERED>(region, Placed{stored, instance}, has && held == 0, place, found, count);
    }
    __syncwarp();
}

// Finds up to MAX_SEARCH_ROOTS boxes that hold all triangles that a region may meet: the root's children, then, as long as there is room,
// children in place of their parents. Returns their number. `list` has twice WARP words.
template <class Tree, class RegionShape>
DEVICE unsigned find_starts_in(const Tree &bvh, const Region<RegionShape> &region, unsigned *list) {
    const unsigned lane = lane_of_thread(), slot = lane % 8;
    // A start holds a node's number in 28 bits.
    if (bvh.node_count >> 28 != 0)
        return FROM_ROOT;
    unsigned count = 0;
    // The places of up to four boxes that are replaced by their children, and the nodes there.
    unsigned opened = 0, node = 0;
    unsigned long long places = 0;
    bool begins = bvh.node_count != 0;
    while (begins || opened != 0) {
        const bool active = lane / 8 < (begins ? 1 : opened);
        bool met = false, leaf = false;
        if (active) {
            const Slot box = load_slot(bvh.nodes + node, slot);
            met = meets_slot(region, box);
            leaf = !box.inner;
        }
        if (count - opened + __popc(__ballot_sync(ALL_LANES, met)) > MAX_SEARCH_ROOTS)
            return count;
        // Close the gaps and append the children.
        const unsigned low = list[lane], high = list[WARP + lane], before = count;
        __syncwarp();
        count = 0;
        warp_append(lane < before && !(places >> lane & 1), low, list, count);
        warp_append(WARP + lane < before && !(places >> (WARP + lane) & 1), high, list, count);
        warp_append(met, node * 8 + slot + (leaf ? LEAF_START : 0), list, count);
        __syncwarp();
        // The next boxes: the first that are nodes.
        unsigned long long rest = __ballot_sync(ALL_LANES, lane < count && !(list[lane] & LEAF_START)) |
                                  (unsigned long long)__ballot_sync(ALL_LANES, WARP + lane < count && !(list[WARP + lane] & LEAF_START)) << WARP;
        begins = false;
        places = 0;
        for (opened = 0; opened < 4 && rest != 0; ++opened, rest &= rest - 1) {
            const unsigned place = __ffsll(rest) - 1;
            places |= 1ull << place;
            if (lane / 8 == opened)
                node = load_slot(bvh.nodes + list[place] / 8, list[place] % 8).child;
        }
    }
    return count;
}

// Puts the starts of a shaft in order, the nearest last: a search takes those first.
template <class Tree, class RegionShape>
DEVICE unsigned sorted_starts(const Tree &bvh, const Region<RegionShape> &region, unsigned *list, unsigned count) {
    if (!RegionShape::SLANTED || count == FROM_ROOT)
        return count;
    const unsigned lane = lane_of_thread();
    const Vec3 heading = heading_of(region.shape);
    unsigned own[2] = {0, 0}, ranks[2] = {0, 0};
    float ways[2] = {0.0f, 0.0f};
    UNROLL
    for (unsigned half = 0; half < 2; ++half) {
        if (half * WARP + lane >= count)
            continue;
        own[half] = list[half * WARP + lane];
        const unsigned start = own[half] & ~LEAF_START;
        const Slot box = load_slot(bvh.nodes + start / 8, start % 8);
        // A number in any case.
        ways[half] = fminf(fmaxf(dot(heading, box.low + box.high), -F32_MAX), F32_MAX);
    }
    for (unsigned other = 0; other < count; ++other) {
        const float low = __shfl_sync(ALL_LANES, ways[0], other % WARP), high = __shfl_sync(ALL_LANES, ways[1], other % WARP);
        const float way = other < WARP ? low : high;
        UNROLL
        for (unsigned half = 0; half < 2; ++half)
            ranks[half] += way > ways[half] || (way == ways[half] && other < half * WARP + lane) ? 1 : 0;
    }
    __syncwarp();
    UNROLL
    for (unsigned half = 0; half < 2; ++half)
        if (half * WARP + lane < count)
            list[ranks[half]] = own[half];
    __syncwarp();
    return count;
}

template <class RegionShape>
DEVICE unsigned find_starts(const Bvh &bvh, const Region<RegionShape> &region, unsigned *list) {
    return sorted_starts(bvh, region, list, find_starts_in(bvh, region, list));
}

// In the scene's tree.
template <class RegionShape>
DEVICE unsigned find_starts(const InstancedBvh &bvh, const Region<RegionShape> &region, unsigned *list) {
    return sorted_starts(bvh, region, list, find_starts_in(bvh, region, list));
}
