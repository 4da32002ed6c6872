// The acceleration structures as kernels query them, one ray or segment per thread: twin of the trait in mod.rs.
//
// Every function exists for each of the structures. All give the same bits.
#pragma once

#include "accel/ray_clamp.cuh"
#include "accel/brute_force.cuh"
#include "accel/bvh/walk.cuh"
#include "accel/grid/short_walk.cuh"
#include "accel/grid/walk.cuh"

// The closest hit of a ray.
template <class Structure>
DEVICE Hit closest_hit(const Structure &structure, const Tally &tally, const Ray &ray) {
    const ClampedRay near = clamped_ray(structure.ray_clamp, ray);
    if (near.scale == 0.0)
        return hit_nothing();
    Closest closest = find_closest(near.ray);
    walk(structure, tally, near.ray, closest);
    Hit hit = found_hit(closest, structure);
    hit.t = asked_parameter(near, hit.t);
    return hit;
}

// Whether anything blocks a segment. `last` is the place of a triangle that blocked a similar one and is tested first, or Hit::NONE.
template <class Structure>
DEVICE bool occluded(const Structure &structure, const Tally &tally, const Ray &segment, unsigned &last) {
    const ClampedRay near = clamped_ray(structure.ray_clamp, segment);
    if (near.scale == 0.0)
        return false;
    Any any = find_any(near.ray);
    if (last == Hit::NONE || ask(any, structure, Run{last, last + 1}))
        walk(structure, tally, near.ray, any);
    if (any.hit == Hit::NONE)
        return false;
    last = any.hit;
    return true;
}

// The same for a segment on its own.
template <class Structure>
DEVICE bool occluded(const Structure &structure, const Tally &tally, const Ray &segment) {
    unsigned last = Hit::NONE;
    return occluded(structure, tally, segment, last);
}

// Whether a triangle blocks the segment from the origin of a short test along `direction`. Triangles whose bounding box comes as
// close as `slack` to it are tested.
template <class Structure>
DEVICE bool short_blocked(const Structure &structure, const Tally &, const ShortTest &test, Vec3 direction, float slack) {
    Short segment = {test, direction, false};
    walk_short(structure, segment, slack);
    return segment.blocked;
}
