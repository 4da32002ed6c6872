//! Step 1: what does each ray see?
//!
//! In: rays. Out: the closest hit of each, in the order of the rays. Rays from mirrors take the same way as rays from the
//! camera.

pub(crate) mod cpu;
pub(crate) mod cuda;
