//! Step 1: what does each ray see?
//!
//! In: rays. Out: the closest hit of each, in the order of the rays. Mirror rays are treated like camera rays.

pub(crate) mod cpu;
pub(crate) mod cuda;
