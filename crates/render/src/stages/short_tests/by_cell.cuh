// The short tests by cell, a warp for up to 32 object points: twin of cells.rs (which triangles can matter, each with the box of
// light points that its shadow can reach) and batch.rs (lanes are object points; triangle and light point are the same for all).
#pragma once

#include "accel/triangle.cuh"
#include "cuda/rays.cuh"
#include "cuda/tally.cuh"
#include "cuda/warp.cuh"
#include "light_mesh/bricks.cuh"
#include "light_mesh/lattice.cuh"
#include "light_mesh/template.cuh"
#include "stages/short_tests/masks.cuh"
#include "surface.cuh"

// Tangent planes that are told apart.
#define TANGENT_PLANES 4
// Triangles found and not yet looked at: fewer than 32, and at most 96 that one round of the search adds.
#define FOUND_TRIANGLES 128u
// Entries of the search's stack up to which rounds take four nodes, and those kept for each level of the tree: see `next_nodes`.
#define STACK_OF_ROUNDS 64
#define STACK_PER_LEVEL 7

// Points that are tested in one go.
#define LISTED_TARGETS 64u
// What comes after the last of them.
#define NO_TARGET 0xffffffffu

// A triangle that can matter: its corners, and all q - P with q on it and P an origin of the item.
struct Candidate {
    // The unused parts: the packed box of light points that it can hide, then low and high x of q - P.
    float4 corners[3];
    // Low and high y, low and high z; and their reciprocals.
    float4 span_yz, inverse_yz;
    // The farthest that its shadow is stretched, and the reciprocal of the number of lines in a plane of its box.
    float4 most;
};

// A light point that a candidate may hide: its position, and packed its template point and its candidate.
typedef float4 Target;

// The shared memory of one warp.
struct CellMemory {
    // For each template point the lanes that see it. In global memory where the template is too large.
    unsigned *seen;
    Candidate *candidates;
    Target *targets;
    // Normals, and how high the lowest origin lies along each above the corner of the box around all.
    float4 *planes;
    unsigned *found;
    unsigned *stack;
};

// The object points of an item, one a lane.
struct CellLane {
    SurfacePoint point;
    // Whether the lane has an object point.
    bool alive;
};

// What is the same for the whole warp.
struct CellItem {
    IVec3 cell;
    // The box around all origins.
    Vec3 low, high;
    // 1 / h.
    float inverse_step;
    // Tangent planes: how many there are, at most TANGENT_PLANES; 0 where there are more.
    unsigned planes;
};

DEVICE CellItem cell_item(const LightMesh &mesh, const Item &item, const CellLane &lane, float4 *planes) {
    CellItem result;
    result.cell = point_of(item.cell);
    const float far = 3.4e38f;
    const Vec3 &origin = lane.point.origin, &normal = lane.point.normal;
    result.low = Vec3{warp_min(lane.alive ? origin.x : far), warp_min(lane.alive ? origin.y : far),
                      warp_min(lane.alive ? origin.z : far)};
    result.high = Vec3{warp_max(lane.alive ? origin.x : -far), warp_max(lane.alive ? origin.y : -far),
                       warp_max(lane.alive ? origin.z : -far)};
    result.inverse_step = 1.0f / mesh.step;
    // Object points of one normal have one tangent plane: that through the lowest of their origins.
    unsigned rest = __ballot_sync(ALL_LANES, lane.alive);
    for (result.planes = 0; rest != 0 && result.planes < TANGENT_PLANES; result.planes++) {
        const unsigned leader = __ffs(rest) - 1;
        const Vec3 shared = warp_broadcast(normal, leader);
        const bool same = lane.alive && normal == shared;
        const float lowest = warp_min(same ? dot(shared, origin - result.low) : far);
        if (lane_of_thread() == 0)
            planes[result.planes] = float4{shared.x, shared.y, shared.z, lowest};
        rest &= ~__ballot_sync(ALL_LANES, same);
    }
    if (rest != 0)
        result.planes = 0;
    __syncwarp();
    return result;
}

