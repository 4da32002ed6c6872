//! Vectors of eight lanes, with the operations of `glam` in its order.

use fearless_simd::{f32x8, prelude::*};
use glam::Vec3;

/// Lanes of a vector; four vectors make one word of a mask.
pub const LANES: usize = 8;

// No `map` over arrays and no iterators in vector code: unless they are inlined, vectors are passed through memory.

/// Three vectors, one for each axis.
pub type Axes<S> = [f32x8<S>; 3];

/// Eight values from `first` on.
#[inline(always)]
pub fn load<S: Simd>(simd: S, lanes: &[f32], first: usize) -> f32x8<S> {
    f32x8::from_slice(simd, &lanes[first..first + LANES])
}

/// One vector in all lanes.
#[inline(always)]
pub fn splat<S: Simd>(simd: S, v: Vec3) -> Axes<S> {
    [f32x8::splat(simd, v.x), f32x8::splat(simd, v.y), f32x8::splat(simd, v.z)]
}

/// `a` − `b`.
#[inline(always)]
pub fn difference<S: Simd>(a: Axes<S>, b: Axes<S>) -> Axes<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a` + `b`.
#[inline(always)]
pub fn sum<S: Simd>(a: Axes<S>, b: Axes<S>) -> Axes<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a`, `scale` times as long.
#[inline(always)]
pub fn scaled<S: Simd>(scale: f32x8<S>, a: Axes<S>) -> Axes<S> {
    [scale * a[0], scale * a[1], scale * a[2]]
}

/// The same order of operations as [`Vec3::dot`].
#[inline(always)]
pub fn dot<S: Simd>(a: Axes<S>, b: Axes<S>) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The same order of operations as [`dot_along_x`](crate::accel::triangle::dot_along_x).
#[inline(always)]
pub fn dot_along_x<S: Simd>(a: Axes<S>, b: Axes<S>) -> f32x8<S> {
    a[2] * b[2] + a[1] * b[1] + a[0] * b[0]
}

/// The same order of operations as [`Vec3::cross`].
#[inline(always)]
pub fn cross<S: Simd>(a: Axes<S>, b: Axes<S>) -> Axes<S> {
    [a[1] * b[2] - b[1] * a[2], a[2] * b[0] - b[2] * a[0], a[0] * b[1] - b[0] * a[1]]
}

/// The inner product with products fused into sums, that of z last.
#[inline(always)]
pub fn fused_dot<S: Simd>(a: Axes<S>, b: Axes<S>) -> f32x8<S> {
    a[2].mul_add_precise(b[2], a[1].mul_add_precise(b[1], a[0] * b[0]))
}

/// The cross product with one product of each component fused into the difference. If `b` changes its sign, so does the result, exactly.
#[inline(always)]
pub fn fused_cross<S: Simd>(a: Axes<S>, b: Axes<S>) -> Axes<S> {
    [
        a[1].mul_sub_precise(b[2], a[2] * b[1]),
        a[2].mul_sub_precise(b[0], a[0] * b[2]),
        a[0].mul_sub_precise(b[1], a[1] * b[0]),
    ]
}

/// The lanes added in ascending order.
#[inline(always)]
pub fn sum_of_lanes<S: Simd>(lanes: f32x8<S>) -> f32 {
    let lanes: [f32; LANES] = lanes.into();
    let mut total = 0.0;
    for lane in lanes {
        total += lane;
    }
    total
}
