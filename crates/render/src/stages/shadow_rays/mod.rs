//! Shadow rays from the surface points themselves: what the light mesh is compared with.
//!
//! In: rays and hits. Out: [`Visibility`](crate::data::visibility::Visibility). Hard-shadow ray tracing casts one ray to the centre of each
//! light; area mode casts many, to points distributed over it.

pub(crate) mod cpu;
pub(crate) mod cuda;
