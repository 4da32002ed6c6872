// From a hit to the surface point that all further steps start from: twin of surface.rs.
#pragma once

#include "accel/instanced.cuh"
#include "data/rays.cuh"

// A surface point P.
struct SurfacePoint {
    Vec3 position, origin, normal;
};

// The unit normal of a tiny or very narrow triangle; the direction to the viewer if double precision sees no area either.
COLD Vec3 needle_normal(Corners corners, Vec3 direction) {
    const DVec3 a = to_double(corners.a), b = to_double(corners.b), c = to_double(corners.c);
    const Vec3 normal = to_single(normalize_or_zero(cross(b - a, c - a)));
    return normal == splat(0.0f) ? -normalize_or_zero(direction) : normal;
}

// The surface point that `ray` sees at `hit` on the triangle with these corners.
DEVICE SurfacePoint surface_point(const Ray &ray, const Hit &hit, const Corners &corners) {
    const Vec3 a = corners.a, b = corners.b, c = corners.c;
    const Vec3 position = (1.0f - hit.u - hit.v) * a + hit.u * b + hit.v * c;
    Vec3 outward = cross(b - a, c - a);
    const float square = length_squared(outward);
    outward = square > MIN_SQUARE ? outward / sqrtf(square) : needle_normal(corners, ray.direction);
    const Vec3 normal = dot(outward, ray.direction) > 0.0f ? -outward : outward;
    const float error = GAMMA_32 * max_element(abs(a) + abs(b) + abs(c));
    return SurfacePoint{position, position + error * normal, normal};
}

// Where a ray goes on that the surface lets through.
DEVICE Vec3 behind(const SurfacePoint &point) { return 2.0f * point.position - point.origin; }

// How far behind a hit other surfaces count that a straight ray meets, in units of its parameter.
DEVICE float gap_behind(const Ray &ray, const Hit &hit, const Corners &corners) {
    const float error = GAMMA_32 * max_element(abs(corners.a) + abs(corners.b) + abs(corners.c));
    const float steep = fabsf(dot(surface_point(ray, hit, corners).normal, ray.direction));
    return error / fmaxf(steep, MIN_STEEPNESS * length(ray.direction));
}

// The surface point that ray number `ray` sees; the ray must have hit something.
DEVICE SurfacePoint surface_point_of(const Scene &scene, const Rays &rays, const Hit *hits, unsigned ray) {
    const Hit hit = load_hit(hits, ray);
    return surface_point(ray_at(rays, ray), hit, corners_at(scene.triangles, hit.triangle));
}

DEVICE Vec3 load_normal(const Vec3 *normals, unsigned vertex) {
    const float *normal = &normals[vertex].x;
    return Vec3{__ldg(normal), __ldg(normal + 1), __ldg(normal + 2)};
}

// The normals of a triangle's corners.
struct Normals {
    Vec3 a, b, c;
};

DEVICE Normals stored_normals(const Vec3 *normals, const Indices &triangle) {
    const unsigned *vertices = triangle.vertices;
    return Normals{load_normal(normals, __ldg(vertices)), load_normal(normals, __ldg(vertices + 1)),
                   load_normal(normals, __ldg(vertices + 2))};
}

COLD Normals instanced_normals(const Instanced *instances, unsigned count, const Vec3 *normals, const Indices *indices, unsigned triangle) {
    const Instanced *instance = instance_of(instances, count, triangle);
    const Normals own = stored_normals(normals, indices[__ldg(&instance->stored) + (triangle - __ldg(&instance->first))]);
    return Normals{placed_normal(instance->back, own.a), placed_normal(instance->back, own.b), placed_normal(instance->back, own.c)};
}

DEVICE Normals load_normals(const Triangles &triangles, const Vec3 *normals, const Indices *indices, unsigned triangle) {
    if (!INSTANCES || triangle < FIRST_INSTANCED)
        return stored_normals(normals, indices[triangle]);
    return instanced_normals(triangles.instances, triangles.instance_count, normals, indices, triangle);
}

DEVICE Normals load_normals(const Scene &scene, unsigned triangle) {
    return load_normals(scene.triangles, scene.normals, scene.indices, triangle);
}

// What the normals of a triangle's corners are between them: interpolated, not of unit length, and the square of its length. False on flat
// triangles: those with a corner without a normal, and where normals cancel out. The scene must have normals.
DEVICE bool smooth_at(const Hit &hit, const Normals &corners, Vec3 &normal, float &square) {
    const Vec3 none = splat(0.0f);
    normal = (1.0f - hit.u - hit.v) * corners.a + hit.u * corners.b + hit.v * corners.c;
    square = length_squared(normal);
    return !(corners.a == none || corners.b == none || corners.c == none || square < MIN_SMOOTH_SQUARE);
}

// The unit normal that shading uses, on the side of the geometric normal `facing`.
DEVICE Vec3 shading_normal(const Triangles &triangles, const Vec3 *normals, const Indices *indices, const Hit &hit, Vec3 facing) {
    Vec3 smooth;
    float square;
    if (normals == nullptr || !smooth_at(hit, load_normals(triangles, normals, indices, hit.triangle), smooth, square))
        return facing;
    const Vec3 normal = smooth / sqrtf(square);
    return dot(normal, facing) < 0.0f ? -normal : normal;
}

DEVICE Vec3 shading_normal(const Scene &scene, const Hit &hit, Vec3 facing) {
    return shading_normal(scene.triangles, scene.normals, scene.indices, hit, facing);
}

// The segment from `origin` to `target` for a long test, shortened at its far end.
DEVICE Ray long_segment(Vec3 origin, Vec3 target) {
    const Vec3 direction = target - origin;
    const float length = max_element(abs(direction));
    const float error = GAMMA_32 * max_element(max(abs(origin), abs(target)));
    const float spared = error < 0.5f * length ? error / length : 0.5f;
    return Ray{origin, direction, 1.0f - spared};
}
