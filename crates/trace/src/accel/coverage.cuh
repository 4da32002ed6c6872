// Where surfaces are that are cut out, and how opaque are those that light goes through: twin of coverage/mod.rs, bit by bit.
//
// Most scenes are opaque, and what cut-outs need takes registers from loops over triangles even where it is never used. Where that costs time, the
// kernels that test triangles are in two modules, without and with CUT_OUTS: `<module>_cut_out.cu` includes `kernel.cu`. See gpu/per_structure.rs.
#pragma once

#include "accel/instanced.cuh"
#include "textures/neighbours.cuh"

// From `a` to `b`.
DEVICE float between(float a, float b, float share) { return a + share * (b - a); }

// The four nearest texels of a mask, interpolated.
DEVICE float mask_at(const Mask *mask, float u, float v) {
    const unsigned width = __ldg(&mask->size[0]);
    const Neighbours x = neighbours(u, width, __ldg(&mask->wrap[0]));
    const Neighbours y = neighbours(v, __ldg(&mask->size[1]), __ldg(&mask->wrap[1]));
    const unsigned char *texels = mask->texels;
    const unsigned char *above = texels + (unsigned long long)y.first * width, *below = texels + (unsigned long long)y.second * width;
    const float upper = between((float)__ldg(above + x.first), (float)__ldg(above + x.second), x.share);
    const float lower = between((float)__ldg(below + x.first), (float)__ldg(below + x.second), x.share);
    return between(upper, lower, y.share);
}

// The opacity of a cut-out triangle at these barycentric weights of its second and third corner, as texels count.
DEVICE float opacity_of(const CutTriangle &own, const Mask &mask, float u, float v) {
    // 1. The opacity of the corners; exactly theirs if it is the same.
    const float a = own.opacities[0], b = own.opacities[1], c = own.opacities[2];
    const float opacity = a + u * (b - a) + v * (c - a);

    // 2. The place in the mask.
    const float w = 1.0f - u - v;
    const float x = w * own.uvs[0][0] + u * own.uvs[1][0] + v * own.uvs[2][0];
    const float y = w * own.uvs[0][1] + u * own.uvs[1][1] + v * own.uvs[2][1];
    const float place_u = mask.u_axis[0] * x + mask.v_axis[0] * y + mask.translation[0];
    const float place_v = mask.u_axis[1] * x + mask.v_axis[1] * y + mask.translation[1];

    // 3. What is there.
    return opacity * mask_at(&mask, place_u, place_v);
}

// Whether the cut-out triangle number `cut` has a surface there.
DEVICE bool covers(const Coverage &coverage, unsigned cut, float u, float v) {
    const CutTriangle &own = coverage.triangles[cut - 1];
    const Mask &mask = coverage.masks[own.mask];
    // NaN is nothing.
    return opacity_of(own, mask, u, v) >= mask.limit;
}

// How opaque a triangle is where it is hit, from 0 to 1.
DEVICE float opacity_at(const Coverage &coverage, const Triangle *triangle, float u, float v) {
    const unsigned cut = coverage.triangles != nullptr ? triangle_cut(triangle) : 0;
    if (cut == 0)
        return 1.0f;
    const CutTriangle &own = coverage.triangles[cut - 1];
    const Mask &mask = coverage.masks[own.mask];
    return mask.blends ? fminf(opacity_of(own, mask, u, v) / OPAQUE, 1.0f) : 1.0f;
}

// The same for a hit, by its scaled weights.
COLD bool covers_hit(Coverage coverage, unsigned cut, Weights weights) {
    return covers(coverage, cut, (float)(weights.v / weights.det), (float)(weights.w / weights.det));
}

// Where the triangles of a structure are cut out; null if all of them are opaque.
template <class Structure>
DEVICE const Coverage *coverage_of(const Structure &structure) {
    return CUT_OUTS && structure.coverage.triangles != nullptr ? &structure.coverage : nullptr;
}

// The host takes a BVH in place of a grid where anything is cut out.
DEVICE const Coverage *coverage_of(const Grid &) { return nullptr; }

// Whether there is a surface where a triangle is hit.
template <class Handle>
DEVICE bool has_surface(const Coverage *coverage, const Handle &triangle, const Weights &weights) {
    if (coverage == nullptr)
        return true;
    const unsigned cut = triangle_cut(triangle);
    return cut == 0 || covers_hit(*coverage, cut, weights);
}

// Whether there is a surface where the segment from `origin` along `direction` meets the plane of the cut-out triangle number `cut`.
COLD bool stops_cut(Coverage coverage, unsigned cut, Corners corners, Vec3 origin, Vec3 direction) {
    const float4 a = {corners.a.x, corners.a.y, corners.a.z, 0.0f}, b = {corners.b.x, corners.b.y, corners.b.z, 0.0f},
                 c = {corners.c.x, corners.c.y, corners.c.z, 0.0f};
    const RayShear ray = ray_shear(origin, direction);
    Sheared sheared;
    Weights weights;
    const bool may = ray.axis & 1   ? may_meet_corners<1>(ray, a, b, c, sheared)
                     : ray.axis & 2 ? may_meet_corners<2>(ray, a, b, c, sheared)
                                    : may_meet_corners<0>(ray, a, b, c, sheared);
    return may && weigh(sheared, weights) &&
           covers(coverage, cut, (float)(weights.v / weights.det), (float)(weights.w / weights.det));
}

// The same for any triangle.
template <class Handle>
DEVICE bool stops(const Coverage *coverage, const Handle &triangle, const Corners &corners, Vec3 origin, Vec3 direction) {
    if (coverage == nullptr)
        return true;
    const unsigned cut = triangle_cut(triangle);
    return cut == 0 || stops_cut(*coverage, cut, corners, origin, direction);
}
