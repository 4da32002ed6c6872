// The plain short tests: every segment through the acceleration structure. The reference: twin of plain.rs.
//
// The half-balls are a separate kernel: a single one would need more registers than there are, and the walk would pay for it.
#pragma once

#include "accel/walk.cuh"
#include "stages/short_tests/half_balls.cuh"
#include "stages/short_tests/masks.cuh"

// 1, 2. The half-balls.
DEVICE void half_balls_of_bundle(const ShortTests &args) {
    const unsigned long long index = args.first_bundle + blockIdx.x;
    const Bundle bundle = args.bundles[index];
    CellBundle shape;
    shape.cell = point_of(bundle.cell);
    // Finding out whether planes are shared does not pay here.
    shape.planes.count = 0;
    const BundleLane own = lane_of_bundle(args.scene, args.rays, args.hits, args.members, bundle);
    const unsigned size = half_balls(args.mesh, shape, own, args.masks + index * 32 * args.mesh.words);
    count_short_tests(args.tally, size, 0, size);
}

// 3. Their segments.
template <typename Structure>
DEVICE void short_tests_plain(const ShortTests &args, const Structure &structure) {
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const unsigned long long index = args.first_bundle + blockIdx.x;
    const Bundle bundle = args.bundles[index];
    const IVec3 cell = point_of(bundle.cell);
    const BundleLane own = lane_of_bundle(args.scene, args.rays, args.hits, args.members, bundle);
    const ShortTest test = {own.point.origin, own.point.normal, mesh.edge_on};
    unsigned *seen = args.masks + index * 32 * mesh.words;
    for (unsigned row = 0; row < mesh.lines; row++) {
        const TemplateRow line = template_rows[row];
        const float py = lattice_coordinate(mesh.anchor.y, mesh.step, cell.y + line.y);
        const float pz = lattice_coordinate(mesh.anchor.z, mesh.step, cell.z + line.z);
        for (int i = 0; i < line.count; i++) {
            const unsigned inside = seen[line.bit + i];
            if (inside == 0)
                continue;
            const float px = lattice_coordinate(mesh.anchor.x, mesh.step, cell.x + line.x + i);
            const Vec3 direction = Vec3{px, py, pz} - test.origin;
            const bool sees =
                (inside >> lane & 1) && !short_blocked(structure, args.tally, test, direction, mesh.slack);
            const unsigned lanes = __ballot_sync(ALL_LANES, sees);
            if (lane == 0)
                seen[line.bit + i] = lanes;
        }
    }
    __syncwarp();
    // 4. The masks are already in place; add the counts.
    unsigned used = 0;
    for (unsigned k = lane; k < 32 * mesh.words; k += WARP)
        used += __popc(seen[k]);
    count_short_tests(args.tally, 0, used, 0);
}
