// Vectors of three floats, with the operations of Rust's glam in glam's order: the results are bit-identical.
#pragma once

struct IVec3 {
    int x, y, z;
};

DEVICE IVec3 operator+(IVec3 a, IVec3 b) { return IVec3{a.x + b.x, a.y + b.y, a.z + b.z}; }

DEVICE Vec3 splat(float value) { return Vec3{value, value, value}; }

DEVICE Vec3 operator+(Vec3 a, Vec3 b) { return Vec3{a.x + b.x, a.y + b.y, a.z + b.z}; }
DEVICE Vec3 operator-(Vec3 a, Vec3 b) { return Vec3{a.x - b.x, a.y - b.y, a.z - b.z}; }
DEVICE Vec3 operator-(Vec3 a) { return Vec3{-a.x, -a.y, -a.z}; }
DEVICE Vec3 operator*(Vec3 a, Vec3 b) { return Vec3{a.x * b.x, a.y * b.y, a.z * b.z}; }
DEVICE Vec3 operator*(float a, Vec3 b) { return Vec3{a * b.x, a * b.y, a * b.z}; }
DEVICE Vec3 operator/(Vec3 a, Vec3 b) { return Vec3{a.x / b.x, a.y / b.y, a.z / b.z}; }
DEVICE Vec3 operator/(Vec3 a, float b) { return Vec3{a.x / b, a.y / b, a.z / b}; }
DEVICE bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
DEVICE bool operator!=(Vec3 a, Vec3 b) { return !(a == b); }

DEVICE float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

DEVICE Vec3 cross(Vec3 a, Vec3 b) {
    return Vec3{a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}

// Products fused into sums: `fused_dot` and `fused_cross` of simd/lanes.rs.
DEVICE float fused_dot(Vec3 a, Vec3 b) { return fmaf(a.z, b.z, fmaf(a.y, b.y, a.x * b.x)); }

DEVICE Vec3 fused_cross(Vec3 a, Vec3 b) {
    return Vec3{fmaf(a.y, b.z, -(a.z * b.y)), fmaf(a.z, b.x, -(a.x * b.z)), fmaf(a.x, b.y, -(a.y * b.x))};
}

DEVICE float length_squared(Vec3 a) { return dot(a, a); }
DEVICE float length(Vec3 a) { return sqrtf(dot(a, a)); }
DEVICE Vec3 normalize(Vec3 a) { return (1.0f / length(a)) * a; }

// Within 2^-22 of their values: for bounds that leave room for it, in a fraction of the instructions.
#if defined(__CUDACC__)
DEVICE float rough_root(float a) {
    float root;
    asm("sqrt.approx.f32 %0, %1;" : "=f"(root) : "f"(a));
    return root;
}
DEVICE float rough_reciprocal(float a) {
    float reciprocal;
    asm("rcp.approx.f32 %0, %1;" : "=f"(reciprocal) : "f"(a));
    return reciprocal;
}
#else
DEVICE float rough_root(float a) { return sqrtf(a); }
DEVICE float rough_reciprocal(float a) { return 1.0f / a; }
#endif

// As in glam: the second if either is NaN.
DEVICE float larger(float a, float b) { return a > b ? a : b; }
DEVICE Vec3 max(Vec3 a, Vec3 b) { return Vec3{larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z)}; }
DEVICE Vec3 min(Vec3 a, Vec3 b) { return Vec3{fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)}; }
DEVICE Vec3 abs(Vec3 a) { return Vec3{fabsf(a.x), fabsf(a.y), fabsf(a.z)}; }
DEVICE float max_element(Vec3 a) { return larger(a.x, larger(a.y, a.z)); }
DEVICE float element_sum(Vec3 a) { return a.x + a.y + a.z; }

// Neither infinite nor NaN.
DEVICE bool is_finite(float a) { return fabsf(a) <= F32_MAX; }
DEVICE bool is_finite(Vec3 a) { return is_finite(a.x) && is_finite(a.y) && is_finite(a.z); }

// The unit vector along `a`; zero if `a` has no length.
DEVICE Vec3 normalize_or_zero(Vec3 a) {
    const float reciprocal = 1.0f / length(a);
    return is_finite(reciprocal) && reciprocal > 0.0f ? reciprocal * a : splat(0.0f);
}

// The component of an axis. Selects, not branches: lanes of a warp may have different axes, and would take turns.
template <class Number>
DEVICE Number component(unsigned axis, Number x, Number y, Number z) { return axis == 0 ? x : axis == 1 ? y : z; }
DEVICE float component(unsigned axis, Vec3 a) { return component(axis, a.x, a.y, a.z); }

DEVICE DVec3 operator+(DVec3 a, DVec3 b) { return DVec3{a.x + b.x, a.y + b.y, a.z + b.z}; }
DEVICE DVec3 operator-(DVec3 a, DVec3 b) { return DVec3{a.x - b.x, a.y - b.y, a.z - b.z}; }
DEVICE DVec3 operator*(double a, DVec3 b) { return DVec3{a * b.x, a * b.y, a * b.z}; }

DEVICE DVec3 to_double(Vec3 a) { return DVec3{a.x, a.y, a.z}; }
DEVICE Vec3 to_single(DVec3 a) { return Vec3{(float)a.x, (float)a.y, (float)a.z}; }

DEVICE double dot(DVec3 a, DVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

DEVICE DVec3 cross(DVec3 a, DVec3 b) {
    return DVec3{a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}

DEVICE double length_squared(DVec3 a) { return dot(a, a); }
DEVICE double length(DVec3 a) { return sqrt(dot(a, a)); }
DEVICE double max_element(DVec3 a) { return fmax(a.x, fmax(a.y, a.z)); }
DEVICE DVec3 abs(DVec3 a) { return DVec3{fabs(a.x), fabs(a.y), fabs(a.z)}; }

DEVICE DVec3 normalize_or_zero(DVec3 a) {
    const double reciprocal = 1.0 / length(a);
    return fabs(reciprocal) <= F64_MAX && reciprocal > 0.0 ? reciprocal * a : DVec3{0.0, 0.0, 0.0};
}
