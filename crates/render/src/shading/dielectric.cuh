// Where light meets glass and the like: twin of dielectric.rs.
#pragma once

#include "surface.cuh"

// Where a ray meets a dielectric.
struct Boundary {
    // n1/n2, from the side that the ray comes from to the other.
    float eta;
    // Whether it is that of a wall.
    bool thin;
    // The cosine of the angle at which the ray arrives.
    float cosine;
    // What is left of light that came through the body up to here; all of it outside.
    Vec3 left;
};

// exp(-x) for x >= 0, to two units in the last place.
DEVICE float exp_of_minus(float x) {
    if (x > LARGEST_EXPONENT)
        return 0.0f;
    const float whole = rintf(-x * LOG2_E);
    const float rest = (-x - whole * LN_2_HIGH) - whole * LN_2_LOW;
    const float sum = ((((EXP_6 * rest + EXP_5) * rest + EXP_4) * rest + EXP_3) * rest + EXP_2) * rest * rest + rest + 1.0f;
    return sum * __uint_as_float((unsigned)((int)whole + 127) << 23);
}

// Where `ray` meets a dielectric with this normal at `hit` on the triangle with these corners.
DEVICE Boundary boundary_about(Vec3 normal, const Corners &corners, const Material &glass, const Ray &ray, const Hit &hit) {
    const float size = length(ray.direction);
    const bool thin = glass.thin != 0;
    const bool inside = !thin && dot(cross(corners.b - corners.a, corners.c - corners.a), ray.direction) > 0.0f;
    Boundary met = {inside ? glass.ior : 1.0f / glass.ior, thin, 0.0f, splat(1.0f)};
    met.cosine = fminf(fmaxf(-(dot(normal, ray.direction) / size), 0.0f), 1.0f);
    if (inside) {
        const Vec3 depth = hit.t * size * glass.absorption;
        met.left = Vec3{exp_of_minus(depth.x), exp_of_minus(depth.y), exp_of_minus(depth.z)};
    }
    return met;
}

// The same, whatever images of normals say.
DEVICE Boundary boundary_met(const Triangles &triangles, const Vec3 *normals, const Indices *indices, const Material &glass, const Ray &ray,
                             const Hit &hit) {
    const Corners corners = corners_at(triangles, hit.triangle);
    const Vec3 facing = surface_point(ray, hit, corners).normal;
    return boundary_about(shading_normal(triangles, normals, indices, hit, facing), corners, glass, ray, hit);
}

// The cosine of the angle beyond the boundary; 0 if all light is reflected.
DEVICE float cosine_beyond(float cosine, float eta) {
    const float square = 1.0f - eta * eta * (1.0f - cosine * cosine);
    return square > 0.0f ? sqrtf(square) : 0.0f;
}

// The share of unpolarised light that a boundary reflects.
DEVICE float fresnel(float cosine, float eta) {
    const float beyond = cosine_beyond(cosine, eta);
    if (beyond == 0.0f)
        return 1.0f;
    const float across = (eta * cosine - beyond) / (eta * cosine + beyond);
    const float along = (eta * beyond - cosine) / (eta * beyond + cosine);
    return 0.5f * (across * across + along * along);
}

// The share of the light that is reflected.
DEVICE float reflectance(const Boundary &met) {
    const float once = fresnel(met.cosine, met.eta);
    return met.thin ? 2.0f * once / (1.0f + once) : once;
}

// The share of the light that is mirrored, apart from what goes on where a body reflects everything.
DEVICE float mirrored_share(const Boundary &met) {
    const bool all = !met.thin && cosine_beyond(met.cosine, met.eta) == 0.0f;
    return all ? 0.0f : reflectance(met);
}

// What a dielectric leaves of light that goes straight on, as if its two sides were parallel.
DEVICE Vec3 left_straight_on(Boundary met, const Material &glass) {
    met.eta = 1.0f / glass.ior;
    return (1.0f - reflectance(met)) * met.left;
}

// Sets `onward` to the unit direction of light that comes along the unit vector `direction` and goes on through a boundary; false if all of
// it is reflected.
DEVICE bool refracted(Vec3 direction, Vec3 normal, float eta, Vec3 &onward) {
    const float cosine = fminf(fmaxf(-dot(normal, direction), 0.0f), 1.0f);
    const float beyond = cosine_beyond(cosine, eta);
    if (beyond == 0.0f)
        return false;
    onward = normalize(eta * direction + (eta * cosine - beyond) * normal);
    return true;
}
