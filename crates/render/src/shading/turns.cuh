// Angles and logarithms by polynomials of our own: twin of turns.rs.
#pragma once

#include "cuda/prelude.cuh"

// The angle of the point (x, y), counted from the x axis, as a share of a whole turn, from -0.5 to 0.5; 0 for the origin. Within 1e-7.
DEVICE float turns(float y, float x) {
    const float along = fabsf(x), aside = fabsf(y);
    const float low = aside > along ? along : aside, high = aside > along ? aside : along;
    const float ratio = high > 0.0f ? low / high : 0.0f;
    const bool large = ratio > TANGENT_OF_EIGHTH;
    const float first = large ? EIGHTH_OF_TURN : 0.0f, tangent = large ? (ratio - 1.0f) / (ratio + 1.0f) : ratio;
    const float square = tangent * tangent;
    const float sum = ((ARC_TANGENT_9 * square + ARC_TANGENT_7) * square + ARC_TANGENT_5) * square + ARC_TANGENT_3;
    const float eighth = first + TURN_OF_RADIAN * (tangent + tangent * (square * sum));
    const float quarter = aside > along ? 0.25f - eighth : eighth;
    const float half = x < 0.0f ? 0.5f - quarter : quarter;
    return y < 0.0f ? -half : half;
}

// The same in radians, from -pi to pi.
DEVICE float angle(float y, float x) { return TAU * turns(y, x); }

// The natural logarithm of a finite number from 1 on.
DEVICE float logarithm(float number) {
    const unsigned above = __float_as_uint(number) - ROOT_OF_HALF_BITS;
    const unsigned exponent = above / F32_EXPONENT_STEP;
    const float rest = __uint_as_float(above % F32_EXPONENT_STEP + ROOT_OF_HALF_BITS);
    const float part = (rest - 1.0f) / (rest + 1.0f);
    const float square = part * part;
    const float sum = (((square / 9.0f + 1.0f / 7.0f) * square + 1.0f / 5.0f) * square + 1.0f / 3.0f) * square;
    return (float)exponent * LN_2 + 2.0f * (part + part * sum);
}
