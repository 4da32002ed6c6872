// The depths that a camera sees: twin of clip.rs.
#pragma once

#include "data/rays.cuh"

// The part of a ray on which surfaces are seen, in units of its direction.
struct Limits {
    float start, end;
};

// The limits of a ray with a direction of unit length.
DEVICE Limits limits_of(const View &view, const Ray &ray) {
    const float cosine = view.clips ? dot(ray.direction, view.axis) : 0.0f;
    // What is bent so far by glass that it comes back is not limited.
    if (!(cosine > 0.0f))
        return Limits{0.0f, INFINITE};
    const float depth = dot(ray.origin - view.origin, view.axis);
    return Limits{larger((view.near - depth) / cosine, 0.0f), larger((view.far - depth) / cosine, 0.0f)};
}

// The same for ray number `ray`: mirrors show all depths.
DEVICE Limits limits_of(const Rays &rays, unsigned ray, const Ray &along) {
    if (!rays.view.clips || is_mirrored(rays, ray))
        return Limits{0.0f, INFINITE};
    return limits_of(rays.view, along);
}

// The ray between its limits.
DEVICE Ray between(const Limits &limits, const Ray &ray) {
    const Vec3 origin = limits.start > 0.0f ? ray.origin + limits.start * ray.direction : ray.origin;
    return Ray{origin, ray.direction, limits.end - limits.start};
}

// What that hits, as a hit of the ray itself.
DEVICE Hit from_origin(const Limits &limits, Hit hit) {
    hit.t += limits.start;
    return hit;
}
