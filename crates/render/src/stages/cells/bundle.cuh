// The surface points of a bundle as a warp sees them, one per lane.
#pragma once

#include "cuda/warp.cuh"
#include "surface.cuh"

// The surface point of a lane.
struct BundleLane {
    SurfacePoint point;
    unsigned ray;
    // Whether the lane has a surface point. One without uses the bundle's first, and takes no part.
    bool alive;
};

DEVICE BundleLane lane_of_bundle(const Scene &scene, const Rays &rays, const Hit *hits, const unsigned *members, const Bundle &bundle) {
    const unsigned lane = lane_of_thread();
    BundleLane own;
    own.alive = lane < bundle.count;
    own.ray = members[bundle.first + (own.alive ? lane : 0)];
    own.point = surface_point_of(scene, rays, hits, own.ray);
    return own;
}
