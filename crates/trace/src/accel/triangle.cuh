// The triangle tests: twin of triangle.rs, bit by bit.
#pragma once

#include "accel/ray.cuh"

struct Corners {
    Vec3 a, b, c;
};

DEVICE float4 load_corner(const Triangle *triangle, unsigned corner) {
    return __ldg(reinterpret_cast<const float4 *>(triangle) + corner);
}

// Here and below, a `Handle` is a pointer to a triangle or what tells that of an instance: see accel/instanced.cuh.
template <class Handle>
DEVICE Corners load_corners(const Handle &triangle) {
    const float4 a = load_corner(triangle, 0), b = load_corner(triangle, 1), c = load_corner(triangle, 2);
    return Corners{Vec3{a.x, a.y, a.z}, Vec3{b.x, b.y, b.z}, Vec3{c.x, c.y, c.z}};
}

// Index in the scene's mesh.
DEVICE unsigned triangle_index(const Triangle *triangle) {
    return __float_as_uint(__ldg(&triangle->corners[0][3]));
}

// Where the number of its opacities is.
DEVICE const unsigned *cut_of(const Triangle *triangle) { return reinterpret_cast<const unsigned *>(&triangle->corners[1][3]); }

// The number of its opacities; 0 if it is opaque.
template <class Handle>
DEVICE unsigned triangle_cut(const Handle &triangle) {
    return __ldg(cut_of(triangle));
}

// A ray prepared for the watertight test: the axes permuted so that `axis` comes last, and the shear that turns the ray into the
// last axis.
struct RayShear {
    // The dominant axis of the direction.
    unsigned axis;
    // Origin on the permuted axes.
    float x, y, z;
    float shear_x, shear_y;
    float depth;
};

// The component on the axis that comes first, second or last after permutation.
template <unsigned AXIS>
DEVICE float permuted_x(float x, float y, float z) { return AXIS == 0 ? y : AXIS == 1 ? z : x; }
template <unsigned AXIS>
DEVICE float permuted_y(float x, float y, float z) { return AXIS == 0 ? z : AXIS == 1 ? x : y; }
template <unsigned AXIS>
DEVICE float permuted_z(float x, float y, float z) { return AXIS == 0 ? x : AXIS == 1 ? y : z; }

template <unsigned AXIS>
DEVICE RayShear ray_shear_along(Vec3 origin, Vec3 direction) {
    const float depth = permuted_z<AXIS>(direction.x, direction.y, direction.z);
    return RayShear{AXIS,
                    permuted_x<AXIS>(origin.x, origin.y, origin.z),
                    permuted_y<AXIS>(origin.x, origin.y, origin.z),
                    permuted_z<AXIS>(origin.x, origin.y, origin.z),
                    permuted_x<AXIS>(direction.x, direction.y, direction.z) / depth,
                    permuted_y<AXIS>(direction.x, direction.y, direction.z) / depth,
                    depth};
}

DEVICE RayShear ray_shear(Vec3 origin, Vec3 direction) {
    const Vec3 size = abs(direction);
    if (size.x >= size.y && size.x >= size.z)
        return ray_shear_along<0>(origin, direction);
    return size.y >= size.z ? ray_shear_along<1>(origin, direction) : ray_shear_along<2>(origin, direction);
}

// The corners of a triangle relative to a ray's origin, sheared so that the ray is the last axis.
struct Sheared {
    float ax, ay, az, bx, by, bz, cx, cy, cz;
};

template <unsigned AXIS>
DEVICE void shear_corner(const RayShear &ray, const float4 &corner, float &x, float &y, float &z) {
    z = permuted_z<AXIS>(corner.x, corner.y, corner.z) - ray.z;
    x = permuted_x<AXIS>(corner.x, corner.y, corner.z) - ray.x - ray.shear_x * z;
    y = permuted_y<AXIS>(corner.x, corner.y, corner.z) - ray.y - ray.shear_y * z;
}

