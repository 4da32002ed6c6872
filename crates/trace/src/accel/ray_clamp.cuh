// Moves a ray close to the triangles before it is traced: twin of ray_clamp.rs.
#pragma once

#include "accel/ray.cuh"

// A ray close to the triangles, and how its parameter relates to that of the original ray: t = start + t' · scale.
struct ClampedRay {
    Ray ray;
    // Zero if the ray cannot hit anything.
    double scale;
    double start;
};

// Where along the ray to begin; negative if it misses the triangles or points away from them.
DEVICE double approach_start(float radius_of_triangles, DVec3 origin, DVec3 direction) {
    const double radius = radius_of_triangles;
    if (max_element(abs(origin)) <= (double)REACH * radius)
        return 0.0;
    const double nearest = -dot(origin, direction) / length_squared(direction);
    // The box lies in a sphere of √3 radii; 2 leaves room for rounding.
    const double sphere = 2.0 * radius;
    const bool passes_by = length(origin + nearest * direction) > sphere;
    return nearest > 0.0 && !passes_by ? nearest - 2.0 * sphere / length(direction) : -1.0;
}

COLD ClampedRay far_ray(Vec3 center, float radius, Ray ray) {
    ClampedRay near = {ray, 0.0, 0.0};
    const double largest = max_element(abs(ray.direction));
    if (!(is_finite(ray.origin) && is_finite(ray.direction) && largest > 0.0 && ray.t_max > 0.0f))
        return near;
    // 2 to the floor of the binary logarithm: the number without its fraction. No f32 is below the normal numbers of f64.
    const long long power = __double_as_longlong(largest) & 0x7ff0000000000000ll;
    const double scale = 1.0 / __longlong_as_double(power);
    const DVec3 origin = to_double(ray.origin), direction = scale * to_double(ray.direction);
    const double start = approach_start(radius, origin - to_double(center), direction);
    const float t_max = (float)((double)ray.t_max / scale - start);
    if (start < 0.0 || !(t_max > 0.0f))
        return near;
    near.ray = Ray{to_single(origin + start * direction), to_single(direction), t_max};
    near.scale = scale;
    near.start = start * scale;
    return near;
}

// The ray to trace.
DEVICE ClampedRay clamped_ray(const RayClamp &ray_clamp, const Ray &ray) {
    const float largest = max_element(abs(ray.direction));
    const Vec3 distance = abs(ray.origin - ray_clamp.center);
    const float reach = REACH * ray_clamp.radius;
    const bool near = distance.x <= reach && distance.y <= reach && distance.z <= reach;
    const bool usual = largest >= 1.0f / LARGEST_DIRECTION && largest <= LARGEST_DIRECTION && is_finite(ray.direction);
    if (near && usual && ray.t_max > 0.0f)
        return ClampedRay{ray, 1.0, 0.0};
    return far_ray(ray_clamp.center, ray_clamp.radius, ray);
}

// Converts the parameter `t` of the near ray to that of the original ray.
DEVICE float asked_parameter(const ClampedRay &near, float t) {
    return near.start != 0.0 || near.scale != 1.0 ? (float)(near.start + (double)t * near.scale) : t;
}