// What formula (2) makes of one lane's object point and a light point: conditions 1 and 2.
DEVICE bool in_half_ball(const LightMesh &mesh, const SurfacePoint &point, const Vec3 &light_point) {
    const Vec3 d = light_point - point.position;
    return (d.z * d.z + d.y * d.y) + d.x * d.x < mesh.radius * mesh.radius && dot_along_x(point.normal, d) > mesh.least_height;
}

// An interval.
struct Span {
    float low, high;
};

DEVICE Span operator+(const Span &a, const Span &b) { return Span{a.low + b.low, a.high + b.high}; }

DEVICE Span operator*(const Span &a, const Span &b) {
    const float ll = a.low * b.low, lh = a.low * b.high, hl = a.high * b.low, hh = a.high * b.high;
    return Span{fminf(fminf(ll, lh), fminf(hl, hh)), fmaxf(fmaxf(ll, lh), fmaxf(hl, hh))};
}

DEVICE Span squared(const Span &a) {
    const float least = fmaxf(fmaxf(a.low, -a.high), 0.0f), most = fmaxf(-a.low, a.high);
    return Span{least * least, most * most};
}

// All values of a lane's variable over the warp.
DEVICE Span warp_span(float value) { return Span{warp_min(value), warp_max(value)}; }

// 1, 2. The half-balls: conditions 1 and 2 of formula (2). Returns how many light points the lane's has.
//
// Lanes take a light point each and bound the two conditions over all object points of the item. Few light points are left that some
// object points use and others do not: the warp asks all for those. Rounding is monotonic and the bounds follow the order of
// operations of `in_half_ball`, so they hold bit by bit.
DEVICE unsigned half_balls(const LightMesh &mesh, const CellItem &item, const CellLane &lane, unsigned *seen) {
    const SurfacePoint &point = lane.point;
    const Span x = warp_span(point.position.x), y = warp_span(point.position.y), z = warp_span(point.position.z);
    Span nx = {point.normal.x, point.normal.x}, ny = {point.normal.y, point.normal.y}, nz = {point.normal.z, point.normal.z};
    if (item.planes != 1) {
        nx = warp_span(point.normal.x);
        ny = warp_span(point.normal.y);
        nz = warp_span(point.normal.z);
    }
    const float square = mesh.radius * mesh.radius;
    const unsigned alive = __ballot_sync(ALL_LANES, lane.alive);
    unsigned size = 0;
    for (unsigned first = 0; first < 32 * mesh.words; first += 32) {
        const unsigned k = first + lane_of_thread();
        bool all = false, some = false;
        Vec3 light_point = {};
        if (k < mesh.points) {
            light_point = lattice_point(mesh, item.cell + template_offset(mesh, k));
            const Span dx = {light_point.x - x.high, light_point.x - x.low}, dy = {light_point.y - y.high, light_point.y - y.low},
                       dz = {light_point.z - z.high, light_point.z - z.low};
            const Span distance = (squared(dz) + squared(dy)) + squared(dx), height = (nz * dz + ny * dy) + nx * dx;
            all = distance.high < square && height.low > mesh.least_height;
            some = !all && distance.low < square && height.high > mesh.least_height;
        }
        unsigned lanes = all ? alive : 0;
        size += __popc(__ballot_sync(ALL_LANES, all));
        for (unsigned rest = __ballot_sync(ALL_LANES, some); rest != 0; rest &= rest - 1) {
            const unsigned owner = __ffs(rest) - 1;
            const Vec3 asked = warp_broadcast(light_point, owner);
            const bool inside = lane.alive && in_half_ball(mesh, point, asked);
            const unsigned users = __ballot_sync(ALL_LANES, inside);
            size += inside;
            lanes = lane_of_thread() == owner ? users : lanes;
        }
        seen[k] = lanes;
    }
    return lane.alive ? size : 0;
}

