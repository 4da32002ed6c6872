//! OpenEXR: linear floats, or halves on request, with lossless compression.
//!
//! Channels of a multilayer file, one plane each: `R G B`, `A` if there is alpha, `Z`, `N.X N.Y N.Z`, `P.X P.Y P.Z`, `V.0 V.1 …`, `M`, and the
//! radiance of each light by itself, `L.0.R L.0.G L.0.B L.1.R …`, with that of no light, `L.rest.R L.rest.G L.rest.B`; numbers of
//! objects and materials, `id.object`, `id.material`, and their [mattes](cryptomatte). They have their full names, in one part, because this is
//! what readers of single-part files support; or in several parts that compositors read by themselves.

mod attributes;
pub(crate) mod cryptomatte;
pub(crate) mod order;
pub(crate) mod read;
pub(crate) mod write;

pub(crate) use read::read;
pub(crate) use write::{write, write_layers, write_values};

const COLOR: [&str; 3] = ["R", "G", "B"];
const ALPHA: &str = "A";
const LUMINANCE: &str = "Y";
const DEPTH: &str = "Z";
const NORMAL: [&str; 3] = ["N.X", "N.Y", "N.Z"];
const POSITION: [&str; 3] = ["P.X", "P.Y", "P.Z"];
const USED: &str = "M";

/// The planes of what belongs to no light.
pub const REST: [&str; 3] = ["L.rest.R", "L.rest.G", "L.rest.B"];

/// Names of the planes with the radiance of light `light`.
pub fn light_names(light: usize) -> [String; 3] {
    COLOR.map(|channel| format!("L.{light}.{channel}"))
}

/// Name of the plane with the visibility of light `light`.
pub fn visibility_name(light: usize) -> String {
    format!("V.{light}")
}
