// Bit operations, conversions and numeric functions, with the results that CUDA documents.
//
// A plain conversion from a float that the integer cannot represent is undefined in C++ and differs between host and device:
// kernels use __float2int_rz and similar functions, which saturate and turn NaN into 0 on both.
#pragma once

#include <limits>
#include <type_traits>

#include "collectives.h"

template <class T>
EMULATED T __ldg(const T *address) {
    return *address;
}

[[noreturn]] EMULATED void __trap() {
    emulator::fault("__trap() was called");
}

// Bit operations.
EMULATED int __popc(unsigned x) { return __builtin_popcount(x); }
EMULATED int __popcll(unsigned long long x) { return __builtin_popcountll(x); }
EMULATED int __ffs(int x) { return __builtin_ffs(x); }
EMULATED int __ffsll(long long x) { return __builtin_ffsll(x); }
EMULATED int __clz(int x) { return x == 0 ? 32 : __builtin_clz(static_cast<unsigned>(x)); }
EMULATED int __clzll(long long x) { return x == 0 ? 64 : __builtin_clzll(static_cast<unsigned long long>(x)); }

EMULATED unsigned __brev(unsigned x) {
    unsigned reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed |= (x >> bit & 1u) << (31 - bit);
    return reversed;
}

EMULATED unsigned long long __brevll(unsigned long long x) {
    return static_cast<unsigned long long>(__brev(static_cast<unsigned>(x))) << 32 | __brev(static_cast<unsigned>(x >> 32));
}

EMULATED unsigned __umulhi(unsigned a, unsigned b) {
    return static_cast<unsigned>(static_cast<unsigned long long>(a) * b >> 32);
}

EMULATED unsigned long long __umul64hi(unsigned long long a, unsigned long long b) {
    return static_cast<unsigned long long>(static_cast<unsigned __int128>(a) * b >> 64);
}

// The upper word of high:low shifted left, the lower word of it shifted right; the shift is taken modulo 32.
EMULATED unsigned __funnelshift_l(unsigned low, unsigned high, unsigned shift) {
    const unsigned long long both = static_cast<unsigned long long>(high) << 32 | low;
    return static_cast<unsigned>(both << (shift & 31u) >> 32);
}

// The shift is 32 at most.
EMULATED unsigned __funnelshift_lc(unsigned low, unsigned high, unsigned shift) {
    return shift >= 32 ? low : __funnelshift_l(low, high, shift);
}

EMULATED unsigned __funnelshift_r(unsigned low, unsigned high, unsigned shift) {
    const unsigned long long both = static_cast<unsigned long long>(high) << 32 | low;
    return static_cast<unsigned>(both >> (shift & 31u));
}

// Byte k of the result is the byte of y:x selected by the low three bits of the selector's nibble k.
EMULATED unsigned __byte_perm(unsigned x, unsigned y, unsigned selector) {
    const unsigned long long both = static_cast<unsigned long long>(y) << 32 | x;
    unsigned result = 0;
    for (int k = 0; k < 4; ++k) {
        result |= static_cast<unsigned>(both >> 8 * (selector >> 4 * k & 7u) & 0xffu) << 8 * k;
    }
    return result;
}

// The dot product of the words' bytes, added to a sum.
EMULATED unsigned __dp4a(unsigned x, unsigned y, unsigned sum) {
    for (int byte = 0; byte < 4; ++byte) sum += (x >> 8 * byte & 0xffu) * (y >> 8 * byte & 0xffu);
    return sum;
}

// Bit patterns of floats.
EMULATED unsigned __float_as_uint(float x) { return emulator::value_of<unsigned>(emulator::bits_of(x)); }
EMULATED int __float_as_int(float x) { return emulator::value_of<int>(emulator::bits_of(x)); }
EMULATED float __uint_as_float(unsigned x) { return emulator::value_of<float>(emulator::bits_of(x)); }
EMULATED float __int_as_float(int x) { return emulator::value_of<float>(emulator::bits_of(x)); }
EMULATED long long __double_as_longlong(double x) { return emulator::value_of<long long>(emulator::bits_of(x)); }
EMULATED double __longlong_as_double(long long x) { return emulator::value_of<double>(emulator::bits_of(x)); }

namespace emulator {

// `x` is an integer, infinite or NaN.
template <class Int, class Float>
static inline Int saturated(Float x) {
    if (x != x) return 0;
    if (x <= static_cast<Float>(std::numeric_limits<Int>::min())) return std::numeric_limits<Int>::min();
    // The maximum itself may not be representable as a float; the next power of two is.
    if (x >= static_cast<Float>(std::numeric_limits<Int>::max())) return std::numeric_limits<Int>::max();
    return static_cast<Int>(x);
}

// As ordered on the device: -0 before +0, and NaN only if both are.
template <class T>
static inline T least(T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        if (a != a) return b;
        if (a == b) return __builtin_signbit(a) ? a : b;
    }
    return b < a ? b : a;
}

template <class T>
static inline T greatest(T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        if (a != a) return b;
        if (a == b) return __builtin_signbit(a) ? b : a;
    }
    return a < b ? b : a;
}

} // namespace emulator

