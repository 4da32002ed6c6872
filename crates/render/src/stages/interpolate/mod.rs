//! Step 5, first half: the weighted mean of what a surface point's light points see. Formula (3).
//!
//! In: masks and what each light point sees. Out: [`Visibility`](crate::stages::shadow_rays::Visibility). The sum is divided by
//! Σw, not by the number of light points, so that a fully lit half-ball gives exactly 1 whatever the weight. A surface point
//! without light points takes its own long tests.

pub(crate) mod cpu;
pub(crate) mod cuda;