// Whether the box of a slot may hold a triangle that matters: whether it comes within reach of the origins, on the upper side of a
// tangent plane.
DEVICE bool slot_matters(const LightMesh &mesh, const CellItem &item, const float4 *planes, const BvhNode &node, unsigned slot) {
    const Vec3 extent = {__uint_as_float((unsigned)node.e[0] << 23), __uint_as_float((unsigned)node.e[1] << 23),
                         __uint_as_float((unsigned)node.e[2] << 23)};
    // Rounding of a plane is far below this.
    const float margin = 1.9073486e-6f, reach = mesh.radius + mesh.slack;
    const Vec3 grown = margin * (abs(node.p) + 256.0f * extent);
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

// One round of the search for triangles in a region: takes up to four nodes off the stack, eight lanes each, one a child.
//
// Where the stack might grow beyond STACK_OF_ROUNDS, a round takes a single node. From then on it grows by seven entries a level
// at most, for which there is room.
DEVICE void next_nodes(const ShortTests &args, const CellItem &item, const CellMemory &memory, unsigned &height,
                       unsigned &found) {
    const Bvh &bvh = args.scene.bvh;
    const unsigned lane = lane_of_thread(), slot = lane % 8;
    const unsigned taken = height + 28 <= STACK_OF_ROUNDS ? min(height, 4u) : 1;
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

// Whether the plane of a triangle comes nearer than `reach` to the box around the origins.
DEVICE bool plane_is_near(const CellItem &item, const Vec3 &a, const Vec3 &b, const Vec3 &c, float reach) {
    const Vec3 normal = cross(b - a, c - a);
    const Vec3 center = 0.5f * (item.low + item.high), extent = item.high - item.low;
    const float apart = fabsf(dot(normal, center - a)) - 0.5f * dot(abs(normal), extent);
    return apart <= 0.0f || apart * apart <= reach * reach * dot(normal, normal);
}

// Whether a triangle certainly lies on or behind the tangent planes of all object points.
DEVICE bool is_behind(const CellItem &item, const float4 *planes, const Vec3 &a, const Vec3 &b, const Vec3 &c) {
    bool behind = item.planes != 0;
    const Vec3 from_a = a - item.low, from_b = b - item.low, from_c = c - item.low, extent = item.high - item.low;
    const Vec3 size = max(max(abs(from_a), abs(from_b)), abs(from_c)) + extent;
    for (unsigned i = 0; i < item.planes; i++) {
        const Vec3 normal = {planes[i].x, planes[i].y, planes[i].z};
        // Relative to the box, so that rounding is of the size of the box and the triangle: 8 ε bounds that of both products.
        const float top = fmaxf(fmaxf(dot(normal, from_a), dot(normal, from_b)), dot(normal, from_c));
        behind &= top + 8.0f / 16777216.0f * dot(abs(normal), size) < planes[i].w;
    }
    return behind;
}

// One axis of the box of light points, as offsets from the cell, that a triangle can hide from the item's object points: see
// `shadow_box` in cells.rs. `most` is the farthest that a shadow is stretched.
DEVICE Span span_to(float low, float high, float a, float b, float c, float slack) {
    return Span{fminf(fminf(a, b), c) - high - slack, fmaxf(fmaxf(a, b), c) - low + slack};
}

// How far all q - P are from zero, at least.
DEVICE float distance_apart(const Span &x, const Span &y, const Span &z) {
    const Vec3 apart = {fmaxf(fmaxf(x.low, -x.high), 0.0f), fmaxf(fmaxf(y.low, -y.high), 0.0f),
                        fmaxf(fmaxf(z.low, -z.high), 0.0f)};
    return sqrtf(dot(apart, apart));
}

// The largest s for which s (q - P) can be within reach; boundless where the triangle may touch an origin.
DEVICE float most_stretch(float apart, float reach) { return apart > reach * 1e-20f ? reach / apart : 1e20f; }

DEVICE void stretch(Span &span, float most, float reach) {
    if (span.low < 0.0f)
        span.low = fmaxf(most * span.low, -reach);
    if (span.high > 0.0f)
        span.high = fminf(most * span.high, reach);
}

// The light points of a span on one axis: offsets from the cell, at least 1 - reach, at most reach.
DEVICE void span_in_steps(const LightMesh &mesh, float inverse_step, const Span &span, float low, float high, float origin,
                          int cell, int &first, int &last) {
    const float corner = lattice_coordinate(origin, mesh.step, cell);
    first = max(__float2int_ru((low + span.low - mesh.slack - corner) * inverse_step), 1 - mesh.reach);
    last = min(__float2int_rd((high + span.high + mesh.slack - corner) * inverse_step), mesh.reach);
}

// The box of light points that a triangle can hide, packed: six numbers of five bits, each offset + 15; `false` where there is none.
DEVICE bool shadow_box(const LightMesh &mesh, const CellItem &item, const Vec3 &a, const Vec3 &b, const Vec3 &c, unsigned &box,
                       Span &own_x, Span &own_y, Span &own_z, float &most) {
    const float reach = mesh.radius + mesh.slack;
    // 1. All q - P.
    Span x = span_to(item.low.x, item.high.x, a.x, b.x, c.x, mesh.slack);
    Span y = span_to(item.low.y, item.high.y, a.y, b.y, c.y, mesh.slack);
    Span z = span_to(item.low.z, item.high.z, a.z, b.z, c.z, mesh.slack);
    own_x = x;
    own_y = y;
    own_z = z;
    // 2. All s (q - P) within the ball. A boundless s leaves the ball's own box.
    const float apart = distance_apart(x, y, z);
    if (apart > reach)
        return false;
    most = most_stretch(apart, reach);
    stretch(x, most, reach);
    stretch(y, most, reach);
    stretch(z, most, reach);
    // 3. In steps from the cell.
    int x0, x1, y0, y1, z0, z1;
    span_in_steps(mesh, item.inverse_step, x, item.low.x, item.high.x, mesh.origin.x, item.cell.x, x0, x1);
    span_in_steps(mesh, item.inverse_step, y, item.low.y, item.high.y, mesh.origin.y, item.cell.y, y0, y1);
    span_in_steps(mesh, item.inverse_step, z, item.low.z, item.high.z, mesh.origin.z, item.cell.z, z0, z1);
    box = (unsigned)(x0 + 15) | (unsigned)(x1 + 15) << 5 | (unsigned)(y0 + 15) << 10 | (unsigned)(y1 + 15) << 15 |
          (unsigned)(z0 + 15) << 20 | (unsigned)(z1 + 15) << 25;
    return x0 <= x1 && y0 <= y1 && z0 <= z1;
}

// A number of a packed box.
DEVICE int box_bound(unsigned box, int index) {
    return (int)(box >> 5 * index & 31) - 15;
}

DEVICE Vec3 corner_of(const float4 &corner) { return Vec3{corner.x, corner.y, corner.z}; }

// 3. a. Lanes take up to 32 of the triangles found; those that can matter are kept as candidates. Returns how many rows of
// light points the lane's candidate reaches, candidates being in the order of the lanes; `count` becomes their number.
DEVICE unsigned choose_candidates(const ShortTests &args, const CellItem &item, const CellMemory &memory, unsigned first,
                                  unsigned &count) {
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    bool kept = false;
    unsigned box = 0;
    Corners corners;
    Span x, y, z;
    float most = 0.0f;
    if (lane < count) {
        corners = load_corners(args.scene.bvh.triangles + memory.found[first + lane]);
        const Vec3 a = corners.a, b = corners.b, c = corners.c;
        kept = !is_behind(item, memory.planes, a, b, c) && plane_is_near(item, a, b, c, mesh.radius + mesh.slack) &&
               shadow_box(mesh, item, a, b, c, box, x, y, z, most);
    }
    const unsigned lanes = __ballot_sync(ALL_LANES, kept);
    if (kept) {
        const Vec3 a = corners.a, b = corners.b, c = corners.c;
        Candidate &candidate = memory.candidates[__popc(lanes & lanes_below(lane))];
        candidate.corners[0] = float4{a.x, a.y, a.z, __uint_as_float(box)};
        candidate.corners[1] = float4{b.x, b.y, b.z, x.low};
        candidate.corners[2] = float4{c.x, c.y, c.z, x.high};
        candidate.span_yz = float4{y.low, y.high, z.low, z.high};
        candidate.inverse_yz = float4{1.0f / y.low, 1.0f / y.high, 1.0f / z.low, 1.0f / z.high};
        candidate.most = float4{most, 1.0f / (float)(box_bound(box, 3) - box_bound(box, 2) + 1), 0.0f, 0.0f};
    }
    __syncwarp();
    count = __popc(lanes);
    if (lane >= count)
        return 0;
    box = __float_as_uint(memory.candidates[lane].corners[0].w);
    return (box_bound(box, 3) - box_bound(box, 2) + 1) * (box_bound(box, 5) - box_bound(box, 4) + 1);
}

// Narrows the range of s to where s [low, high] can meet [from, to]. The reciprocals stand for divisions.
DEVICE void narrow(float low, float high, float inverse_low, float inverse_high, float from, float to, float &least, float &most) {
    // s high >= from. No branches: lanes differ.
    const float at_high = from * inverse_high, at_low = to * inverse_low;
    least = from > 0.0f ? (high > 0.0f ? fmaxf(least, at_high) : 1e30f) : least;
    most = from <= 0.0f && high < 0.0f ? fminf(most, at_high) : most;
    // s low <= to.
    least = to < 0.0f ? (low < 0.0f ? fmaxf(least, at_low) : 1e30f) : least;
    most = to >= 0.0f && low > 0.0f ? fminf(most, at_low) : most;
}

// The light points of one row that a candidate may hide and that some lane still sees: one bit each, from the row's first point.
//
// A hidden light point lies at P + s (q - P) with s >= 1 (`shadow_box` in cells.rs). Its y and z, which the row knows, narrow s; that
// narrows its x.
DEVICE unsigned row_targets(const LightMesh &mesh, const CellItem &item, const Candidate &candidate, float py, float pz,
                            unsigned bit, int count, int x, const unsigned *seen) {
    const float4 yz = candidate.span_yz, inverse = candidate.inverse_yz;
    float least = 1.0f, most = candidate.most.x;
    narrow(yz.x, yz.y, inverse.x, inverse.y, py - item.high.y - mesh.slack, py - item.low.y + mesh.slack, least, most);
    narrow(yz.z, yz.w, inverse.z, inverse.w, pz - item.high.z - mesh.slack, pz - item.low.z + mesh.slack, least, most);
    // Products are rounded, by far less than this.
    if (least > most * 1.000001f)
        return 0;
    const float low_x = candidate.corners[1].w, high_x = candidate.corners[2].w;
    const Span reached = {fminf(least * low_x, most * low_x), fmaxf(least * high_x, most * high_x)};
    int first, last;
    span_in_steps(mesh, item.inverse_step, reached, item.low.x, item.high.x, mesh.origin.x, item.cell.x, first, last);
    first = max(first - x, 0);
    last = min(last - x, count - 1);
    unsigned targets = 0;
    for (int i = first; i <= last; i++)
        targets |= seen[bit + i] != 0 ? 1u << i : 0;
    return targets;
}

// Whether a triangle may stand between a light point and an object point of the item: whether the light point, looking through the
// triangle, sees any of the box around the origins beyond it.
DEVICE bool may_hide(const LightMesh &mesh, const CellItem &item, const Candidate &candidate, const Vec3 &target) {
    const Vec3 a = corner_of(candidate.corners[0]) - target, b = corner_of(candidate.corners[1]) - target,
               c = corner_of(candidate.corners[2]) - target;
    const Vec3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b), all = bc + ca + ab;
    const float volume = dot(a, bc), sign = volume < 0.0f ? -1.0f : 1.0f;
    const Vec3 middle = 0.5f * (item.low + item.high) - target, half = 0.5f * (item.high - item.low) + splat(mesh.slack);
    // The largest products of three lengths that are rounded below and in the test itself, which begins at the other end.
    const float reach = mesh.radius + mesh.slack, size = max_element(max(max(abs(a), abs(b)), abs(c))) + reach;
    const float rounding = 128.0f / 16777216.0f * size * size * reach;
    return sign * dot(bc, middle) + dot(abs(bc), half) + rounding >= 0.0f &&
           sign * dot(ca, middle) + dot(abs(ca), half) + rounding >= 0.0f &&
           sign * dot(ab, middle) + dot(abs(ab), half) + rounding >= 0.0f &&
           sign * dot(all, middle) + dot(abs(all), half) + 3.0f * rounding >= sign * volume;
}

// Keeps the targets that some lane still sees and that their candidate may hide, and marks the end.
DEVICE void filter_targets(const LightMesh &mesh, const CellItem &item, const CellMemory &memory, unsigned count) {
    const unsigned lane = lane_of_thread();
    unsigned kept = 0;
    for (unsigned first = 0; first < count; first += 32) {
        bool keep = false;
        Target target = {};
        if (first + lane < count) {
            target = memory.targets[first + lane];
            const unsigned packed = __float_as_uint(target.w);
            keep = memory.seen[packed & 0xffff] != 0 &&
                   may_hide(mesh, item, memory.candidates[packed >> 16], Vec3{target.x, target.y, target.z});
        }
        const unsigned lanes = __ballot_sync(ALL_LANES, keep);
        // All have read before any writes.
        __syncwarp();
        if (keep)
            memory.targets[kept + __popc(lanes & lanes_below(lane))] = target;
        kept += __popc(lanes);
        __syncwarp();
    }
    if (lane == 0)
        memory.targets[kept].w = __uint_as_float(NO_TARGET);
    __syncwarp();
}

// A triangle as the lane's object point sees it.
DEVICE Occluder occluder_of(const Candidate &candidate, const CellLane &lane, bool &above) {
    const Vec3 &origin = lane.point.origin, &normal = lane.point.normal;
    const Vec3 a = corner_of(candidate.corners[0]) - origin, b = corner_of(candidate.corners[1]) - origin,
               c = corner_of(candidate.corners[2]) - origin;
    above = lane.alive && (dot(normal, a) > 0.0f || dot(normal, b) > 0.0f || dot(normal, c) > 0.0f);
    const Vec3 bc = cross(b, c);
    const float volume = dot(a, bc), sign = volume < 0.0f ? -1.0f : 1.0f;
    return Occluder{sign * bc, sign * cross(c, a), sign * cross(a, b), sign * volume};
}

// Whether the lane's object point sees the triangle from its edge.
DEVICE bool is_edge_on(const LightMesh &mesh, const Candidate &candidate, const CellLane &lane, const Occluder &occluder) {
    const Vec3 &origin = lane.point.origin;
    const Vec3 a = corner_of(candidate.corners[0]) - origin, b = corner_of(candidate.corners[1]) - origin,
               c = corner_of(candidate.corners[2]) - origin;
    const Vec3 outward = cross(b - a, c - a);
    return !(occluder.volume * occluder.volume > mesh.edge_on * mesh.edge_on * dot(outward, outward));
}

// 3. c. Clears the light points that the candidates hide from the lanes. Targets of one candidate follow each other, and after the
// last of all comes one of no candidate. Returns whether the lane asked a triangle.
DEVICE bool clear_blocked(const ShortTests &args, const CellLane &lane, const CellMemory &memory) {
    bool asked = false;
    Target target = memory.targets[0];
    for (unsigned i = 0; __float_as_uint(target.w) != NO_TARGET;) {
        // ShortTest::occluder; whether it is edge-on is asked only once something is hidden.
        const unsigned current = __float_as_uint(target.w) >> 16;
        const Candidate &candidate = memory.candidates[current];
        bool above, edges_known = false;
        const Occluder occluder = occluder_of(candidate, lane, above);
        unsigned lanes = __ballot_sync(ALL_LANES, above);
        asked |= above;
        do {
            const unsigned point = __float_as_uint(target.w) & 0xffff;
            const Vec3 d = Vec3{target.x, target.y, target.z} - lane.point.origin;
            target = memory.targets[++i];
            unsigned blocked = __ballot_sync(ALL_LANES, blocks(occluder, d)) & lanes;
            if (blocked == 0)
                continue;
            if (!edges_known) {
                lanes &= ~__ballot_sync(ALL_LANES, is_edge_on(args.mesh, candidate, lane, occluder));
                blocked &= lanes;
                edges_known = true;
            }
            if (lane_of_thread() == 0)
                memory.seen[point] &= ~blocked;
        } while (__float_as_uint(target.w) >> 16 == current);
    }
    __syncwarp();
    return asked;
}

// 3. b. Lanes take the rows of light points that the candidates reach, and list the points that may be hidden; the warp tests them.
// `rows` is the number of rows of the lane's candidate.
DEVICE bool test_candidates(const ShortTests &args, const CellItem &item, const CellLane &own, const CellMemory &memory,
                            unsigned rows) {
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const unsigned end = warp_running_sum(rows), all = __shfl_sync(ALL_LANES, end, 31);
    bool asked = false;
    for (unsigned first = 0; first < all; first += 32) {
        // The candidate of a row: the number of candidates whose rows end before.
        const unsigned number = first + lane;
        unsigned owner = 0;
        for (unsigned step = 16; step > 0; step /= 2) {
            const unsigned other = __shfl_sync(ALL_LANES, end, owner + step - 1);
            owner += other <= number ? step : 0;
        }
        const unsigned before = __shfl_sync(ALL_LANES, end - rows, owner);
        unsigned targets = 0, bit = 0;
        int x = 0;
        float py = 0.0f, pz = 0.0f;
        if (number < all) {
            const Candidate &candidate = memory.candidates[owner];
            const unsigned box = __float_as_uint(candidate.corners[0].w);
            const unsigned lines = box_bound(box, 3) - box_bound(box, 2) + 1, row = number - before;
            // Fewer than 1024 rows: the quotient of floats, moved off whole numbers, is exact.
            const unsigned plane = __float2int_rd(((float)row + 0.5f) * candidate.most.y);
            const int y = box_bound(box, 2) + (int)(row - plane * lines), z = box_bound(box, 4) + (int)plane;
            py = lattice_coordinate(mesh.origin.y, mesh.step, item.cell.y + y);
            pz = lattice_coordinate(mesh.origin.z, mesh.step, item.cell.z + z);
            int count;
            template_row(mesh, row_of(mesh, y, z), bit, count, x);
            targets = row_targets(mesh, item, candidate, py, pz, bit, count, x, memory.seen);
        }
        // As many lanes as there is room for list their points; then those are tested.
        while (__any_sync(ALL_LANES, targets != 0)) {
            const unsigned amount = __popc(targets), until = warp_running_sum(amount);
            const bool fits = until <= LISTED_TARGETS;
            const unsigned listed = __shfl_sync(ALL_LANES, until, 31 - __clz(__ballot_sync(ALL_LANES, fits)));
            if (fits) {
                for (unsigned place = until - amount; targets != 0; place++) {
                    const int i = __ffs(targets) - 1;
                    targets &= targets - 1;
                    const float px = lattice_coordinate(mesh.origin.x, mesh.step, item.cell.x + x + i);
                    memory.targets[place] = Target{px, py, pz, __uint_as_float(owner << 16 | (bit + i))};
                }
            }
            __syncwarp();
            filter_targets(mesh, item, memory, listed);
            asked |= clear_blocked(args, own, memory);
        }
    }
    return asked;
}

// 3. What stands in the way. Returns whether the lane asked any triangle.
DEVICE bool test_occluders(const ShortTests &args, const CellItem &item, const CellLane &lane, const CellMemory &memory) {
    bool asked = false;
    unsigned height = 0, found = 0;
    if (args.scene.bvh.node_count != 0) {
        if (lane_of_thread() == 0)
            memory.stack[0] = 0;
        height = 1;
    }
    __syncwarp();
    while (height != 0 || found != 0) {
        while (height != 0 && found < 32)
            next_nodes(args, item, memory, height, found);
        unsigned count = min(found, 32u);
        found -= count;
        const unsigned rows = choose_candidates(args, item, memory, found, count);
        asked |= test_candidates(args, item, lane, memory, rows);
        __syncwarp();
    }
    return asked;
}

// Cuts a block's shared memory up. A block is one warp: items differ in cost, and a block keeps its place until its last warp is
// done. Whether masks are kept there is known to the compiler, which then knows
// what kind of memory they are in.
template <bool SHARED_MASKS>
DEVICE CellMemory cell_memory(const ShortTests &args, unsigned *shared, unsigned long long item) {
    // Later the marks are there.
    const unsigned side = window_side(args.mesh), found = max(FOUND_TRIANGLES, 2 * side * side * side);
    const unsigned stack = 4 * ((STACK_OF_ROUNDS + STACK_PER_LEVEL * args.scene.bvh.depth + 3) / 4);
    const unsigned candidates = sizeof(Candidate) / 4 * 32, targets = (unsigned)sizeof(Target) / 4 * (LISTED_TARGETS + 1);
    const unsigned planes = 4 * TANGENT_PLANES;
    CellMemory memory;
    memory.candidates = (Candidate *)shared;
    memory.targets = (Target *)(shared + candidates);
    memory.planes = (float4 *)(shared + candidates + targets);
    memory.found = shared + candidates + targets + planes;
    memory.stack = memory.found + found;
    memory.seen = SHARED_MASKS ? memory.stack + stack : args.masks + item * 32 * args.mesh.words;
    return memory;
}

template <bool SHARED_MASKS>
DEVICE void short_tests_by_cell_of_item(const ShortTests &args) {
    DYNAMIC_SHARED(unsigned, shared);
    const unsigned lane = lane_of_thread();
    // Last come first: a picture's upper items are the far ones, each of which has much to look at, or empty sky. Where a slow item
    // begins late, the device waits for it alone.
    const unsigned long long index = args.first_item + (args.item_count - 1 - blockIdx.x);
    const CellMemory memory = cell_memory<SHARED_MASKS>(args, shared, index);
    const Item item = args.items[index];
    CellLane own;
    own.alive = lane < item.count;
    // Lanes without an object point take the first one's, and no part.
    const unsigned ray = args.members[item.first + (own.alive ? lane : 0)];
    own.point = object_point(args.scene, args.rays, args.hits, ray);
    const CellItem shape = cell_item(args.mesh, item, own, memory.planes);

    // 1, 2. The half-balls.
    const unsigned size = half_balls(args.mesh, shape, own, memory.seen);
    __syncwarp();
    // 3. What stands in their way.
    const bool asked = test_occluders(args, shape, own, memory);

    // 4. The masks, and what was counted.
    const unsigned used = write_masks(args, index, shape.cell, memory.seen, memory.found);
    count_short_tests(args.tally, size, used, asked ? size : 0);
}
