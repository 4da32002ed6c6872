//! Mirrored rays of a pixel that meet one surface, as one ray: what a mirror shows is shaded once for a pixel, as what the camera sees is.
//!
//! In: mirrored rays and hits; the rays of a pixel follow each other. Out: the rays that are left, in their order, and their hits.
//!
//! 1. The first ray of a pixel that is left takes all that lie on one surface with it, as samples of a pixel do
//!    ([`same_surface`](super::pixel_samples::same_surface)), unless too much of what this surface mirrors would reach the pixel by a single ray.
//! 2. Its weight is the sum of theirs, and its cone covers what all of them see of a texture.
//!
//! Rays from rough mirrors blur what they show: of these it takes all that meet the same material with a normal within 26 degrees, unless too much
//! of what this material shows would reach the pixel by a single ray, which would be noise. It is any of them, so that the mean over pixels is right.
//!
//! Rays that went through a surface stay apart, and those that see lights.

pub(crate) mod cpu;
pub(crate) mod cuda;
