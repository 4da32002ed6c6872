// The walk over compressed wide nodes: twin of walk.rs, where theory and margins are explained.
//
// One thread per ray. Nodes are loaded sixteen bytes at once; the eight boxes of a node are tested without branches. The stack
// of node groups lies in local memory.
#pragma once

#include "accel/visit.cuh"

// A ray prepared for the slab tests.
struct Slabs {
    Vec3 origin, inverse;
    // How far outside of a box the ray may pass and still count, in units of the margin.
    float slack;
    // The octant that the ray points into: traversal order is slot xor this.
    unsigned octant;
};

DEVICE Slabs slabs_of(Vec3 origin, Vec3 direction, float slack) {
    const Vec3 size = abs(direction);
    const float least = MIN_COMPONENT * max_element(size);
    const Vec3 inverse = {1.0f / copysignf(larger(size.x, least), direction.x),
                          1.0f / copysignf(larger(size.y, least), direction.y),
                          1.0f / copysignf(larger(size.z, least), direction.z)};
    const unsigned octant = (inverse.x >= 0.0f ? 4u : 0u) | (inverse.y >= 0.0f ? 2u : 0u) | (inverse.z >= 0.0f ? 1u : 0u);
    return Slabs{origin, inverse, slack / BVH_MARGIN, octant};
}

// A node's planes on one axis: bytes of four slots per word, in the order in which the ray crosses them.
struct Planes {
    unsigned near[2], far[2];
    // Ray parameter per step of the planes; where the ray crosses plane -PLANE_BIAS, with the margin.
    float scale, near_start, far_start;
};

// The float whose fraction counts in steps of 2^-7: with a byte b added to its bits 128 times it is PLANE_BIAS + b. That is
// cheaper than a conversion, and costs precision: the bias times the scale is rounded by 2^-8 of a step.
#define PLANE_BIAS 65536.0f
#define PLANE_BIAS_BITS 0x47800000u

// The sum of a number and the products of four pairs of bytes. NVRTC 12.0 knows the instruction by its PTX name alone.
DEVICE unsigned byte_products(unsigned a, unsigned b, unsigned sum) {
#if defined(__CUDACC__)
    unsigned result;
    asm("dp4a.u32.u32 %0, %1, %2, %3;" : "=r"(result) : "r"(a), "r"(b), "r"(sum));
    return result;
#else
    return __dp4a(a, b, sum);
#endif
}

// The byte in a slot of a word. The inner product of bytes runs alongside the comparisons, which are most of the work here.
DEVICE unsigned byte_of(unsigned bytes, unsigned slot) { return byte_products(bytes, 1u << 8 * slot, 0u); }

DEVICE Planes planes_of(const uint4 &bytes, unsigned exponent, float offset, float inverse, float margin) {
    const bool down = inverse < 0.0f;
    const float scale = __uint_as_float(exponent << 23) * inverse;
    const float start = fmaf(-PLANE_BIAS, scale, offset * inverse), reach = margin * fabsf(inverse);
    return Planes{{down ? bytes.z : bytes.x, down ? bytes.w : bytes.y},
                  {down ? bytes.x : bytes.z, down ? bytes.y : bytes.w},
                  scale, start - reach, start + reach};
}

// Where the ray crosses the plane in byte `slot` of a word.
DEVICE float plane_crossing(unsigned bytes, unsigned slot, float scale, float start) {
    return fmaf(__uint_as_float(byte_products(bytes, 128u << 8 * slot, PLANE_BIAS_BITS)), scale, start);
}

// The hit bits of a node and triangle group: inner nodes from bit 24 on in traversal order, the triangles of leaves below.
DEVICE unsigned child_hits(const Planes &x, const Planes &y, const Planes &z, const uint2 &meta, float limit, unsigned octant) {
    unsigned hits = 0;
    UNROLL
    for (int half = 0; half < 2; ++half) {
        // Inner nodes have index 24 + slot, which the octant reorders; leaves the index of their first triangle.
        const unsigned bytes = half == 0 ? meta.x : meta.y;
        const unsigned inner = (bytes & bytes << 1) >> 4 & 0x01010101u;
        const unsigned index = (bytes ^ (octant * 0x01010101u & inner * 0xffu)) & 0x1f1f1f1fu;
        const unsigned count = bytes >> 5 & 0x07070707u;
        UNROLL
        for (unsigned slot = 0; slot < 4; ++slot) {
            const float enter_x = plane_crossing(x.near[half], slot, x.scale, x.near_start);
            const float enter_y = plane_crossing(y.near[half], slot, y.scale, y.near_start);
            const float enter_z = plane_crossing(z.near[half], slot, z.scale, z.near_start);
            const float leave_x = plane_crossing(x.far[half], slot, x.scale, x.far_start);
            const float leave_y = plane_crossing(y.far[half], slot, y.scale, y.far_start);
            const float leave_z = plane_crossing(z.far[half], slot, z.scale, z.far_start);
            const float enter = fmaxf(fmaxf(enter_x, enter_y), fmaxf(enter_z, 0.0f));
            const float leave = fminf(fminf(leave_x, leave_y), fminf(leave_z, limit));
            const unsigned child = byte_of(count, slot) << byte_of(index, slot);
            hits |= enter <= leave ? child : 0;
        }
    }
    return hits;
}

