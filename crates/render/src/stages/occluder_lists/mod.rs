//! Shadows of lights with a size, by lists of the triangles that can hide a light from the surface points of a bundle.
//!
//! In: rays, hits and [`Bundles`](crate::data::bundles::Bundles). Out: [`Visibility`](crate::data::visibility::Visibility), the same bits as that of
//! [`area_shadows`](super::area_shadows).
//!
//! For a bundle and a light:
//!
//! 1. Which samples does each surface point see if nothing is in the way: those in front of the surface.
//! 2. Search: the triangles in the shaft between the box around the points that see any, and that around the emitter, above the tangent
//!    planes of the points.
//! 3. Candidates: a triangle is dropped if no corner lies above a tangent plane, or if for all points and all samples one of its edges is
//!    passed on the outer side, or its plane is not crossed. A triangle that hides everything is tried first.
//! 4. Each candidate clears the bits of the samples that it hides from each point, row by row, until no bit is left.
//! 5. Where lists cost more than rays, [rays](crate::shadow::sample_ray) to the samples still seen. Only a BVH has them.

mod candidates;
pub(crate) mod cpu;
pub(crate) mod cuda;
mod group;
