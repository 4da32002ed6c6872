//! The samples of pixels: what they see, and which pixels are shared.
//!
//! In: the camera's rays through the centres of pixels, with what they see. Out: what each sample of each pixel sees, and the
//! pixels whose samples all lie on one surface with their centre: these are *shared*, and shaded once, at the centre. In the other
//! pixels nothing is shaded at the centre, so its hit is left out of what is handed on; their samples become [fragments](super::fragments). So do those of
//! mirrors that are followed, each of which has a mirror ray of its own.
//!
//! Samples lie on one surface if they lie on one triangle; or on the same material, with nearly the same normals, in nearly the
//! same plane.
//!
//! Layers and coverage are those of the samples: depth, normal, position and ids of the nearest one; how many see each object and material.

pub(crate) mod cpu;
pub(crate) mod cuda;
pub(crate) mod same_surface;

use std::ops::Range;

use crate::antialiasing::Antialiasing;

/// Some samples of each pixel.
#[derive(Clone, Debug)]
pub struct SampleRange<'a> {
    /// All of them.
    pub all: &'a Antialiasing,
    /// Their numbers.
    pub numbers: Range<u32>,
}
