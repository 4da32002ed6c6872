// The first ray from a surface point to a light: twin of first.rs.
#pragma once

#include "data/rays.cuh"
#include "shadow/projected_light.cuh"

// The place of the ray of a pixel of a view's window.
DEVICE unsigned place_of(const View &view, unsigned pixel) {
    const int x = place_in_image(view, pixel, 0), y = place_in_image(view, pixel, 1);
    return place_in_step(y, NEIGHBORHOOD) * NEIGHBORHOOD + place_in_step(x, NEIGHBORHOOD);
}

// A light as a surface point sees it: its points are at `center + x · u + y · v`.
struct Extent {
    Shape shape;
    Vec3 center, u, v;
};

DEVICE Extent extent_of(const Scene &scene, const Light &light, Shape shape, const SurfacePoint &point) {
    const float reach = scene_reach(scene, point.origin);
    const Vec3 center = seen_center(light, point.origin, reach) - point.origin;
    if (shape == SHAPE_RECTANGLE)
        return Extent{shape, center, light.half_u, light.half_v};
    Vec3 tangent = light.half_u, bitangent = light.half_v;
    if (light.kind == Light::POINT || light.kind == Light::SPHERE)
        facing(center, tangent, bitangent);
    const float radius = disc_radius(light, center, reach);
    return Extent{shape, center, radius * tangent, radius * bitangent};
}

// What is known before any ray: nothing, or that the light straddles the horizon. False if all of it is behind the surface.
DEVICE bool at_horizon(const Extent &extent, Vec3 normal, unsigned &known) {
    const float height = dot(normal, extent.center), a = dot(normal, extent.u), b = dot(normal, extent.v);
    const float half = extent.shape == SHAPE_RECTANGLE ? fabsf(a) + fabsf(b) : sqrtf(a * a + b * b);
    known = height < half ? ANSWER_STRADDLES : 0;
    return !(height <= -half);
}

// The point of the light at place number `place`.
DEVICE Vec3 first_target(const Extent &extent, Vec3 origin, const float (*places)[FIRST_TARGETS][2], unsigned place) {
    const float *at = places[extent.shape == SHAPE_RECTANGLE ? 1 : 0][place];
    return origin + (extent.center + at[0] * extent.u + at[1] * extent.v);
}
