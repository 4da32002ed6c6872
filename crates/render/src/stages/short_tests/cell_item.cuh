// An item as the short tests see it: what is the same for the whole warp.
#pragma once

#include "light_mesh/bricks.cuh"
#include "stages/cells/item.cuh"

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

DEVICE CellItem cell_item(const LightMesh &mesh, const Item &item, const ItemLane &lane, float4 *planes) {
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
