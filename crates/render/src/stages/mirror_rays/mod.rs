//! The last term of formula (1), k_s · I_r: rays from reflecting surface points along the reflected view direction. And rays that go on
//! through surfaces that are not opaque, straight or bent by glass.
//!
//! In: rays and hits of one depth. Out: the rays of the next depth, with the share of their radiance that reaches the eye: of each
//! surface point first the ray that goes through, then the mirrored one. The recursion of Whitted's ray tracer is a loop over such lists.

pub(crate) mod cpu;
pub(crate) mod cuda;
mod thinning;
