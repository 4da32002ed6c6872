// CUDA's vector types, with CUDA's alignment: those of two and four components are loaded whole.
#pragma once

#define EMULATOR_VECTORS(base, component)                                                                                        \
    struct alignas(2 * sizeof(component)) base##2 {                                                                              \
        component x, y;                                                                                                          \
    };                                                                                                                           \
    struct base##3 {                                                                                                             \
        component x, y, z;                                                                                                       \
    };                                                                                                                           \
    struct alignas(sizeof(component) < 8 ? 4 * sizeof(component) : 16) base##4 {                                                 \
        component x, y, z, w;                                                                                                    \
    };                                                                                                                           \
    [[maybe_unused]] static inline base##2 make_##base##2(component x, component y) {                                            \
        return {x, y};                                                                                                           \
    }                                                                                                                            \
    [[maybe_unused]] static inline base##3 make_##base##3(component x, component y, component z) {                               \
        return {x, y, z};                                                                                                        \
    }                                                                                                                            \
    [[maybe_unused]] static inline base##4 make_##base##4(component x, component y, component z, component w) {                  \
        return {x, y, z, w};                                                                                                     \
    }

EMULATOR_VECTORS(uchar, unsigned char)
EMULATOR_VECTORS(ushort, unsigned short)
EMULATOR_VECTORS(int, int)
EMULATOR_VECTORS(float, float)
EMULATOR_VECTORS(double, double)
EMULATOR_VECTORS(longlong, long long)
EMULATOR_VECTORS(ulonglong, unsigned long long)

#undef EMULATOR_VECTORS
