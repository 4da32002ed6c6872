//! Parts of the crate for its own tests, which are in `tests/image/parts`. They are no interface: they change with any release.
//!
//! Tests are a crate of their own, so that this one is compiled once, not a second time with its tests.

#[cfg(feature = "bmp")]
pub mod bmp {
    pub use crate::bmp::layout::Layout;
    pub use crate::bmp::write;
}

pub mod compare {
    pub use crate::compare::flip::flip;
    pub use crate::compare::hdr_flip_errors;
}

#[cfg(any(feature = "exr", feature = "png"))]
pub mod deflate {
    pub use crate::deflate::{HEADER, Piece, WINDOW, checksum, end, zlib};
}

pub mod display {
    pub use crate::display::agx::{agx, hue, mixed, with_hue};
    pub use crate::display::curve::Curve;
    pub use crate::display::dither::{LEVELS, threshold};
    pub use crate::display::neutral::neutral;

    use crate::{Display, Frame};

    /// Bytes of a pixel of `frame`.
    pub fn pixel_bytes(display: &Display, frame: &Frame) -> usize {
        display.pixel_bytes(frame)
    }
}

#[cfg(feature = "exr")]
pub mod exr {
    pub use crate::exr::cryptomatte::{MATERIALS, Manifest, Naming, OBJECTS, identifier, manifest, murmur3};
    pub use crate::exr::order::{Sorted, sort};
    pub use crate::exr::read::read;
    pub use crate::exr::write::{write, write_layers, write_values};
    pub use crate::exr::{REST, light_names, visibility_name};
}

pub mod format {
    use crate::Format;

    /// The format whose signature starts `bytes`.
    pub fn from_signature(bytes: &[u8]) -> Option<Format> {
        Format::from_signature(bytes)
    }

    /// The signature of a format.
    pub fn signature(format: Format) -> &'static [u8] {
        format.signature()
    }

    /// The extensions of all formats that the crate was built with.
    pub fn known() -> String {
        Format::known()
    }
}

#[cfg(feature = "jpeg")]
pub mod jpg {
    pub use crate::jpg::{is_cut_off, write};
}

#[cfg(feature = "png")]
pub mod png {
    pub use crate::png::{read, write, write_indexed};
}

pub mod transfer {
    pub use crate::transfer::{IGNORED, SMALLEST, SRGB_DECODED, SRGB_THRESHOLDS, exceeded, linear_to_srgb};

    use crate::Transfer;

    /// The linear value of a 16-bit code.
    pub fn decode16(transfer: Transfer, code: u16) -> f32 {
        transfer.decode16(code)
    }

    /// The 16-bit code nearest to `linear`.
    pub fn encode16(transfer: Transfer, linear: f32) -> u16 {
        transfer.encode16(linear)
    }

    /// The code below or above `linear`, as `threshold` decides.
    pub fn encode_between(transfer: Transfer, linear: f32, threshold: f32) -> u8 {
        transfer.encode_between(linear, threshold)
    }
}
