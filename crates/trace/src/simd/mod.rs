//! SIMD chosen at run time, in two versions: AVX2 if the CPU has it, and the target's baseline.
//!
//! `fearless_simd::dispatch!` compiles every kernel for five levels of x86. Kernels here work on eight lanes: levels between
//! these two are rare, AVX-512 hardly helps, and each costs a minute of compile time. All versions give the same bits, because
//! no operations are fused.

mod lanes;

pub use lanes::{
    Axes, LANES, cross, difference, dot, dot_along_x, fused_cross, fused_dot, load, scaled, splat, sum, sum_of_lanes,
};

/// Evaluates an expression with `$simd` bound to the best token for `$level`. The expression must call `#[simd]` or
/// `#[inline(always)]` functions only.
#[doc(hidden)]
#[macro_export]
macro_rules! dispatch {
    ($level:expr, $simd:ident => $work:expr) => {{
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            use fearless_simd::Simd as _;
            if let Some($simd) = $level.as_avx2() {
                $simd.vectorize(#[inline(always)] || $work)
            } else {
                let $simd = $level.as_sse2().expect("every level of x86 includes SSE2");
                $simd.vectorize(#[inline(always)] || $work)
            }
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        {
            fearless_simd::dispatch!($level, $simd => $work)
        }
    }};
}

pub use dispatch;
