// Rays and hits: twin of mod.rs.
#pragma once

#include "cuda/prelude.cuh"

#define INFINITE __uint_as_float(F32_INFINITY_BITS)

// The points origin + t · direction with 0 < t < t_max.
struct Ray {
    Vec3 origin, direction;
    float t_max;
};

DEVICE Hit hit_nothing() { return Hit{INFINITE, 0.0f, 0.0f, Hit::NONE}; }

// Hits are moved sixteen bytes at a time.
DEVICE Hit load_hit(const Hit *hits, unsigned ray) {
    const uint4 bits = __ldg(reinterpret_cast<const uint4 *>(hits) + ray);
    return Hit{__uint_as_float(bits.x), __uint_as_float(bits.y), __uint_as_float(bits.z), bits.w};
}

DEVICE void store_hit(Hit *hits, unsigned ray, const Hit &hit) {
    reinterpret_cast<uint4 *>(hits)[ray] =
        uint4{__float_as_uint(hit.t), __float_as_uint(hit.u), __float_as_uint(hit.v), hit.triangle};
}
