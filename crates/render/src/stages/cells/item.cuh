// The surface points of an item as a warp sees them, one per lane.
#pragma once

#include "cuda/warp.cuh"
#include "surface.cuh"

// The surface point of a lane.
struct ItemLane {
    SurfacePoint point;
    unsigned ray;
    // Whether the lane has a surface point. One without uses the item's first, and takes no part.
    bool alive;
};

DEVICE ItemLane lane_of_item(const Scene &scene, const Rays &rays, const Hit *hits, const unsigned *members, const Item &item) {
    const unsigned lane = lane_of_thread();
    ItemLane own;
    own.alive = lane < item.count;
    own.ray = members[item.first + (own.alive ? lane : 0)];
    own.point = surface_point_of(scene, rays, hits, own.ray);
    return own;
}
