// End points of the shadow rays towards an area light: twin of sampling.rs.
#pragma once

#include "cuda/prelude.cuh"

// A stream of stratified points in the unit cube, different for each key.
struct Pattern {
    unsigned seeds[4];
};

// The finaliser of SplitMix64.
DEVICE unsigned long long mix(unsigned long long value) {
    value += GOLDEN_RATIO;
    value = (value ^ (value >> 30)) * MIX_1;
    value = (value ^ (value >> 27)) * MIX_2;
    return value ^ (value >> 31);
}

// Random bits of `key` (a pixel or light point), light number `light` and the user's `seed`.
DEVICE unsigned long long random_bits(unsigned long long seed, unsigned long long key, unsigned light) {
    return mix(seed ^ mix(key ^ mix((unsigned long long)light + 1)));
}

DEVICE Pattern pattern_of(unsigned long long seed, unsigned long long key, unsigned light) {
    const unsigned long long base = random_bits(seed, key, light);
    return Pattern{{(unsigned)mix(base), (unsigned)mix(base + 1), (unsigned)mix(base + 2), (unsigned)mix(base + 3)}};
}

// Here the first binary digit after the point is the least significant bit.

// Owen scrambling of binary digits.
DEVICE unsigned scramble(unsigned digits, unsigned seed) {
    unsigned x = digits + seed;
    x ^= x * OWEN_1;
    x ^= x * OWEN_2;
    x ^= x * OWEN_3;
    x ^= x * OWEN_4;
    return x;
}

// Second dimension of Sobol's sequence: the polynomial of the index at 1 + x.
DEVICE unsigned sobol_1(unsigned index) {
    unsigned digits = index;
    digits ^= digits >> 16;
    digits ^= (digits & UPPER_BYTES) >> 8;
    digits ^= (digits & UPPER_NIBBLES) >> 4;
    digits ^= (digits & UPPER_PAIRS) >> 2;
    digits ^= (digits & UPPER_BITS) >> 1;
    return digits;
}

// Third dimension of Sobol's sequence. The loop runs over all bits, so that the compiler knows its constants; lanes would have to
// wait for a table.
DEVICE unsigned sobol_2(unsigned index) {
    unsigned direction = 1, next = 3, result = 0;
    UNROLL
    for (int bit = 0; bit < 32; ++bit) {
        result ^= index >> bit & 1 ? direction : 0;
        const unsigned after = next ^ direction ^ (direction << 2);
        direction = next;
        next = after;
    }
    return result;
}

DEVICE float unit_interval(unsigned digits, unsigned seed) {
    return (float)(__brev(scramble(digits, seed)) >> (32 - SAMPLE_DIGITS)) * LAST_DIGIT;
}

// Point `index` of the sequence, each component in [0, 1).
DEVICE Vec3 pattern_point(const Pattern &pattern, unsigned index) {
    index = __brev(scramble(__brev(index), pattern.seeds[0]));
    return Vec3{unit_interval(index, pattern.seeds[1]), unit_interval(sobol_1(index), pattern.seeds[2]),
                unit_interval(sobol_2(index), pattern.seeds[3])};
}

// A volume-preserving map from the cube to the unit ball.
DEVICE Vec3 in_ball(Vec3 u) {
    const float z = 2.0f * u.x - 1.0f;
    float sine, cosine;
    sincosf(TAU * u.y, &sine, &cosine);
    const float ring = sqrtf(fmaxf(1.0f - z * z, 0.0f));
    return cbrtf(u.z) * Vec3{ring * cosine, ring * sine, z};
}

// Whether the light is an area light.
DEVICE bool has_size(const Light &light) {
    return light.kind >= Light::SPHERE || (light.kind == Light::DIRECTIONAL && light.radius > 0.0f);
}

// The centre of a light; a directional light lies `reach` away from `from`.
DEVICE Vec3 light_center(const Light &light, Vec3 from, float reach) {
    return light.kind == Light::DIRECTIONAL ? from - reach * light.direction : light.position;
}

// The point of a light that the numbers `u` in [0, 1)³ select; a directional light lies `reach` away from `from`.
DEVICE Vec3 light_point(const Light &light, Vec3 from, float reach, Vec3 u) {
    if (light.kind == Light::POINT || light.kind == Light::SPHERE)
        return light.position + light.radius * in_ball(u);
    if (light.kind == Light::DISK || light.kind == Light::DIRECTIONAL) {
        // A directional light comes from a disk, too. One branch, since the sine takes many instructions.
        const float radius = light.kind == Light::DIRECTIONAL ? reach * light.radius : light.radius;
        float sine, cosine;
        sincosf(TAU * u.x, &sine, &cosine);
        return light_center(light, from, reach) + radius * sqrtf(u.y) * (cosine * light.half_u + sine * light.half_v);
    }
    if (light.kind == Light::RECTANGLE)
        return light.position + (2.0f * u.x - 1.0f) * light.half_u + (2.0f * u.y - 1.0f) * light.half_v;
    return light.position;
}

// Where a shadow ray to a point of a light ends: there, or in the plane that touches an emissive ball where it is nearest.
DEVICE Vec3 before_body(const Light &light, Vec3 from, Vec3 target) {
    if (light.body == 0.0f)
        return target;
    const Vec3 way = light.position - from, to = target - from;
    const float distance = length(way);
    const float near = larger(distance - light.body, BEFORE_BODY * distance) * distance;
    const float along = dot(way, to);
    return along > near ? from + near / along * to : target;
}

// The centre of what is seen of a light from `from`, if a directional one is `reach` away: shadow rays end in a plane through it.
DEVICE Vec3 seen_center(const Light &light, Vec3 from, float reach) { return before_body(light, from, light_center(light, from, reach)); }

// The radius of the disc that an emissive ball of the radius `body` covers in that plane, at the distance `near`.
DEVICE float covered_by_body(float body, float near) { return body * sqrtf(near / (near + 2.0f * body)); }

// The radius of a light's disc. `center` is the way to its middle.
DEVICE float disc_radius(const Light &light, Vec3 center, float reach) {
    if (light.kind == Light::DIRECTIONAL)
        return reach * light.radius;
    return light.body > 0.0f ? covered_by_body(light.body, length(center)) : light.radius;
}

// The distance of a directional light from `from`: twin of prepared.rs.
DEVICE float scene_reach(const Scene &scene, Vec3 from) {
    return scene.far + 2.0f * element_sum(abs(from - scene.center));
}
