//! The last term of formula (1), k_s · I_r: rays from reflecting surface points along the reflected view direction. And rays that go on
//! through surfaces that are not opaque, straight or bent by glass.
//!
//! In: rays and hits of one depth. Out: the rays of the next depth, with the share of their radiance that reaches the eye: of each
//! surface point first the ray that goes through, then the mirrored one. The recursion of Whitted's ray tracer is a loop over such lists.
//!
//! Rough mirrors reflect a ray in several directions, selected by a sequence of points. Neighbouring pixels take parts of one sequence, in the order of
//! a Morton curve, so that their errors cancel (Ahmed, Wonka, *Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical
//! Ordering of Pixels*, ACM TOG 39(6), 2020).

pub(crate) mod cpu;
pub(crate) mod cuda;
mod thinning;