// The siblings still to be entered, and the triangles to be tested, if a ray meets a node.
DEVICE void meet_node(const BvhNode *node, const Slabs &slabs, float limit, uint2 &nodes, Chosen &triangles) {
    const uint4 *words = reinterpret_cast<const uint4 *>(node);
    const uint4 frame = __ldg(words), links = __ldg(words + 1);

    // 1. The node's frame in units of the ray parameter. The margin is that of walk.rs plus the loss due to PLANE_BIAS:
    // computed for 2304 steps, it is 2^-8 steps larger than for 256.
    const Vec3 offset = Vec3{__uint_as_float(frame.x), __uint_as_float(frame.y), __uint_as_float(frame.z)} - slabs.origin;
    const unsigned ex = frame.w & 0xff, ey = frame.w >> 8 & 0xff, ez = frame.w >> 16 & 0xff;
    const float largest = fmaxf(fmaxf(fmaf(2304.0f, __uint_as_float(ex << 23), fabsf(offset.x)),
                                      fmaf(2304.0f, __uint_as_float(ey << 23), fabsf(offset.y))),
                                fmaf(2304.0f, __uint_as_float(ez << 23), fabsf(offset.z)));
    const float margin = (largest + slabs.slack) * BVH_MARGIN;
    const Planes x = planes_of(__ldg(words + 2), ex, offset.x, slabs.inverse.x, margin);
    const Planes y = planes_of(__ldg(words + 3), ey, offset.y, slabs.inverse.y, margin);
    const Planes z = planes_of(__ldg(words + 4), ez, offset.z, slabs.inverse.z, margin);

    // 2, 3. Which of its children does the ray meet?
    const unsigned hits = child_hits(x, y, z, uint2{links.z, links.w}, limit, slabs.octant);
    nodes = uint2{links.x, (hits & INNER_HITS) | frame.w >> 24};
    triangles = Chosen{links.y, hits & TRIANGLE_HITS};
}

// Takes the nearest node out of a group, and puts the rest of the group onto the stack.
DEVICE unsigned take_node(uint2 &nodes, unsigned octant, uint2 *stack, unsigned &height) {
    const unsigned bit = 31 - __clz(nodes.y), siblings = nodes.y;
    nodes.y &= ~(1u << bit);
    if (nodes.y > TRIANGLE_HITS)
        stack[height++] = nodes;
    const unsigned slot = (bit - FIRST_INNER) ^ octant;
    return nodes.x + __popc(siblings & ((1u << slot) - 1));
}

// Visits the triangles of all leaves whose boxes the ray meets between 0 and the visitor's limit, near octants first.
template <class Visitor>
DEVICE void walk_nodes(const Bvh &bvh, const Slabs &slabs, Visitor &visitor) {
    if (bvh.node_count == 0)
        return;
    uint2 stack[BVH_STACK];
    unsigned height = 0;
    // 1. Begin with the root, as if it were the only child in the slot entered first.
    uint2 nodes = {0, ROOT_HIT};
    while (true) {
        // 2. Take the nearest node out of its group; keep the rest for later.
        const unsigned node = take_node(nodes, slabs.octant, stack, height);

        // 3, 4. Which of its children does the ray meet? Test the triangles of those that are leaves.
        Chosen triangles;
        meet_node(bvh.nodes + node, slabs, limit(visitor), nodes, triangles);
        if (triangles.bits != 0 && !ask(visitor, bvh, triangles))
            return;

        // 5. No child left to enter: continue with the group most recently set aside.
        if (nodes.y <= TRIANGLE_HITS) {
            if (height == 0)
                return;
            nodes = stack[--height];
        }
    }
}

