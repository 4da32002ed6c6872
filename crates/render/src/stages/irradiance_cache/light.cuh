// Light that arrives at a surface point: twin of light.rs.
#pragma once

#include "cuda/prelude.cuh"

// The mean radiance on a surface whose normal differs by this.
DEVICE Vec3 light_at(const SurfaceLight &light, Vec3 turned) {
    return min(light.mean + turned.x * light.tilt[0] + turned.y * light.tilt[1] + turned.z * light.tilt[2], light.most);
}

// Adds a share of other light, on a surface whose normal differs by this.
DEVICE void add_light(SurfaceLight &light, float share, const SurfaceLight &other, Vec3 turned) {
    light.mean = light.mean + share * light_at(other, turned);
    for (unsigned axis = 0; axis < 3; ++axis)
        light.tilt[axis] = light.tilt[axis] + share * other.tilt[axis];
    light.most = max(light.most, other.most);
}

// Adds radiance that arrives along a direction, times its weight.
DEVICE void take_light(SurfaceLight &light, Vec3 normal, Vec3 direction, Vec3 weighted) {
    const float cosine = dot(direction, normal);
    const Vec3 across = (direction - cosine * normal) / larger(cosine, MIN_TILT_COSINE);
    light.mean = light.mean + weighted;
    light.tilt[0] = light.tilt[0] + across.x * weighted;
    light.tilt[1] = light.tilt[1] + across.y * weighted;
    light.tilt[2] = light.tilt[2] + across.z * weighted;
}
