// Directions of gather rays, and the bins into which they are sorted: twin of directions.rs.
#pragma once

#include "cuda/prelude.cuh"

// Two unit vectors that form a right-handed basis with the unit vector `n`.
DEVICE void basis(Vec3 n, Vec3 &tangent, Vec3 &other) {
    const float sign = n.z >= 0.0f ? 1.0f : -1.0f;
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    tangent = Vec3{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    other = Vec3{b, sign + n.y * n.y * a, -n.y};
}

// The direction above the z axis that the point (u, v) of the square [-1, 1]^2 stands for, and the weight of its cosine.
DEVICE Vec3 direction_above(float u, float v, float &weight) {
    const float uu = u * u, vv = v * v;
    const float across = sqrtf(1.0f - 0.5f * vv), along = sqrtf(1.0f - 0.5f * uu);
    const float height = sqrtf(larger((1.0f - uu) * (1.0f - vv), 0.0f));
    weight = (1.0f - 0.5f * uu - 0.5f * vv) / (across * along);
    return Vec3{u * across, v * along, height};
}

// The bin of a direction: its place in the octahedral map of all directions.
DEVICE unsigned direction_bin(Vec3 direction) {
    const float sum = fabsf(direction.x) + fabsf(direction.y) + fabsf(direction.z);
    float x = direction.x / sum, y = direction.y / sum;
    if (direction.z < 0.0f) {
        const float folded = (1.0f - fabsf(y)) * (x >= 0.0f ? 1.0f : -1.0f);
        y = (1.0f - fabsf(x)) * (y >= 0.0f ? 1.0f : -1.0f);
        x = folded;
    }
    const float side = (float)BINS_PER_SIDE;
    const unsigned column = (unsigned)fminf(fmaxf((0.5f * x + 0.5f) * side, 0.0f), side - 1.0f);
    const unsigned row = (unsigned)fminf(fmaxf((0.5f * y + 0.5f) * side, 0.0f), side - 1.0f);
    return row * BINS_PER_SIDE + column;
}
