// Footprints: what part of a surface a sample of a pixel sees. Twin of footprint.rs.
#pragma once

#include "surface.cuh"

// The cone around ray number `ray`.
DEVICE Cone cone_of(const Rays &rays, unsigned ray) {
    if (rays.cones == nullptr)
        return rays.cone;
    return Cone{__ldg(&rays.cones[ray].width), __ldg(&rays.cones[ray].spread)};
}

// Whether textures are looked up at points.
DEVICE bool is_point(Cone cone) { return cone.width == 0.0f && cone.spread == 0.0f; }

// The cone after `distance`: behind a focus it widens again.
DEVICE Cone cone_after(Cone cone, float distance) {
    const float width = cone.width + cone.spread * distance;
    return width < 0.0f ? Cone{-width, -cone.spread} : Cone{width, cone.spread};
}

// The cone that a mirror reflects.
DEVICE Cone cone_reflected(Cone cone, float curvature) {
    return Cone{cone.width, cone.spread + 2.0f * curvature * cone.width};
}

// The changes of the weights of a triangle's second and third corner along the surface, and its unit normal on one side.
struct Gradients {
    Vec3 u, v, normal;
    // False for a needle.
    bool valid;
};

DEVICE Gradients gradients_of(const Corners &corners) {
    const Vec3 ab = corners.b - corners.a, ac = corners.c - corners.a;
    const Vec3 normal = cross(ab, ac);
    const float square = length_squared(normal);
    return Gradients{cross(ac, normal) / square, cross(normal, ab) / square, normal / sqrtf(square), square > MIN_SQUARE};
}

// The axes of a footprint in texture coordinates: conjugate diameters of an ellipse.
struct Axes {
    Uv a, b;
};

// The change of texture coordinates for a step along the surface.
DEVICE Uv uv_change(const Gradients &gradients, Vec3 step, Uv a, Uv b, Uv c) {
    const float u = dot(gradients.u, step), v = dot(gradients.v, step);
    return Uv{u * (b.u - a.u) + v * (c.u - a.u), u * (b.v - a.v) + v * (c.v - a.v)};
}

// The axes of the ellipse in which a cone around `direction` meets a triangle where it is `width` wide; `a`, `b`, `c` are the texture
// coordinates of the corners. Zero where there is no telling.
DEVICE Axes footprint_axes(Vec3 direction, float width, const Corners &corners, Uv a, Uv b, Uv c) {
    const Axes none = {};
    const Gradients gradients = gradients_of(corners);
    if (!gradients.valid)
        return none;

    // 1. The ellipse along the surface.
    const Vec3 normal = gradients.normal;
    const float cosine = dot(normal, direction);
    const Vec3 slope = direction - cosine * normal;
    const float square = length_squared(slope);
    const Vec3 edge = corners.b - corners.a;
    const Vec3 unit = square > MIN_SMOOTH_SQUARE ? slope / sqrtf(square) : edge / length(edge);
    const Vec3 across = width * cross(normal, unit);
    const Vec3 along = (width / larger(fabsf(cosine), MIN_FOOTPRINT_COSINE)) * unit;

    // 2. In texture coordinates.
    const Axes axes = {uv_change(gradients, along, a, b, c), uv_change(gradients, across, a, b, c)};
    const bool finite = is_finite(axes.a.u) && is_finite(axes.a.v) && is_finite(axes.b.u) && is_finite(axes.b.v);
    return finite ? axes : none;
}

// The direction in which a surface point is seen along a ray, or along the ray of another sample of its pixel.
DEVICE Vec3 direction_to(Vec3 position, const Ray &ray, Cone cone) {
    if (cone.spread > 0.0f) {
        const Vec3 way = position - ray.origin;
        return way / length(way);
    }
    return ray.direction;
}

// The mean curvature of the normals that shading uses, at a hit; `facing` is the geometric normal on the viewer's side.
DEVICE float curvature(const Triangles &triangles, const Vec3 *all, const Indices *indices, const Hit &hit, const Corners &corners,
                       Vec3 facing) {
    if (all == nullptr)
        return 0.0f;
    const Normals normals = load_normals(triangles, all, indices, hit.triangle);
    Vec3 smooth;
    float square;
    if (!smooth_at(hit, normals, smooth, square))
        return 0.0f;
    const Gradients gradients = gradients_of(corners);
    if (!gradients.valid)
        return 0.0f;
    const float divergence = (dot(gradients.u, normals.b - normals.a) + dot(gradients.v, normals.c - normals.a)) / sqrtf(square);
    const float half = dot(smooth, facing) < 0.0f ? -0.5f * divergence : 0.5f * divergence;
    return is_finite(half) ? half : 0.0f;
}

DEVICE float curvature(const Scene &scene, const Hit &hit, const Corners &corners, Vec3 facing) {
    return curvature(scene.triangles, scene.normals, scene.indices, hit, corners, facing);
}
