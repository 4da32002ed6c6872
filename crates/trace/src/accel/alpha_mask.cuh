// Where surfaces are that are cut out, and how opaque are those that light goes through: twin of alpha_mask/mod.rs, bit by bit.
//
// Most scenes are opaque, and what cut-outs need takes registers from loops over triangles even where it is never used. Where that costs time, the
// kernels that test triangles are in two modules, without and with ALPHA_TEST: `<module>_alpha_test.cu` includes `kernel.cu`. See gpu/per_structure.rs.
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
DEVICE bool covers(const AlphaMask &alpha_mask, unsigned cut, float u, float v) {
    const CutTriangle &own = alpha_mask.triangles[cut - 1];
    const Mask &mask = alpha_mask.masks[own.mask];
    // NaN is nothing.
    return opacity_of(own, mask, u, v) >= mask.limit;
}

// How opaque a triangle is where it is hit, from 0 to 1.
DEVICE float opacity_at(const AlphaMask &alpha_mask, const Triangle *triangle, float u, float v) {
    const unsigned cut = alpha_mask.triangles != nullptr ? triangle_cut(triangle) : 0;
    if (cut == 0)
        return 1.0f;
    const CutTriangle &own = alpha_mask.triangles[cut - 1];
    const Mask &mask = alpha_mask.masks[own.mask];
    return mask.blends ? fminf(opacity_of(own, mask, u, v) / OPAQUE, 1.0f) : 1.0f;
}

// The same for a hit, by its scaled weights.
COLD bool covers_hit(AlphaMask alpha_mask, unsigned cut, Weights weights) {
    return covers(alpha_mask, cut, (float)(weights.v / weights.det), (float)(weights.w / weights.det));
}

// Where the triangles of a structure are cut out; null if all of them are opaque.
template <class Structure>
DEVICE const AlphaMask *alpha_mask_of(const Structure &structure) {
    return ALPHA_TEST && structure.alpha_mask.triangles != nullptr ? &structure.alpha_mask : nullptr;
}

// The host takes a BVH in place of a grid where anything is cut out.
DEVICE const AlphaMask *alpha_mask_of(const Grid &) { return nullptr; }

// Whether there is a surface where a triangle is hit.
template <class Handle>
DEVICE bool has_surface(const AlphaMask *alpha_mask, const Handle &triangle, const Weights &weights) {
    if (alpha_mask == nullptr)
        return true;
    const unsigned cut = triangle_cut(triangle);
    return cut == 0 || covers_hit(*alpha_mask, cut, weights);
}

// Whether there is a surface where the segment from `origin` along `direction` meets the plane of the cut-out triangle number `cut`.
COLD bool stops_cut(AlphaMask alpha_mask, unsigned cut, Corners corners, Vec3 origin, Vec3 direction) {
    const float4 a = {corners.a.x, corners.a.y, corners.a.z, 0.0f}, b = {corners.b.x, corners.b.y, corners.b.z, 0.0f},
                 c = {corners.c.x, corners.c.y, corners.c.z, 0.0f};
    const RayShear ray = ray_shear(origin, direction);
    Sheared sheared;
    Weights weights;
    const bool may = ray.axis & 1   ? may_meet_corners<1>(ray, a, b, c, sheared)
                     : ray.axis & 2 ? may_meet_corners<2>(ray, a, b, c, sheared)
                                    : may_meet_corners<0>(ray, a, b, c, sheared);
    return may && weigh(sheared, weights) &&
           covers(alpha_mask, cut, (float)(weights.v / weights.det), (float)(weights.w / weights.det));
}

// The same for any triangle.
template <class Handle>
DEVICE bool stops(const AlphaMask *alpha_mask, const Handle &triangle, const Corners &corners, Vec3 origin, Vec3 direction) {
    if (alpha_mask == nullptr)
        return true;
    const unsigned cut = triangle_cut(triangle);
    return cut == 0 || stops_cut(*alpha_mask, cut, corners, origin, direction);
}
