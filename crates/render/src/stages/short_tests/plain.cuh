// The plain short tests: every segment through the acceleration structure. The oracle: twin of plain.rs.
#pragma once

#include "accel/walk.cuh"
#include "stages/short_tests/by_cell.cuh"

template <typename Structure>
DEVICE void short_tests_plain_of_item(const ShortTests &args, const Structure &structure) {
    DYNAMIC_SHARED(unsigned, shared);
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread();
    const unsigned long long number = (unsigned long long)blockIdx.x * CELL_WARPS + threadIdx.x / 32;
    if (number >= args.item_count)
        return;
    const unsigned long long index = args.first_item + number;
    const Item item = args.items[index];
    CellLane own;
    own.alive = lane < item.count;
    const unsigned ray = args.members[item.first + (own.alive ? lane : 0)];
    own.point = object_point(args.scene, args.rays, args.hits, ray);
    CellItem shape;
    shape.cell = point_of(item.cell);
    shape.planes = 0;

    // 1, 2. The half-balls.
    unsigned *seen = args.masks + index * 32 * mesh.words;
    const unsigned size = half_balls(mesh, shape, own, seen);
    __syncwarp();
    // 3. Their segments.
    const ShortTest test = {own.point.origin, own.point.normal, mesh.edge_on};
    for (unsigned row = 0; row < mesh.lines; row++) {
        const TemplateRow line = template_rows[row];
        const float py = lattice_coordinate(mesh.origin.y, mesh.step, shape.cell.y + line.y);
        const float pz = lattice_coordinate(mesh.origin.z, mesh.step, shape.cell.z + line.z);
        for (int i = 0; i < line.count; i++) {
            const unsigned inside = seen[line.bit + i];
            if (inside == 0)
                continue;
            const float px = lattice_coordinate(mesh.origin.x, mesh.step, shape.cell.x + line.x + i);
            const Vec3 direction = Vec3{px, py, pz} - test.origin;
            const bool sees =
                (inside >> lane & 1) && !short_blocked(structure, args.tally, test, direction, mesh.slack);
            const unsigned lanes = __ballot_sync(ALL_LANES, sees);
            if (lane == 0)
                seen[line.bit + i] = lanes;
        }
    }
    __syncwarp();
    // 4. The masks, and what was counted.
    const unsigned used = write_masks(args, index, shape.cell, seen, shared);
    count_short_tests(args.tally, size, used, size);
}
