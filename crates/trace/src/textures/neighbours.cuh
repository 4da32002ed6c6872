// The texels around a position on one axis of an image: twin of neighbours.rs.
#pragma once

#include "cuda/prelude.cuh"

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
