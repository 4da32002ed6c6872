//! Shadows of lights with a size by shadow rays: one from each surface point, and all its samples where the answers of its neighbours
//! disagree. The rival of [`occluder_lists`](super::occluder_lists).
//!
//! In: rays and hits. Out: [`Visibility`](crate::data::visibility::Visibility).
//!
//! For each light with a size:
//!
//! 1. Each surface point casts one ray to it. Which point of the light it ends at depends on the pixel, so that the rays of any 5 × 5
//!    pixels together cover the light: a lattice of 5 × 5 points that reaches nearly to its rim, where most shadows enter. Rays to random
//!    points would leave gaps, and rays to the centre would find no wide penumbra but for its middle.
//! 2. Where the answers of a pixel's 5 × 5 neighbours are the same, that answer is the share. A surface that is turned away from all of a
//!    light is dark, and has no answer. A light that straddles the horizon of a surface point counts as disagreement there.
//! 3. Elsewhere the share is that of [`shadow_rays`](super::shadow_rays), of the same samples.
//!
//! A light without a size is the ray to its centre. Rays that are not a camera's have no neighbours: all their samples are tested.
//!
//! The picture does not depend on how it is split into bands: steps 1 and 2 include the rows next to a band, whose rays are not counted.
//! What all 25 rays miss stays unseen: an edge that hides or shows less than a fortieth of a light, an occluder narrower than their distance.

pub(crate) mod cpu;
pub(crate) mod cuda;
pub(crate) mod first;
