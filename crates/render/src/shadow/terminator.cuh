// Where shadow rays leave smooth-shaded triangles: twin of terminator.rs.
#pragma once

#include "data/rays.cuh"
#include "shadow/projected_light.cuh"
#include "surface.cuh"

// A surface point that casts shadow rays.
struct ShadowPoint {
    SurfacePoint flat;
    // The way to the curved surface, and the normal there.
    Vec3 lift, normal;
    bool is_curved;
};

// Adds the way to the plane through a corner that touches the surface. False if the normal is too far from the triangle's.
DEVICE bool add_lift(const SurfacePoint &point, float side, Vec3 corner, Vec3 vertex, float weight, Vec3 &lift, float &deepest) {
    vertex = side * vertex;
    if (dot(vertex, point.normal) < MIN_CURVED_COSINE)
        return false;
    const float depth = fmaxf(dot(vertex, corner - point.position), 0.0f);
    lift = lift + SHAPE_FACTOR * weight * depth * vertex;
    deepest = fmaxf(deepest, depth);
    return true;
}

// The point at `hit` on the triangle with these corners. The scene must have normals.
DEVICE ShadowPoint shadow_point(const Scene &scene, const Hit &hit, const Corners &corners, const SurfacePoint &point) {
    const Normals normals = load_normals(scene, hit.triangle);
    // Vertex normals are on the side of the viewer, too, or all of them are not.
    const float side = dot(normals.a, point.normal) < 0.0f ? -1.0f : 1.0f;
    Vec3 lift = splat(0.0f);
    float deepest = 0.0f;
    const bool is_curved = add_lift(point, side, corners.a, normals.a, 1.0f - hit.u - hit.v, lift, deepest) &&
                           add_lift(point, side, corners.b, normals.b, hit.u, lift, deepest) &&
                           add_lift(point, side, corners.c, normals.c, hit.v, lift, deepest) && deepest > 0.0f;
    return ShadowPoint{point, lift, shading_normal(scene, hit, point.normal), is_curved};
}

// The way from a surface point to where shadow rays to a light that is low leave it.
DEVICE Vec3 largest_lift(const Scene &scene, const Hit *hits, unsigned ray, const SurfacePoint &point) {
    if (scene.normals == nullptr)
        return splat(0.0f);
    const Hit hit = load_hit(hits, ray);
    const ShadowPoint casting = shadow_point(scene, hit, corners_at(scene.triangles, hit.triangle), point);
    return casting.is_curved ? casting.lift : splat(0.0f);
}

// The point from which `light` is looked for.
DEVICE SurfacePoint toward(const Scene &scene, const Light &light, const ShadowPoint &point) {
    const SurfacePoint &flat = point.flat;
    if (!point.is_curved)
        return flat;
    float radius;
    const Vec3 way = way_to(scene, light, flat.origin, radius);
    const float lowest = (dot(flat.normal, way) - radius) / fmaxf(length(way), F32_MIN_POSITIVE);
    const float share = fminf(fmaxf(1.0f - lowest / LOW_LIGHT, 0.0f), 1.0f);
    if (share <= 0.0f)
        return flat;
    const Vec3 lift = share * point.lift, between = flat.normal + share * (point.normal - flat.normal);
    // Seen from there, a lamp is nearer to the horizon than it is to shading.
    const Vec3 lowered = way - lift;
    const float tilt =
        light.kind == Light::DIRECTIONAL ? 0.0f : dot(between, lift) / fmaxf(length_squared(lowered), F32_MIN_POSITIVE);
    const Vec3 normal = between + tilt * lowered;
    return SurfacePoint{flat.position, flat.origin + lift, normal / fmaxf(length(normal), F32_MIN_POSITIVE)};
}

// The sine of the angle between the triangle that ray number `ray` sees and its curved surface; FLAT if it does not depend on the light
// from where the ray's point looks for it. The ray must have hit something, and the scene must have normals.
#define FLAT -2.0f
COLD float bend_of(const Scene &scene, const Rays &rays, const Hit *hits, unsigned ray) {
    const Hit hit = load_hit(hits, ray);
    // Flat parts of a scene have none.
    if (load_normal(scene.normals, __ldg(scene.indices[stored_index(scene.triangles, hit.triangle)].vertices)) == splat(0.0f))
        return FLAT;
    const Corners corners = corners_at(scene.triangles, hit.triangle);
    const ShadowPoint point = shadow_point(scene, hit, corners, surface_point(ray_at(rays, ray), hit, corners));
    return point.is_curved ? length(cross(point.flat.normal, point.normal)) : FLAT;
}

// Whether a light may look different from the curved surface than from the point `flat` of its triangle: it is not high over it, and not so
// far behind it that it is behind the curved surface, too. May say so for others.
DEVICE bool is_low(const Scene &scene, const Light &light, const SurfacePoint &flat, float bend) {
    float radius;
    const Vec3 way = way_to(scene, light, flat.origin, radius);
    const float height = dot(flat.normal, way), distance = length(way), room = (ENLARGEMENT - 1.0f) * distance;
    return height - radius < LOW_LIGHT * distance + room && height + radius > -bend * distance - room;
}

// The point of ray number `ray` on its triangle.
COLD SurfacePoint flat_point_of(const Scene &scene, const Rays &rays, const Hit *hits, unsigned ray) {
    return surface_point_of(scene, rays, hits, ray);
}

// The point from which ray number `ray`, which must have hit something, looks for a light.
COLD SurfacePoint curved_point_of(const Scene &scene, const Rays &rays, const Hit *hits, unsigned ray, const Light &light) {
    const Hit hit = load_hit(hits, ray);
    const Corners corners = corners_at(scene.triangles, hit.triangle);
    return toward(scene, light, shadow_point(scene, hit, corners, surface_point(ray_at(rays, ray), hit, corners)));
}

// The same, if `flat` is that point on its triangle.
DEVICE SurfacePoint shadow_point_of(const Scene &scene, const Rays &rays, const Hit *hits, unsigned ray, const Light &light,
                                    const SurfacePoint &flat) {
    return scene.normals == nullptr ? flat : curved_point_of(scene, rays, hits, ray, light);
}

// The same for one light.
DEVICE SurfacePoint shadow_point_of(const Scene &scene, const Rays &rays, const Hit *hits, unsigned ray, const Light &light) {
    return scene.normals == nullptr ? surface_point_of(scene, rays, hits, ray) : curved_point_of(scene, rays, hits, ray, light);
}
