// Ambient light. Twin of ambient.rs.
#pragma once

#include "cuda/prelude.cuh"

// What a surface receives that faces the unit vector `n`.
DEVICE Vec3 ambient_at(const Scene &scene, Vec3 n) {
    if (!scene.environment.lights)
        return scene.ambient;
    const float *terms = scene.environment.terms;
    const float powers[8] = {n.x, n.y, n.z, n.x * n.y, n.y * n.z, n.z * n.x, n.z * n.z, n.x * n.x - n.y * n.y};
    Vec3 sum = {terms[0], terms[1], terms[2]};
    for (unsigned k = 0; k < 8; ++k)
        sum = sum + powers[k] * Vec3{terms[3 * k + 3], terms[3 * k + 4], terms[3 * k + 5]};
    return max(sum, Vec3{});
}
