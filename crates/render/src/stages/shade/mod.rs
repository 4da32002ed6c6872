//! Step 5, second half: formula (1), Whitted's model with Phong terms.
//!
//! ```text
//! I(P) = I_a k_a + Σ_i V(L_i, P) · I_i · [ k_d (N·D_i) + k_s (R_i·View)^pow ] + k_s · I_r
//! ```
//!
//! Both dot products are clamped at 0, channels are independent. The last term is a separate list of rays
//! ([`mirror_rays`](super::mirror_rays)). In: hits and visibility. Out: radiance, added to the pixels.

pub(crate) mod cpu;
pub(crate) mod cuda;