// Steps 1 and 2 of the test: false if the ray, whose axis is AXIS, certainly misses.
template <unsigned AXIS>
DEVICE bool may_meet_corners(const RayShear &ray, const float4 &a, const float4 &b, const float4 &c, Sheared &corners) {
    // 1. Corners relative to the origin, sheared so that the ray is the z axis.
    shear_corner<AXIS>(ray, a, corners.ax, corners.ay, corners.az);
    shear_corner<AXIS>(ray, b, corners.bx, corners.by, corners.bz);
    shear_corner<AXIS>(ray, c, corners.cx, corners.cy, corners.cz);

    // 2. Signs of the edge functions: of two products rounded in the same way, the larger never becomes the smaller.
    const float u = corners.cx * corners.by, minus_u = corners.cy * corners.bx;
    const float v = corners.ax * corners.cy, minus_v = corners.ay * corners.cx;
    const float w = corners.bx * corners.ay, minus_w = corners.by * corners.ax;
    const bool below = u < minus_u || v < minus_v || w < minus_w;
    const bool above = u > minus_u || v > minus_v || w > minus_w;
    return !(below && above);
}

template <unsigned AXIS, class Handle>
DEVICE bool may_meet(const RayShear &ray, const Handle &triangle, Sheared &corners) {
    return may_meet_corners<AXIS>(ray, load_corner(triangle, 0), load_corner(triangle, 1), load_corner(triangle, 2), corners);
}

// Scaled barycentric coordinates of the three corners and their sum.
struct Weights {
    double u, v, w, det;
};

// Step 3, in double precision, where products of f32 are exact: false if the ray misses.
DEVICE bool weigh(const Sheared &s, Weights &weights) {
    const double ax = s.ax, ay = s.ay, bx = s.bx, by = s.by, cx = s.cx, cy = s.cy;
    const double u = cx * by - cy * bx;
    const double v = ax * cy - ay * cx;
    const double w = bx * ay - by * ax;
    weights = Weights{u, v, w, u + v + w};
    const bool below = u < 0.0 || v < 0.0 || w < 0.0, above = u > 0.0 || v > 0.0 || w > 0.0;
    return !(below && above) && weights.det != 0.0;
}

// Step 4: the ray parameter of the hit.
DEVICE float hit_distance(const RayShear &ray, const Sheared &s, const Weights &weights) {
    const double depth = weights.u * (double)s.az + weights.v * (double)s.bz + weights.w * (double)s.cz;
    return (float)(depth / (weights.det * (double)ray.depth));
}

// Steps 1 and 2 for whichever axis the ray has.
template <class Handle>
DEVICE bool may_meet(const RayShear &ray, const Handle &triangle, Sheared &corners) {
    if (ray.axis & 1)
        return may_meet<1>(ray, triangle, corners);
    return ray.axis & 2 ? may_meet<2>(ray, triangle, corners) : may_meet<0>(ray, triangle, corners);
}

// The inner product with the term of x added last.
DEVICE float dot_along_x(Vec3 a, Vec3 b) { return (a.z * b.z + a.y * b.y) + a.x * b.x; }

// The short test, set up for one surface point; see triangle.rs.
struct ShortTest {
    Vec3 origin, normal;
    float edge_on;
};

// One triangle as seen from the origin of a short test: the plane form.
struct Occluder {
    Vec3 a, b, c;
    float volume;
};

// Whether a triangle stands in the way of one segment: `occluder` and `blocks` combined, for callers that test once; what fails
// most often comes first.
DEVICE bool blocks_segment(const ShortTest &test, const Corners &corners, Vec3 direction) {
    const Vec3 a = corners.a - test.origin, b = corners.b - test.origin, c = corners.c - test.origin;
    const Vec3 bc = cross(b, c);
    const float volume = dot(a, bc), sign = volume < 0.0f ? -1.0f : 1.0f;
    const float u = sign * dot_along_x(bc, direction);
    if (!(u >= 0.0f))
        return false;
    const float v = sign * dot_along_x(cross(c, a), direction);
    if (!(v >= 0.0f))
        return false;
    const float w = sign * dot_along_x(cross(a, b), direction);
    if (!(w >= 0.0f && u + v + w > sign * volume))
        return false;
    if (dot(test.normal, a) <= 0.0f && dot(test.normal, b) <= 0.0f && dot(test.normal, c) <= 0.0f)
        return false;
    return volume * volume > test.edge_on * test.edge_on * length_squared(cross(b - a, c - a));
}

// Whether the triangle meets the segment from the origin along `direction`.
DEVICE bool blocks(const Occluder &triangle, Vec3 direction) {
    const float u = dot_along_x(triangle.a, direction);
    const float v = dot_along_x(triangle.b, direction);
    const float w = dot_along_x(triangle.c, direction);
    return u >= 0.0f && v >= 0.0f && w >= 0.0f && u + v + w > triangle.volume;
}
