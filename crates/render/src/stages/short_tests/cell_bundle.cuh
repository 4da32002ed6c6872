// A bundle as the short tests see it: data that are the same for the whole warp.
#pragma once

#include "accel/region.cuh"
#include "light_mesh/bricks.cuh"
#include "stages/cells/bundle.cuh"

// Data that are the same for the whole warp.
struct CellBundle {
    IVec3 cell;
    // The box around all origins.
    Vec3 low, high;
    // 1 / h.
    float inverse_step;
    // Tangent planes of the surface points at their origins.
    TangentPlanes planes;
};

DEVICE CellBundle cell_bundle(const LightMesh &mesh, const Bundle &bundle, const BundleLane &lane, PlanesMemory *planes) {
    CellBundle result;
    result.cell = point_of(bundle.cell);
    const float far = 3.4e38f;
    const Vec3 &origin = lane.point.origin, &normal = lane.point.normal;
    result.low = Vec3{warp_min(lane.alive ? origin.x : far), warp_min(lane.alive ? origin.y : far),
                      warp_min(lane.alive ? origin.z : far)};
    result.high = Vec3{warp_max(lane.alive ? origin.x : -far), warp_max(lane.alive ? origin.y : -far),
                       warp_max(lane.alive ? origin.z : -far)};
    result.inverse_step = 1.0f / mesh.step;
    result.planes = tangent_planes(result.low, lane.alive, origin, normal, planes);
    return result;
}
