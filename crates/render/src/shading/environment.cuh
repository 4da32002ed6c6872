// What rays see that leave the scene. Twin of environment.rs, with its steps.
#pragma once

#include "shading/tint.cuh"
#include "shading/turns.cuh"

// Texels of an environment.
struct RadianceTexels {
    const Vec3 *texels;
};

DEVICE Vec3 texel(const RadianceTexels &level, unsigned long long index) {
    const float *channels = reinterpret_cast<const float *>(level.texels + index);
    return Vec3{__ldg(channels), __ldg(channels + 1), __ldg(channels + 2)};
}

// An image and its means.
struct Levels {
    const EnvironmentLevel *levels;
    // Number of means.
    unsigned lower;
};

DEVICE Vec3 radiance_at(const Levels &image, Uv place, unsigned level) {
    const unsigned wrap[2] = {Texture::REPEAT, Texture::CLAMP};
    const EnvironmentLevel *of = image.levels + level;
    return bilinear(RadianceTexels{of->texels}, __ldg(&of->size[0]), __ldg(&of->size[1]), wrap, place);
}

// The mean radiance that a cone of this angle around `direction` sees in an image, without the sun, which is a light.
DEVICE Vec3 radiance_without_sun(const Environment *environment, const Levels &image, Vec3 direction, float spread) {
    // 1. Where?
    const float east = dot(environment->east, direction), up = dot(environment->up, direction), north = dot(environment->north, direction);
    const float across = sqrtf(east * east + north * north);
    const Uv place = {0.5f + turns(east, north), 0.5f - 2.0f * turns(up, across)};

    // 2. How much of it?
    const float width = spread * (2.0f * TURN_OF_RADIAN) * (float)__ldg(&image.levels->size[1]);
    Vec3 seen;
    if (width > 1.0f) {
        const LevelOfDetail detail = level_of(width, image.lower);
        seen = radiance_at(image, place, detail.level);
        if (detail.share > 0.0f)
            seen = between(seen, radiance_at(image, place, detail.level + 1), detail.share);
    } else {
        seen = radiance_at(image, place, 0);
    }
    return seen;
}

// How much fainter a disc is with an edge as wide as `spread`, so that it gives as much light.
DEVICE float faded(float radius, float spread) {
    const float end = radius + 0.5f * spread;
    return spread <= 2.0f * radius ? 12.0f * radius * radius / (12.0f * radius * radius + spread * spread)
                                   : 3.0f * radius * radius * spread / (end * end * end);
}

// The same with a share `shown` of the sun. A function of its own, so that its callers keep their registers.
COLD Vec3 environment_radiance(const Environment *environment, Vec3 direction, float spread, float shown) {
    const Vec3 seen = radiance_without_sun(environment, Levels{environment->levels, environment->lower}, direction, spread);
    // 3. The sun.
    if (environment->sun_radius < 0.0f)
        return seen;
    const float inside = environment->sun_radius - length(direction - environment->sun);
    const float share = spread > 0.0f ? fminf(fmaxf(inside / spread + 0.5f, 0.0f), 1.0f) : inside >= 0.0f ? 1.0f : 0.0f;
    return share > 0.0f ? between(seen, shown * environment->sun_radiance, share * faded(environment->sun_radius, spread)) : seen;
}

// What surfaces receive from outside of the scene along a direction, but for lights.
DEVICE Vec3 surroundings(const Environment &environment, Vec3 direction, float spread) {
    const Levels gathered = {environment.gathered, environment.gathered_lower};
    return environment.levels != nullptr ? radiance_without_sun(&environment, gathered, direction, spread) : splat(0.0f);
}