// Of the triangles chosen, those that are instances.
DEVICE unsigned held_among(const InstancedBvh &bvh, const Chosen &triangles) {
    unsigned held = 0;
    for (unsigned rest = triangles.bits; rest != 0; rest &= rest - 1)
        held |= held_by(bvh.triangles + (triangles.base + __ffs(rest) - 1)) != 0 ? rest & -rest : 0;
    return held;
}

// The ray in the coordinates of a shape. Its slack also covers what rounding moves: see instanced.rs.
DEVICE Slabs slabs_in(const Instanced *instance, Vec3 origin, Vec3 direction, float slack) {
    const float norm = __ldg(&instance->norm), far = norm * (max_element(abs(origin)) + __ldg(&instance->reach));
    const float within = norm * slack + INSTANCE_MARGIN * (far + __ldg(&instance->shift));
    return slabs_of(placed_point(instance->back, origin), placed_vector(instance->back, direction), within);
}

// The same in the scene's tree and in those of shapes. A thread is in one tree at a time, so that those of a warp walk on together.
template <class Visitor>
DEVICE void walk_instances(const InstancedBvh &bvh, Vec3 origin, Vec3 direction, float slack, Visitor &visitor) {
    if (bvh.node_count == 0)
        return;
    // The groups of the scene's tree lie below those of the shape, which begin at `floor`.
    uint2 stack[2 * BVH_STACK];
    unsigned height = 0, floor = 0;
    Slabs slabs = slabs_of(origin, direction, slack);
    // The place of the shape that the thread is in, and the instances of the same node that come after it.
    const Instanced *instance = nullptr;
    Chosen held = {0, 0};
    uint2 nodes = {0, ROOT_HIT};
    while (true) {
        // 2. Take the nearest node out of its group; keep the rest for later.
        const unsigned node = take_node(nodes, slabs.octant, stack, height);

        // 3, 4. Which of its children does the ray meet? Test the triangles of those that are leaves; set aside what has to wait for instances.
        Chosen triangles;
        meet_node(bvh.nodes + node, slabs, limit(visitor), nodes, triangles);
        if (instance == nullptr) {
            held = Chosen{triangles.base, held_among(bvh, triangles)};
            triangles.bits &= ~held.bits;
            if (held.bits != 0) {
                if (nodes.y > TRIANGLE_HITS)
                    stack[height++] = nodes;
                nodes.y = 0;
                floor = height;
            }
        }
        if (triangles.bits != 0 && !ask(visitor, Part{bvh, bvh.alpha_mask, instance}, triangles))
            return;

        // 5. No child left to enter: continue with the group most recently set aside, the next instance, or the scene.
        if (nodes.y > TRIANGLE_HITS)
            continue;
        unsigned next;
        if (height > floor) {
            nodes = stack[--height];
        } else if (take(held, next)) {
            instance = bvh.instances + (held_by(bvh.triangles + next) - 1);
            slabs = slabs_in(instance, origin, direction, slack);
            nodes = uint2{__ldg(&instance->root), ROOT_HIT};
        } else {
            if (height == 0)
                return;
            instance = nullptr;
            floor = 0;
            slabs = slabs_of(origin, direction, slack);
            nodes = stack[--height];
        }
    }
}

// Visits what comes as close as `slack` to the segment from `origin` along `direction`.
template <class Visitor>
DEVICE void walk_segment(const InstancedBvh &bvh, Vec3 origin, Vec3 direction, float slack, Visitor &visitor) {
    walk_instances(bvh, origin, direction, slack, visitor);
}

template <class Visitor>
DEVICE void walk_segment(const Bvh &bvh, Vec3 origin, Vec3 direction, float slack, Visitor &visitor) {
    walk_nodes(bvh, slabs_of(origin, direction, slack), visitor);
}

template <class Visitor>
DEVICE void walk(const InstancedBvh &bvh, const Tally &, const Ray &ray, Visitor &visitor) {
    walk_segment(bvh, ray.origin, ray.direction, 0.0f, visitor);
}

template <class Visitor>
DEVICE void walk(const Bvh &bvh, const Tally &, const Ray &ray, Visitor &visitor) {
    walk_segment(bvh, ray.origin, ray.direction, 0.0f, visitor);
}

DEVICE void walk_short(const InstancedBvh &bvh, Short &segment, float slack) {
    walk_segment(bvh, segment.test.origin, segment.direction, slack, segment);
}

DEVICE void walk_short(const Bvh &bvh, Short &segment, float slack) {
    walk_segment(bvh, segment.test.origin, segment.direction, slack, segment);
}
