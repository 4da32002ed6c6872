// The light points that candidates may hide, and their tests: lanes are surface points, triangle and light point are the same
// for all, as in batch.rs.
#pragma once

#include "accel/alpha_mask.cuh"
#include "light_mesh/template.cuh"
#include "stages/short_tests/memory.cuh"
#include "stages/short_tests/span.cuh"

// Narrows the range of s to where s [low, high] can meet [from, to]. Reciprocals replace divisions.
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
// A hidden light point lies at P + s (q - P) with s >= 1 (`shadow_box` in cells.rs). Its y and z, which are known for the row, narrow
// s; that in turn narrows its x.
DEVICE unsigned row_targets(const LightMesh &mesh, const CellBundle &bundle, const Candidate &candidate, float py, float pz,
                            unsigned bit, int count, int x, const unsigned *seen) {
    const float4 yz = candidate.span_yz, inverse = candidate.inverse_yz;
    float least = 1.0f, most = candidate.most.x;
    narrow(yz.x, yz.y, inverse.x, inverse.y, py - bundle.high.y - mesh.slack, py - bundle.low.y + mesh.slack, least, most);
    narrow(yz.z, yz.w, inverse.z, inverse.w, pz - bundle.high.z - mesh.slack, pz - bundle.low.z + mesh.slack, least, most);
    // The rounding of products is far less than this.
    if (least > most * 1.000001f)
        return 0;
    const float low_x = candidate.corners[1].w, high_x = candidate.corners[2].w;
    const Span reached = {fminf(least * low_x, most * low_x), fmaxf(least * high_x, most * high_x)};
    int first, last;
    span_in_steps(mesh, bundle.inverse_step, reached, bundle.low.x, bundle.high.x, mesh.anchor.x, bundle.cell.x, first, last);
    first = max(first - x, 0);
    last = min(last - x, count - 1);
    unsigned targets = 0;
    for (int i = first; i <= last; i++)
        targets |= seen[bit + i] != 0 ? 1u << i : 0;
    return targets;
}

// Whether a triangle may stand between a light point and a surface point of the bundle: whether the light point, looking through the
// triangle, sees any part of the box around the origins behind it.
DEVICE bool may_hide(const LightMesh &mesh, const CellBundle &bundle, const Candidate &candidate, const Vec3 &target) {
    const Vec3 a = corner_of(candidate.corners[0]) - target, b = corner_of(candidate.corners[1]) - target,
               c = corner_of(candidate.corners[2]) - target;
    const Vec3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b), all = bc + ca + ab;
    const float volume = dot(a, bc), sign = volume < 0.0f ? -1.0f : 1.0f;
    const Vec3 middle = 0.5f * (bundle.low + bundle.high) - target, half = 0.5f * (bundle.high - bundle.low) + splat(mesh.slack);
    // The largest products of three lengths that are rounded below, and in the test itself, which starts at the other end.
    const float reach = mesh.radius + mesh.slack, size = max_element(max(max(abs(a), abs(b)), abs(c))) + reach;
    const float rounding = 128.0f * UNIT_ROUNDOFF * size * size * reach;
    return sign * dot(bc, middle) + dot(abs(bc), half) + rounding >= 0.0f &&
           sign * dot(ca, middle) + dot(abs(ca), half) + rounding >= 0.0f &&
           sign * dot(ab, middle) + dot(abs(ab), half) + rounding >= 0.0f &&
           sign * dot(all, middle) + dot(abs(all), half) + 3.0f * rounding >= sign * volume;
}

