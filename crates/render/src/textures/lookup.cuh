// What a footprint sees of a texture. Twin of lookup.rs, with its steps.
#pragma once

#include "footprint.cuh"
#include "textures/neighbours.cuh"

// From `a` to `b`; exactly `a` where both are the same.
DEVICE Vec3 between(Vec3 a, Vec3 b, float share) { return a + share * (b - a); }

// Texels of the image, and the linear values of their codes.
struct ImageTexels {
    const unsigned *texels;
    const float *codes;
};

DEVICE Vec3 texel(const ImageTexels &image, unsigned long long index) {
    const unsigned rgba = __ldg(image.texels + index);
    return Vec3{__ldg(image.codes + (rgba & 255)), __ldg(image.codes + (rgba >> 8 & 255)), __ldg(image.codes + (rgba >> 16 & 255))};
}

// Texels of a lower level.
struct LevelTexels {
    const unsigned long long *texels;
};

DEVICE float channel(unsigned long long texel, unsigned shift) {
    return (float)((unsigned)(texel >> shift) & ((1u << TEXEL_BITS) - 1)) / TEXEL_ONE;
}

DEVICE Vec3 texel(const LevelTexels &level, unsigned long long index) {
    const unsigned long long packed = __ldg(level.texels + index);
    return Vec3{channel(packed, 0), channel(packed, TEXEL_BITS), channel(packed, 2 * TEXEL_BITS)};
}

// The four nearest of the texels of an image of this size, interpolated.
template <class Texels>
DEVICE Vec3 bilinear(const Texels &texels, unsigned width, unsigned height, const unsigned *wrap, Uv place) {
    const Neighbours x = neighbours(place.u, width, wrap[0]), y = neighbours(place.v, height, wrap[1]);
    const unsigned long long above = (unsigned long long)y.first * width, below = (unsigned long long)y.second * width;
    const Vec3 upper = between(texel(texels, above + x.first), texel(texels, above + x.second), x.share);
    const Vec3 lower = between(texel(texels, below + x.first), texel(texels, below + x.second), x.share);
    return between(upper, lower, y.share);
}

// The value of a level at `place`: (0, 0) is its upper left corner, (1, 1) its lower right one. A function of its own, so that its callers
// keep their registers.
COLD Vec3 at_level(const float *codes, const Texture *texture, Uv place, unsigned level) {
    if (level == 0)
        return bilinear(ImageTexels{texture->texels, codes + texture->first_code}, texture->size[0], texture->size[1], texture->wrap, place);
    const TextureLevel *lower = texture->levels + (level - 1);
    return bilinear(LevelTexels{lower->texels}, __ldg(&lower->size[0]), __ldg(&lower->size[1]), texture->wrap, place);
}

// The part of a footprint inside of the image, along one axis: its share of the whole, and its middle.
struct Clipped {
    float share, middle;
};

// That of a footprint around `place` with these diameters. Beyond the border of a clamped texture all is as at the border.
DEVICE Clipped clipped(unsigned wrap, float place, float a, float b) {
    const float reach = 0.5f * (fabsf(a) + fabsf(b));
    const float low = place - reach, high = place + reach;
    if (wrap != Texture::CLAMP || reach == 0.0f || (low >= 0.0f && high <= 1.0f))
        return Clipped{1.0f, place};
    const float from = fminf(fmaxf(low, 0.0f), 1.0f), to = fminf(fmaxf(high, 0.0f), 1.0f);
    return Clipped{0.5f * (to - from) / reach, 0.5f * (from + to)};
}

// A level, and the fraction of the way to the next one.
struct LevelOfDetail {
    unsigned level;
    float share;
};

// The level whose texels are the largest that are not wider than `width` texels of the image, at least 1.
DEVICE LevelOfDetail level_of(float width, unsigned lower) {
    const unsigned bits = __float_as_uint(width);
    const unsigned level = bits / F32_EXPONENT_STEP - F32_EXPONENT_BIAS;
    if (level >= lower)
        return LevelOfDetail{lower, 0.0f};
    const float mantissa = __uint_as_float(bits % F32_EXPONENT_STEP + F32_EXPONENT_BIAS * F32_EXPONENT_STEP);
    return LevelOfDetail{level, mantissa - 1.0f};
}

// The mean of what the ellipse with these axes around `place` sees. Axes are whole ones, conjugate diameters.
DEVICE Vec3 filtered(const float *codes, const Texture &texture, Uv place, const Axes &axes) {
    // 1. The ellipse in texels: half the sum and half the difference of the eigenvalues.
    const float width = (float)texture.size[0], height = (float)texture.size[1];
    const Clipped x = clipped(texture.wrap[0], place.u, axes.a.u, axes.b.u), y = clipped(texture.wrap[1], place.v, axes.a.v, axes.b.v);
    const Uv a = {axes.a.u * x.share * width, axes.a.v * y.share * height};
    const Uv b = {axes.b.u * x.share * width, axes.b.v * y.share * height};
    const float uu = a.u * a.u + b.u * b.u, vv = a.v * a.v + b.v * b.v, uv = a.u * a.v + b.u * b.v;
    const float middle = 0.5f * (uu + vv), aside = 0.5f * (uu - vv);
    const float apart = sqrtf(aside * aside + uv * uv);
    const float major = sqrtf(middle + apart);

    // 2. Magnified.
    if (major <= 1.0f)
        return at_level(codes, &texture, place, 0);
    // A footprint beyond all numbers sees everything, the only texel of the last level.
    if (!is_finite(major))
        return at_level(codes, &texture, place, texture.level_count);

    // 3. Probes along the major axis.
    const float most = (float)MAX_PROBES;
    const float minor = fmaxf(sqrtf(fmaxf(middle - apart, 0.0f)), fmaxf(major / most, 1.0f));
    const float count = fminf(ceilf(major / minor), most);
    const Uv along = aside > 0.0f ? Uv{aside + apart, uv} : Uv{uv, apart - aside};
    const float length = sqrtf(along.u * along.u + along.v * along.v);
    const float scale = major / length;
    const Uv axis = length > 0.0f ? Uv{scale * along.u / width, scale * along.v / height} : Uv{0.0f, 0.0f};
    const LevelOfDetail detail = level_of(minor, texture.level_count);
    Vec3 sum = splat(0.0f);
    ROLLED for (unsigned probe = 0; probe < (unsigned)count; ++probe) {
        const float way = ((float)probe + 0.5f) / count - 0.5f;
        const Uv at = {x.middle + way * axis.u, y.middle + way * axis.v};

        // 4. Between two levels.
        const Vec3 fine = at_level(codes, &texture, at, detail.level);
        const Vec3 coarse = detail.share > 0.0f ? at_level(codes, &texture, at, detail.level + 1) : fine;
        sum = sum + between(fine, coarse, detail.share);
    }
    return sum / count;
}
