// What is left of a light at a distance: twin of mod.rs.
#pragma once

#include "cuda/prelude.cuh"

// What is left of a light at `distance`, over pi where that is its unit.
DEVICE float falloff(const Light &light, float distance) {
    if (!light.inverse_square)
        return 1.0f;
    return light.kind == Light::DIRECTIONAL ? FRAC_1_PI : FRAC_1_PI / (distance * distance);
}