// Keeps the targets that some lane still sees and that their candidate may hide, and marks the end.
DEVICE void filter_targets(const LightMesh &mesh, const CellBundle &bundle, const CellMemory &memory, unsigned count) {
    const unsigned lane = lane_of_thread();
    unsigned kept = 0;
    for (unsigned first = 0; first < count; first += WARP) {
        bool keep = false;
        Target target = {};
        if (first + lane < count) {
            target = memory.targets[first + lane];
            const unsigned packed = __float_as_uint(target.w);
            keep = memory.seen[packed & 0xffff] != 0 &&
                   may_hide(mesh, bundle, memory.candidates[packed >> 16], Vec3{target.x, target.y, target.z});
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

// A triangle as seen from the lane's surface point.
DEVICE Occluder occluder_of(const Candidate &candidate, const BundleLane &lane, bool &above) {
    const Vec3 &origin = lane.point.origin, &normal = lane.point.normal;
    const Vec3 a = corner_of(candidate.corners[0]) - origin, b = corner_of(candidate.corners[1]) - origin,
               c = corner_of(candidate.corners[2]) - origin;
    above = lane.alive && (dot(normal, a) > 0.0f || dot(normal, b) > 0.0f || dot(normal, c) > 0.0f);
    const Vec3 bc = cross(b, c);
    const float volume = dot(a, bc), sign = volume < 0.0f ? -1.0f : 1.0f;
    return Occluder{sign * bc, sign * cross(c, a), sign * cross(a, b), sign * volume};
}

// Whether the lane's surface point sees the triangle edge-on.
DEVICE bool is_edge_on(const LightMesh &mesh, const Candidate &candidate, const BundleLane &lane, const Occluder &occluder) {
    const Vec3 &origin = lane.point.origin;
    const Vec3 a = corner_of(candidate.corners[0]) - origin, b = corner_of(candidate.corners[1]) - origin,
               c = corner_of(candidate.corners[2]) - origin;
    const Vec3 outward = cross(b - a, c - a);
    return !(occluder.volume * occluder.volume > mesh.edge_on * mesh.edge_on * dot(outward, outward));
}

// Those of `lanes` whose segments along `d` a candidate stops where it is not cut out.
DEVICE unsigned stopped_lanes(const AlphaMask &alpha_mask, const Candidate &candidate, const BundleLane &lane, Vec3 d, unsigned lanes) {
    const unsigned cut = __float_as_uint(candidate.most.z);
    if (cut == 0)
        return lanes;
    const Corners corners = {corner_of(candidate.corners[0]), corner_of(candidate.corners[1]), corner_of(candidate.corners[2])};
    const bool own = lanes >> lane_of_thread() & 1;
    return __ballot_sync(ALL_LANES, own && stops_cut(alpha_mask, cut, corners, lane.point.origin, d));
}

// 3. d. Clears the light points that the candidates hide from the lanes. Targets of one candidate are consecutive, and the last is
// followed by one of no candidate. Returns whether the lane tested a triangle.
DEVICE bool clear_blocked(const ShortTests &args, const AlphaMask *alpha_mask, const BundleLane &lane, const CellMemory &memory) {
    bool asked = false;
    Target target = memory.targets[0];
    for (unsigned i = 0; __float_as_uint(target.w) != NO_TARGET;) {
        // ShortTest::occluder; whether it is edge-on is tested only once something is hidden.
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
            if (alpha_mask != nullptr)
                blocked = stopped_lanes(*alpha_mask, candidate, lane, d, blocked);
            if (lane_of_thread() == 0)
                memory.seen[point] &= ~blocked;
        } while (__float_as_uint(target.w) >> 16 == current);
    }
    __syncwarp();
    return asked;
}

// 3. c. Lanes process the rows of light points that the candidates reach, and list the points that may be hidden; the warp tests
// them. `rows` is the number of rows of the lane's candidate.
DEVICE bool test_candidates(const ShortTests &args, const AlphaMask *alpha_mask, const CellBundle &bundle, const BundleLane &own,
                            const CellMemory &memory, unsigned rows) {
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const unsigned end = warp_running_sum(rows), all = __shfl_sync(ALL_LANES, end, WARP - 1);
    bool asked = false;
    for (unsigned first = 0; first < all; first += WARP) {
        // The candidate of a row.
        const unsigned number = first + lane, owner = warp_owner(end, number);
        const unsigned before = __shfl_sync(ALL_LANES, end - rows, owner);
        unsigned targets = 0, bit = 0;
        int x = 0;
        float py = 0.0f, pz = 0.0f;
        if (number < all) {
            const Candidate &candidate = memory.candidates[owner];
            const unsigned box = __float_as_uint(candidate.corners[0].w);
            const unsigned lines = box_bound(box, 3) - box_bound(box, 2) + 1, row = number - before;
            // Fewer than 1024 rows: the quotient of floats, moved away from integers, gives the exact result.
            const unsigned plane = __float2int_rd(((float)row + 0.5f) * candidate.most.y);
            const int y = box_bound(box, 2) + (int)(row - plane * lines), z = box_bound(box, 4) + (int)plane;
            py = lattice_coordinate(mesh.anchor.y, mesh.step, bundle.cell.y + y);
            pz = lattice_coordinate(mesh.anchor.z, mesh.step, bundle.cell.z + z);
            int count;
            template_row(mesh, row_of(mesh, y, z), bit, count, x);
            targets = row_targets(mesh, bundle, candidate, py, pz, bit, count, x, memory.seen);
        }
        // As many lanes as there is room for list their points; then these are tested.
        while (__any_sync(ALL_LANES, targets != 0)) {
            const unsigned amount = __popc(targets), until = warp_running_sum(amount);
            const bool fits = until <= LISTED_TARGETS;
            const unsigned listed = __shfl_sync(ALL_LANES, until, 31 - __clz(__ballot_sync(ALL_LANES, fits)));
            if (fits) {
                for (unsigned place = until - amount; targets != 0; place++) {
                    const int i = __ffs(targets) - 1;
                    targets &= targets - 1;
                    const float px = lattice_coordinate(mesh.anchor.x, mesh.step, bundle.cell.x + x + i);
                    memory.targets[place] = Target{px, py, pz, __uint_as_float(owner << 16 | (bit + i))};
                }
            }
            __syncwarp();
            filter_targets(mesh, bundle, memory, listed);
            asked |= clear_blocked(args, alpha_mask, own, memory);
        }
    }
    return asked;
}
