// The search for triangles that can matter to an item, through the wide BVH.
#pragma once

#include "accel/triangle.cuh"
#include "stages/short_tests/memory.cuh"

// Whether the box of a slot may hold a triangle that matters: whether it comes within reach of the origins, on the upper side of a
// tangent plane.
DEVICE bool slot_matters(const LightMesh &mesh, const CellItem &item, const float4 *planes, const BvhNode &node, unsigned slot) {
    const Vec3 extent = {__uint_as_float((unsigned)node.e[0] << 23), __uint_as_float((unsigned)node.e[1] << 23),
                         __uint_as_float((unsigned)node.e[2] << 23)};
    const float reach = mesh.radius + mesh.slack;
    const Vec3 grown = BVH_MARGIN * (abs(node.p) + 256.0f * extent);
    const Vec3 low = node.p + extent * Vec3{(float)node.min_x[slot], (float)node.min_y[slot], (float)node.min_z[slot]} - grown;
    const Vec3 high = node.p + extent * Vec3{(float)node.max_x[slot], (float)node.max_y[slot], (float)node.max_z[slot]} + grown;
    const Vec3 apart = max(max(low - item.high, item.low - high), splat(0.0f));
    if (dot(apart, apart) > reach * reach)
        return false;
    bool above = item.planes == 0;
    for (unsigned i = 0; i < item.planes; i++) {
        const float4 plane = planes[i];
        // The corner that lies highest along the normal.
        const Vec3 top = {plane.x > 0.0f ? high.x : low.x, plane.y > 0.0f ? high.y : low.y, plane.z > 0.0f ? high.z : low.z};
        above |= dot(Vec3{plane.x, plane.y, plane.z}, top - item.low) >= plane.w - mesh.slack;
    }
    return above;
}

// 3. a. One round of the search for triangles in a region: takes up to four nodes off the stack, eight lanes each, one a child.
//
// Where the stack might grow beyond STACK_OF_ROUNDS, a round takes a single node. From then on it grows by seven entries a level
// at most, for which there is room.
DEVICE void next_nodes(const ShortTests &args, const CellItem &item, const CellMemory &memory, unsigned &height,
                       unsigned &found) {
    const Bvh &bvh = args.scene.bvh;
    const unsigned lane = lane_of_thread(), slot = lane % 8;
    const unsigned taken = height + 4 * STACK_PER_LEVEL <= STACK_OF_ROUNDS ? min(height, 4u) : 1;
    height -= taken;
    bool inner = false;
    unsigned child = 0, first = 0, triangles = 0;
    if (lane / 8 < taken) {
        const BvhNode &node = bvh.nodes[memory.stack[height + lane / 8]];
        const unsigned meta = node.meta[slot];
        if (meta != 0 && slot_matters(args.mesh, item, memory.planes, node, slot)) {
            inner = node.imask >> slot & 1;
            child = node.child_base + __popc(node.imask & ((1u << slot) - 1));
            first = node.triangle_base + (meta & 31);
            triangles = inner ? 0 : __popc(meta >> 5);
        }
    }
    __syncwarp();
    const unsigned entered = __ballot_sync(ALL_LANES, inner);
    if (inner)
        memory.stack[height + __popc(entered & lanes_below(lane))] = child;
    height += __popc(entered);
    for (unsigned i = 0; i < 3; i++) {
        const unsigned has = __ballot_sync(ALL_LANES, triangles > i);
        if (triangles > i)
            memory.found[found + __popc(has & lanes_below(lane))] = first + i;
        found += __popc(has);
    }
    __syncwarp();
}
