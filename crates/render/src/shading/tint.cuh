// Textures and vertex colours, which give the coefficients of formula (1) at a surface point: twin of tint.rs.
#pragma once

#include "cuda/rays.cuh"

// The inputs of tints. By value: taking the address of a kernel's argument would make all its loads slow.
struct TintSources {
    const Indices *indices;
    const Uv *uvs;
    const Vec3 *colors;
    const Texture *textures;
    const float *srgb;
};

// The two texels on either side of a position, and the fraction of the way to the second.
struct Neighbours {
    int first, second;
    float share;
};

DEVICE int texel_at(int index, int last, unsigned wrap) {
    if (wrap == Texture::REPEAT)
        return index < 0 ? last : index > last ? 0 : index;
    return index < 0 ? 0 : index > last ? last : index;
}

// The two texels of a row or column of `size` whose centres are on either side of `place`.
DEVICE Neighbours neighbours(float place, unsigned size, unsigned wrap) {
    // 1. Into the image.
    float inside = place;
    if (wrap == Texture::REPEAT) {
        inside = place - floorf(place);
    } else if (wrap == Texture::MIRROR) {
        const float twice = place - 2.0f * floorf(0.5f * place);
        inside = twice > 1.0f ? 2.0f - twice : twice;
    }
    // Also if the position is infinite or NaN.
    inside = inside > 0.0f ? inside < 1.0f ? inside : 1.0f : 0.0f;
    // 2. In texels, counted from the centre of the first.
    const float middle = inside * (float)size - 0.5f;
    const int first = __float2int_rd(middle), last = (int)size - 1;
    // 3. Beyond the border the image continues with its opposite side, or with itself.
    return Neighbours{texel_at(first, last, wrap), texel_at(first + 1, last, wrap), middle - (float)first};
}

// From `a` to `b`; exactly `a` where both are the same.
DEVICE Vec3 between(Vec3 a, Vec3 b, float share) { return a + share * (b - a); }

DEVICE Vec3 texel(const float *srgb, const Texture &texture, int column, int row) {
    const unsigned rgba = __ldg(texture.texels + (unsigned long long)row * texture.size[0] + column);
    return Vec3{__ldg(srgb + (rgba & 255)), __ldg(srgb + (rgba >> 8 & 255)), __ldg(srgb + (rgba >> 16 & 255))};
}

// The image's colour at (u, v): (0, 0) is its upper left corner, (1, 1) its lower right one.
DEVICE Vec3 sampled(const float *srgb, const Texture &texture, float u, float v) {
    const Neighbours x = neighbours(u, texture.size[0], texture.wrap[0]), y = neighbours(v, texture.size[1], texture.wrap[1]);
    const Vec3 upper = between(texel(srgb, texture, x.first, y.first), texel(srgb, texture, x.second, y.first), x.share);
    const Vec3 lower = between(texel(srgb, texture, x.first, y.second), texel(srgb, texture, x.second, y.second), x.share);
    return between(upper, lower, y.share);
}

// The interpolated value of the vertices of the triangle at `hit`.
DEVICE float interpolated(const Hit &hit, float a, float b, float c) { return (1.0f - hit.u - hit.v) * a + hit.u * b + hit.v * c; }

// The product of texture and vertex colour at `hit`.
DEVICE Vec3 tint_at(const TintSources &sources, const Material &material, const Hit &hit) {
    const unsigned *vertices = sources.indices[hit.triangle].vertices;
    Vec3 tint = splat(1.0f);
    if (material.texture != Material::NO_TEXTURE) {
        const Texture &texture = sources.textures[material.texture];
        const Uv a = sources.uvs[vertices[0]], b = sources.uvs[vertices[1]], c = sources.uvs[vertices[2]];
        const float u = interpolated(hit, a.u, b.u, c.u), v = interpolated(hit, a.v, b.v, c.v);
        tint = sampled(sources.srgb, texture, texture.u_axis[0] * u + texture.v_axis[0] * v + texture.translation[0],
                       texture.u_axis[1] * u + texture.v_axis[1] * v + texture.translation[1]);
    }
    if (sources.colors == nullptr)
        return tint;
    const Vec3 a = sources.colors[vertices[0]], b = sources.colors[vertices[1]], c = sources.colors[vertices[2]];
    return tint * ((1.0f - hit.u - hit.v) * a + hit.u * b + hit.v * c);
}

// Sets `own` to the material with the coefficients that a tint gives it.
DEVICE void set_tint(const Material *material, const Vec3 &tint, Material *own) {
    own->ka = material->ka * tint;
    own->kd = material->kd * tint;
    own->ks = material->ks + material->ks_tinted * tint;
    own->emission = material->emission + material->emission_tinted * tint;
    own->shininess = material->shininess;
    own->catcher = material->catcher;
    own->number = material->number;
}

// Sets `own` to the material with its coefficients at `hit`.
COLD void tint_material(TintSources sources, const Material *material, Hit hit, Material *own) {
    set_tint(material, tint_at(sources, *material, hit), own);
}

// The hits of the samples of a pixel: `count` of them, `stride` apart; those whose bits are set in `shared` count.
struct SharedHits {
    const Hit *hits;
    unsigned long long stride;
    unsigned count, shared;
};

// Sets `own` to the material with the mean of its coefficients at these hits; leaves it without any.
COLD void tint_by_all(TintSources sources, const Material *material, SharedHits all, Material *own) {
    Vec3 sum = splat(0.0f);
    float count = 0.0f;
    for (unsigned sample = 0; sample < all.count; ++sample) {
        const Hit hit = load_hit(all.hits + sample * all.stride, 0);
        if ((all.shared >> sample & 1) == 0 || hit.triangle == Hit::NONE)
            continue;
        sum = sum + tint_at(sources, *material, hit);
        count += 1.0f;
    }
    if (count > 0.0f)
        set_tint(material, sum / count, own);
}

// The inputs of the tints of a scene.
DEVICE TintSources tint_sources(const Scene &scene) { return {scene.indices, scene.uvs, scene.colors, scene.textures, scene.srgb}; }

// The material at `hit`: that of its triangle, or `own` if it has a tint. So a material without one takes no registers for
// coefficients.
DEVICE const Material *material_at(const Scene &scene, const Hit &hit, Material &own) {
    const Material *material = scene.materials + __ldg(scene.triangle_materials + hit.triangle);
    if (!material->tinted)
        return material;
    tint_material(tint_sources(scene), material, hit, &own);
    return &own;
}
