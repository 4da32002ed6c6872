//! Linear images with layers: transfer functions, file formats and comparison.
//!
//! A renderer fills a [`Frame`]: linear colour, and optionally [`Layers`] with per-pixel data. From there,
//!
//! - [`Frame::save`] writes bmp, png, exr or jpg, according to the path's extension, and [`Frame::save_layers`] a multilayer exr;
//!   [`publish`] lets several files appear together;
//! - [`Frame::load`] reads the same formats back into linear values, and Radiance's hdr;
//! - [`compare`] measures the difference between two frames as they are shown, as numbers and as an image (FLIP); [`compare_linear`] also that
//!   of values above 1 (HDR-FLIP).
//!
//! [`SaveOptions`] say how: exposure, [`View`], transfer function and bits of files that are looked at ([`Display`]), numbers and compression of
//! exr files ([`ExrOptions`]). All of it is only applied here; everything else in the workspace uses linear values.
//!
//! Each format has a Cargo feature (`bmp`, `exr`, `jpeg`, `png`); all are on by default.
//!
//! ```
//! # #[cfg(feature = "png")] {
//! use lightmesh_image::{Frame, check_writable, compare};
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("grey.png");
//! check_writable(&path)?; // before rendering, so that a typo costs no time
//!
//! let frame = Frame::new(64, 48, vec![[0.18; 3]; 64 * 48])?;
//! frame.save(&path)?;
//!
//! let comparison = compare(&frame, &Frame::load(&path)?)?;
//! assert!(comparison.max_difference < 0.5 / 255.0); // only rounding to 8 bits
//! assert_eq!(comparison.mean_flip, 0.0);
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(
    not(all(feature = "bmp", feature = "exr", feature = "jpeg", feature = "png")),
    allow(dead_code, unused_imports, unused_variables, reason = "what several formats share is not used by each")
)]

#[cfg(feature = "bmp")]
mod bmp;
mod compare;
#[cfg(any(feature = "bmp", feature = "jpeg"))]
mod decoder;
#[cfg(any(feature = "exr", feature = "png"))]
mod deflate;
mod display;
mod error;
mod exposure;
#[cfg(feature = "exr")]
mod exr;
mod format;
mod frame;
#[doc(hidden)]
pub mod internals;
#[cfg(feature = "jpeg")]
mod jpg;
mod load;
mod matte;
mod options;
mod paste;
#[cfg(feature = "png")]
mod png;
mod radiance;
mod save;
mod sizes;
mod transfer;

pub use compare::{CompareError, Comparison, LinearDifference, compare, compare_linear};
pub use display::{BitDepth, Display, UnknownView, View};
pub use error::{DecodeError, EncodeError, LoadError, SaveError};
pub use format::Format;
pub use frame::{Frame, FrameError, FrameParts, Layers, Window};
pub use lightmesh_files::{Output, PublishError, Ready, publish};
pub use load::Range;
pub use matte::{MAX_RANKS, Matte, Rank};
pub use options::{Description, ExrCompression, ExrOptions, ExrParts, ExrSamples, SaveOptions, UnknownWord};
pub use save::{check_image, check_options, check_size, check_writable};
pub use transfer::{Transfer, UnknownTransfer};
