// Images of normals: where a surface would face if it had the relief that an image stands for. Twin of normal_map.rs, with its steps.
#pragma once

#include "shading/texel.cuh"

// Unit vectors along the surface to the right of the image and to its top, across `smooth`. False where the image has no area.
DEVICE bool image_frame(const TintSources &sources, const Texture &texture, const Corners &corners, const Hit &hit, Vec3 smooth, Vec3 &right,
                        Vec3 &top) {
    const unsigned *vertices = vertices_at(sources, hit);
    const Uv a = sources.uvs[vertices[0]], b = sources.uvs[vertices[1]], c = sources.uvs[vertices[2]];
    const Uv p = in_image(texture, Uv{b.u - a.u, b.v - a.v}), q = in_image(texture, Uv{c.u - a.u, c.v - a.v});
    const Vec3 ab = corners.b - corners.a, ac = corners.c - corners.a;
    const float area = p.u * q.v - p.v * q.u;
    Vec3 along = area < 0.0f ? p.v * ac - q.v * ab : q.v * ab - p.v * ac;
    along = along / max_element(abs(along));
    const Vec3 across = along - dot(smooth, along) * smooth;
    const float square = length_squared(across);
    // Also where there are no numbers.
    if (!(area != 0.0f && square > MIN_SMOOTH_SQUARE))
        return false;
    right = across / sqrtf(square);
    const Vec3 other = cross(smooth, right);
    const bool mirrored = (dot(smooth, cross(ab, ac)) < 0.0f) != (area < 0.0f);
    top = mirrored ? other : -other;
    return true;
}

// Whether the back of a surface is seen: vertex normals say which side it is, without them the order of the corners. `facing` is the geometric
// normal on the viewer's side.
DEVICE bool shows_back(const TintSources &sources, const Corners &corners, const Hit &hit, Vec3 facing) {
    Vec3 smooth;
    float square;
    if (sources.normals != nullptr && smooth_at(hit, load_normals(sources.triangles, sources.normals, sources.indices, hit.triangle), smooth, square))
        return dot(smooth, facing) < 0.0f;
    return dot(cross(corners.b - corners.a, corners.c - corners.a), facing) < 0.0f;
}

// The unit normal by the image, where `smooth` is that without it: few materials have one, which is not worth registers everywhere.
COLD Vec3 mapped_normal(TintSources sources, const Material *material, Sighting from, Hit hit, Vec3 smooth) {
    // 1. What the image says.
    const Texture &texture = sources.textures[material->normal_texture];
    const Vec3 texel = texel_at(sources, material->normal_texture, from, hit);
    const float scale = material->normal_scale;
    const float x = scale * ((255.0f * texel.x - NORMAL_CODE_ZERO) / NORMAL_CODE_ONE);
    const float y = scale * ((255.0f * texel.y - NORMAL_CODE_ZERO) / NORMAL_CODE_ONE);
    const float z = fmaxf((255.0f * texel.z - NORMAL_CODE_ZERO) / NORMAL_CODE_ONE, 0.0f);
    if (x == 0.0f && y == 0.0f)
        return smooth;

    // 2. In the frame of the image on the surface.
    const Corners corners = corners_at(sources.triangles, hit.triangle);
    Vec3 right, top;
    if (!image_frame(sources, texture, corners, hit, smooth, right, top))
        return smooth;
    const Vec3 facing = surface_point(Ray{from.origin, from.direction, INFINITE}, hit, corners).normal;
    const float side = shows_back(sources, corners, hit, facing) ? -1.0f : 1.0f;
    Vec3 normal = z * smooth + side * (x * right + y * top);
    const float square = length_squared(normal);
    if (!(square > MIN_SMOOTH_SQUARE && is_finite(square)))
        return smooth;
    normal = normal / sqrtf(square);

    // 3. Turned to the viewer, as far as the normal without the image is.
    const Vec3 view = -from.direction;
    const float excess = dot(normal, view) - fminf(dot(smooth, view), 0.0f);
    if (excess >= 0.0f)
        return normal;
    const Vec3 seen = normal - excess * view;
    return seen / larger(length(seen), F32_MIN_POSITIVE);
}

// The mean over the hits of some samples; `own` without any.
COLD Vec3 mean_normal(TintSources sources, const Material *material, Sighting from, SharedHits all, Vec3 own) {
    Vec3 sum = splat(0.0f);
    for (unsigned sample = 0; sample < all.count; ++sample) {
        const Hit hit = load_hit(all.hits + sample * all.stride, 0);
        if ((all.shared >> sample & 1) == 0 || hit.triangle == Hit::NONE)
            continue;
        const Ray ray = {from.origin, from.direction, INFINITE};
        const Vec3 facing = surface_point(ray, hit, corners_at(sources.triangles, hit.triangle)).normal;
        const Vec3 smooth = shading_normal(sources.triangles, sources.normals, sources.indices, hit, facing);
        sum = sum + mapped_normal(sources, material, from, hit, smooth);
    }
    const float square = length_squared(sum);
    return square > MIN_SMOOTH_SQUARE ? sum / sqrtf(square) : own;
}

// The cosine of light along `direction`, which is `cosine` by the image, for a surface that is `smooth` without it. Where the light is low, what
// the relief adds fades to nothing at the horizon.
DEVICE float softened(Vec3 smooth, Vec3 direction, float cosine) {
    const float plain = dot(smooth, direction);
    if (cosine <= plain || plain >= LOW_LIGHT)
        return cosine;
    const float least = larger(plain, 0.0f), high = larger(plain, 0.0f) / LOW_LIGHT;
    return least + high * high * (3.0f - 2.0f * high) * (cosine - least);
}

// The normal nearest to `normal` about which `view` is mirrored to directions above the surface with the geometric normal `facing`: half-way
// between both.
COLD Vec3 mirroring(Vec3 normal, Vec3 facing, Vec3 view) {
    const Vec3 direction = 2.0f * dot(normal, view) * normal - view;
    const float least = fminf(MIN_MIRRORED_COSINE, 0.5f * dot(facing, view));
    const float height = dot(facing, direction);
    if (height >= least)
        return normal;
    const Vec3 raised = direction + (least - height) * facing;
    const Vec3 middle = raised / larger(length(raised), F32_MIN_POSITIVE) + view;
    const float square = length_squared(middle);
    return square > MIN_SMOOTH_SQUARE ? middle / sqrtf(square) : facing;
}
