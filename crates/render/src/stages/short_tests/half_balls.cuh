// The half-balls of a bundle's surface points: conditions 1 and 2 of formula (2).
#pragma once

#include "light_mesh/lattice.cuh"
#include "light_mesh/template.cuh"
#include "stages/short_tests/cell_bundle.cuh"
#include "stages/short_tests/span.cuh"

// Whether a light point satisfies conditions 1 and 2 of formula (2) for a surface point.
DEVICE bool in_half_ball(const LightMesh &mesh, const SurfacePoint &point, const Vec3 &light_point) {
    const Vec3 d = light_point - point.position;
    return (d.z * d.z + d.y * d.y) + d.x * d.x < mesh.radius * mesh.radius && dot_along_x(point.normal, d) > mesh.least_height;
}

// 1, 2. The half-balls: conditions 1 and 2 of formula (2). Returns how many light points the lane's half-ball has.
//
// Each lane takes a light point and bounds the two conditions over all surface points of the bundle. For the few light points that may
// be in some half-balls but not in others, the warp tests all surface points. Rounding is monotonic and the bounds follow the order
// of operations of `in_half_ball`, so they hold bit by bit.
DEVICE unsigned half_balls(const LightMesh &mesh, const CellBundle &bundle, const BundleLane &lane, unsigned *seen) {
    const SurfacePoint &point = lane.point;
    const Span x = warp_span(point.position.x), y = warp_span(point.position.y), z = warp_span(point.position.z);
    Span nx = {point.normal.x, point.normal.x}, ny = {point.normal.y, point.normal.y}, nz = {point.normal.z, point.normal.z};
    if (bundle.planes.count != 1) {
        nx = warp_span(point.normal.x);
        ny = warp_span(point.normal.y);
        nz = warp_span(point.normal.z);
    }
    const float square = mesh.radius * mesh.radius;
    const unsigned alive = __ballot_sync(ALL_LANES, lane.alive);
    unsigned size = 0;
    for (unsigned first = 0; first < 32 * mesh.words; first += WARP) {
        const unsigned k = first + lane_of_thread();
        bool all = false, some = false;
        Vec3 light_point = {};
        if (k < mesh.points) {
            light_point = lattice_point(mesh, bundle.cell + template_offset(mesh, k));
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