// Conversions: rz towards zero, rd down, ru up, rn to nearest even.
EMULATED int __float2int_rz(float x) { return emulator::saturated<int>(__builtin_truncf(x)); }
EMULATED int __float2int_rd(float x) { return emulator::saturated<int>(__builtin_floorf(x)); }
EMULATED int __float2int_ru(float x) { return emulator::saturated<int>(__builtin_ceilf(x)); }
EMULATED int __float2int_rn(float x) { return emulator::saturated<int>(__builtin_rintf(x)); }
EMULATED unsigned __float2uint_rz(float x) { return emulator::saturated<unsigned>(__builtin_truncf(x)); }
EMULATED unsigned __float2uint_rd(float x) { return emulator::saturated<unsigned>(__builtin_floorf(x)); }
EMULATED unsigned __float2uint_ru(float x) { return emulator::saturated<unsigned>(__builtin_ceilf(x)); }
EMULATED unsigned __float2uint_rn(float x) { return emulator::saturated<unsigned>(__builtin_rintf(x)); }
EMULATED long long __float2ll_rz(float x) { return emulator::saturated<long long>(__builtin_truncf(x)); }
EMULATED long long __float2ll_rd(float x) { return emulator::saturated<long long>(__builtin_floorf(x)); }
EMULATED int __double2int_rz(double x) { return emulator::saturated<int>(__builtin_trunc(x)); }
EMULATED int __double2int_rd(double x) { return emulator::saturated<int>(__builtin_floor(x)); }
EMULATED unsigned __double2uint_rz(double x) { return emulator::saturated<unsigned>(__builtin_trunc(x)); }
EMULATED long long __double2ll_rz(double x) { return emulator::saturated<long long>(__builtin_trunc(x)); }
EMULATED long long __double2ll_rd(double x) { return emulator::saturated<long long>(__builtin_floor(x)); }
EMULATED float __double2float_rn(double x) { return static_cast<float>(x); }
EMULATED float __int2float_rn(int x) { return static_cast<float>(x); }
EMULATED float __uint2float_rn(unsigned x) { return static_cast<float>(x); }

// Minimum and maximum. Mixing signed and unsigned gives unsigned, as in C.
template <class A, class B>
EMULATED std::common_type_t<A, B> min(A a, B b) { return emulator::least<std::common_type_t<A, B>>(a, b); }
template <class A, class B>
EMULATED std::common_type_t<A, B> max(A a, B b) { return emulator::greatest<std::common_type_t<A, B>>(a, b); }

EMULATED int abs(int x) { return x < 0 ? -x : x; }
EMULATED float fminf(float a, float b) { return emulator::least(a, b); }
EMULATED float fmaxf(float a, float b) { return emulator::greatest(a, b); }
EMULATED double fmin(double a, double b) { return emulator::least(a, b); }
EMULATED double fmax(double a, double b) { return emulator::greatest(a, b); }
EMULATED float __saturatef(float x) { return fminf(fmaxf(x, 0.0f), 1.0f); }

// Functions of floats: first those that are correctly rounded on both sides, then those that may differ in the last bits.
EMULATED float sqrtf(float x) { return __builtin_sqrtf(x); }
EMULATED float fabsf(float x) { return __builtin_fabsf(x); }
EMULATED float floorf(float x) { return __builtin_floorf(x); }
EMULATED float ceilf(float x) { return __builtin_ceilf(x); }
EMULATED float truncf(float x) { return __builtin_truncf(x); }
EMULATED float rintf(float x) { return __builtin_rintf(x); }
EMULATED float roundf(float x) { return __builtin_roundf(x); }
EMULATED float copysignf(float x, float sign) { return __builtin_copysignf(x, sign); }
EMULATED float fmaf(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
EMULATED double sqrt(double x) { return __builtin_sqrt(x); }
EMULATED double fabs(double x) { return __builtin_fabs(x); }
EMULATED double floor(double x) { return __builtin_floor(x); }
EMULATED double ceil(double x) { return __builtin_ceil(x); }
EMULATED bool isnan(float x) { return x != x; }
EMULATED bool isinf(float x) { return __builtin_isinf(x) != 0; }
EMULATED bool isfinite(float x) { return __builtin_isfinite(x) != 0; }
EMULATED bool signbit(float x) { return __builtin_signbit(x) != 0; }

EMULATED float sinf(float x) { return __builtin_sinf(x); }
EMULATED float cosf(float x) { return __builtin_cosf(x); }
EMULATED float powf(float x, float y) { return __builtin_powf(x, y); }
EMULATED float cbrtf(float x) { return __builtin_cbrtf(x); }
EMULATED float expf(float x) { return __builtin_expf(x); }
EMULATED float logf(float x) { return __builtin_logf(x); }
EMULATED float acosf(float x) { return __builtin_acosf(x); }
EMULATED float atan2f(float y, float x) { return __builtin_atan2f(y, x); }
EMULATED void sincosf(float x, float *sine, float *cosine) {
    *sine = sinf(x);
    *cosine = cosf(x);
}
