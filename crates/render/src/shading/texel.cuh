// What the sample of a pixel sees of an image of a material: twin of texel.rs.
#pragma once

#include "accel/alpha_mask.cuh"
#include "cuda/warp.cuh"
#include "footprint.cuh"
#include "textures/lookup.cuh"

// The inputs of images and tints. By value: taking the address of a kernel's argument would make all its loads slow.
struct TintSources {
    Triangles triangles;
    const Indices *indices;
    const Vec3 *normals;
    const Uv *uvs;
    const Vec3 *colors;
    const Texture *textures;
    const float *codes;
    const FacetShare *facet_table;
    AlphaMask alpha_mask;
};

// The ray that sees a surface point, or that of another sample of its pixel, and the cone around it.
struct Sighting {
    Vec3 origin, direction;
    Cone cone;
    // Whether it is in a mirror.
    bool mirrored;
};

// The axes of the footprint at `hit`, in texture coordinates.
DEVICE Axes axes_at(const Triangles &triangles, const Sighting &from, const Hit &hit, Uv a, Uv b, Uv c) {
    if (is_point(from.cone))
        return Axes{};
    const Corners corners = corners_at(triangles, hit.triangle);
    const Vec3 position = (1.0f - hit.u - hit.v) * corners.a + hit.u * corners.b + hit.v * corners.c;
    const Vec3 direction = direction_to(position, Ray{from.origin, from.direction, INFINITE}, from.cone);
    return footprint_axes(direction, cone_after(from.cone, hit.t).width, corners, a, b, c);
}

// Texture coordinates as the image has them: a place or, without the translation, a step.
DEVICE Uv in_image(const Texture &texture, Uv at) {
    return Uv{texture.u_axis[0] * at.u + texture.v_axis[0] * at.v, texture.u_axis[1] * at.u + texture.v_axis[1] * at.v};
}

// The interpolated value of the vertices of the triangle at `hit`.
DEVICE float interpolated(const Hit &hit, float a, float b, float c) { return (1.0f - hit.u - hit.v) * a + hit.u * b + hit.v * c; }

// The vertices of the triangle at `hit`.
DEVICE const unsigned *vertices_at(const TintSources &sources, const Hit &hit) {
    return sources.indices[stored_index(sources.triangles, hit.triangle)].vertices;
}

// The value of texture number `number` at `hit`.
DEVICE Vec3 texel_at(const TintSources &sources, unsigned number, const Sighting &from, const Hit &hit) {
    const unsigned *vertices = vertices_at(sources, hit);
    const Texture &texture = sources.textures[number];
    const Uv a = sources.uvs[vertices[0]], b = sources.uvs[vertices[1]], c = sources.uvs[vertices[2]];
    const Uv uv = in_image(texture, Uv{interpolated(hit, a.u, b.u, c.u), interpolated(hit, a.v, b.v, c.v)});
    const Axes axes = axes_at(sources.triangles, from, hit, a, b, c);
    return filtered(sources.codes, texture, Uv{uv.u + texture.translation[0], uv.v + texture.translation[1]},
                    Axes{in_image(texture, axes.a), in_image(texture, axes.b)});
}

// Those of a scene.
DEVICE TintSources tint_sources(const Scene &scene) {
    return {scene.triangles, scene.indices, scene.normals, scene.uvs, scene.colors, scene.textures, scene.codes,
            scene.facet_table, scene.alpha_mask};
}

// What ray number `ray` goes along.
DEVICE Sighting sighting_of(const Rays &rays, unsigned ray) {
    const Ray along = ray_at(rays, ray);
    return Sighting{along.origin, along.direction, cone_of(rays, ray), is_mirrored(rays, ray)};
}

// The hits of the samples of a pixel: `count` of them, `stride` apart; those whose bits are set in `shared` count.
struct SharedHits {
    const Hit *hits;
    unsigned long long stride;
    unsigned count, shared;
};

// What the samples of the camera's pixels see, if they have several.
struct Samples {
    const Hit *hits;
    unsigned first;
    unsigned long long pixels;
    unsigned count;
};

// Those of its pixel that are shaded with a ray; none if `samples` are none.
DEVICE SharedHits shared_hits(const Rays &rays, unsigned ray, const Samples &samples) {
    if (samples.hits == nullptr)
        return SharedHits{};
    const unsigned shared = rays.list == nullptr ? ALL_LANES : __ldg(&rays.list[ray].shared);
    return SharedHits{samples.hits + (pixel_of(rays, ray) - samples.first), samples.pixels, samples.count, shared};
}
